"""Large answers as JSON, written piece by piece: never more than a piece of it is in memory."""

from __future__ import annotations

import io
import json
from collections.abc import Iterable, Iterator, Mapping
from os import PathLike
from pathlib import Path
from typing import Protocol, TextIO

from drystone.common.files import write_whole


class Rows:
    """A JSON list, from its elements' own JSON: texts of one or more, with commas in between."""

    def __init__(self, texts: Iterable[str]) -> None:
        self.texts = texts


class Written(Protocol):
    """What writes itself as JSON."""

    def write_json(self, file: TextIO) -> None: ...


def save_json(answer: Written, path: str | PathLike[str]) -> None:
    """Write an answer to a file, whole or not at all."""
    text = io.StringIO()
    answer.write_json(text)
    write_whole(Path(path), text.getvalue().encode())


def write_json(value: object, file: TextIO) -> None:
    """Writes `value`, of types that JSON knows and of `Rows`, and ends the line.

    An object has a line for each entry, a list that holds lists or objects one for each of these.
    """
    for text in _pieces(value, ""):
        file.write(text)
    file.write("\n")


def _pieces(value: object, indent: str) -> Iterator[str]:
    within = indent + "  "
    if isinstance(value, Mapping) and value:
        yield "{"
        for k, (key, entry) in enumerate(value.items()):
            yield f"{',' if k else ''}\n{within}{json.dumps(key)}: "
            yield from _pieces(entry, within)
        yield f"\n{indent}}}"
    elif isinstance(value, Rows):
        yield from _lines(value.texts, indent)
    elif isinstance(value, list) and value and isinstance(value[0], dict | list):
        yield from _lines(map(json.dumps, value), indent)
    else:
        yield json.dumps(value)


def _lines(texts: Iterable[str], indent: str) -> Iterator[str]:
    empty = True
    for text in texts:
        yield ("[\n" if empty else ",\n") + text
        empty = False
    yield "[]" if empty else f"\n{indent}]"
