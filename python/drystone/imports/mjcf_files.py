"""MJCF models in several files."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

from drystone.imports.collected import FormatError
from drystone.imports.markup import read_xml

MOST_FILES = 100
"""Files of one model: more than that include one another."""


def included(root: ET.Element, path: Path) -> ET.Element:
    """The model with every <include> replaced by what is in its file.

    As in MuJoCo a file's name is seen from the model's own folder; if there is none, from the
    folder of the file that includes it.
    """
    _fill(root, path.parent, path.parent, [path])
    return root


def _fill(element: ET.Element, top: Path, folder: Path, seen: list[Path]) -> None:
    children = []
    for child in element:
        if child.tag != "include":
            _fill(child, top, folder, seen)
            children.append(child)
            continue
        name = child.get("file", "")
        file = next((place / name for place in (top, folder) if (place / name).is_file()), None)
        if file is None:
            raise FormatError(f"it includes {name!r}, and there is no such file")
        if len(seen) >= MOST_FILES:
            raise FormatError(f"it includes {name!r} as file number {MOST_FILES}, or itself")
        inner = read_xml(file)
        _fill(inner, top, file.parent, [*seen, file])
        children += list(inner)
    element[:] = children
