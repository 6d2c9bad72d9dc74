"""Docstrings as Markdown: examples become blocks of code, pages of `docs/` become links."""

from __future__ import annotations

import re
from typing import Any

import griffe

PAGE = re.compile(r"\(?docs/((?:theory|guide)/[\w-]+|notation)\.md\)?")


class Readable(griffe.Extension):  # type: ignore[misc]
    """What mkdocstrings reads of every object."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Called for each module, class, function and attribute."""
        if obj.docstring is not None:
            obj.docstring.value = _linked(_fenced(obj.docstring.value))


def _fenced(text: str) -> str:
    """Every run of lines from `>>>` to the next empty one between fences."""
    lines: list[str] = []
    inside = False
    for line in text.splitlines():
        if line.lstrip().startswith(">>>") and not inside:
            inside = True
            lines += ["", "```pycon"]
        elif inside and not line.strip():
            inside = False
            lines.append("```")
        lines.append(line)
    return "\n".join([*lines, "```"] if inside else lines)


def _linked(text: str) -> str:
    """`docs/theory/holds.md` as a link from a page of the API, all of which are in one folder."""
    return PAGE.sub(lambda found: f"([more](../{found[1]}.md))", text)
