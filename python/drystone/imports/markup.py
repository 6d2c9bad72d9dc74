"""Small XML files, read with bounds."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

from drystone.common.files import EMPTY
from drystone.imports.collected import FormatError

MOST_BYTES = 16_000_000
"""Scene descriptions are small; larger ones are not read."""

DEEPEST = 100
"""Bodies inside bodies."""


class _Tree(ET.TreeBuilder):
    """Refuses document types, and with them entities that expand to gigabytes."""

    def doctype(self, *_: Any) -> None:
        raise FormatError("it has a document type (<!DOCTYPE>): remove it")


def read_xml(path: Path) -> ET.Element:
    """The root of an XML file; FormatError naming the file if it cannot be used."""
    data = path.read_bytes()
    if len(data) > MOST_BYTES:
        raise FormatError(f"{path}: larger than {MOST_BYTES} bytes: no description of a scene")
    if not data.strip():
        raise FormatError(f"{path}: {EMPTY}")
    parser = ET.XMLParser(target=_Tree())
    try:
        parser.feed(data)
        root = parser.close()
    except ET.ParseError as error:
        raise FormatError(f"{path}: not an XML file: {error}") from None
    except FormatError as error:
        raise FormatError(f"{path}: {error}") from None
    _drop_namespaces(root)
    if _depth(root) > DEEPEST:
        raise FormatError(f"{path}: elements more than {DEEPEST} deep")
    return root


def values(text: str | None, count: int | None, what: str) -> list[float]:
    """Numbers separated by blanks; so many of them if `count` is given."""
    try:
        found = [float(word) for word in (text or "").split()]
    except ValueError:
        raise FormatError(f"{what}: not numbers: {text!r}") from None
    if (count is not None and len(found) != count) or not all(abs(x) < float("inf") for x in found):
        raise FormatError(f"{what}: needs {count or 'finite'} numbers, not {text!r}")
    return found


def _drop_namespaces(root: ET.Element) -> None:
    """Names as they are without a namespace: formats here have one vocabulary each."""
    for element in root.iter():
        if isinstance(element.tag, str):
            element.tag = element.tag.rpartition("}")[2]
        for key in [key for key in element.attrib if "}" in key]:
            element.attrib.setdefault(key.rpartition("}")[2], element.attrib.pop(key))


def _depth(root: ET.Element) -> int:
    level, deep = [root], 0
    while level and deep <= DEEPEST:
        level = [child for element in level for child in element]
        deep += 1
    return deep
