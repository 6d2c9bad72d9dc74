"""Names of files say what is in them, and files are written whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Sequence
from os import PathLike
from pathlib import Path

PART = ".part"
"""Ending of a file that is being written. One left by a killed process is overwritten."""


PICTURES = (".svg", ".pdf", ".png")
PAGE = ".html"
FILMS = (".gif", ".mp4")
JSON = ".json"
RUN = ".npz"
"""How the names of what drystone writes end."""

EMPTY = "the file is empty: export it again"
"""What to say of no bytes at all."""


def ending_of(path: str | PathLike[str], known: Sequence[str]) -> str:
    """How a name ends, in small letters; ValueError, before any work, if that is none of `known`.

    >>> ending_of("wall.SVG", PICTURES)
    '.svg'
    >>> ending_of("wall.bmp", PICTURES)
    Traceback (most recent call last):
    ValueError: wall.bmp: give it a name that ends in .svg, .pdf or .png
    """
    ending = Path(path).suffix.lower()
    if ending not in known:
        *others, last = known
        names = f"{', '.join(others)} or {last}" if others else last
        raise ValueError(f"{os.fspath(path)}: give it a name that ends in {names}")
    return ending


def write_whole(path: Path, data: bytes) -> None:
    """Write a file so that, whatever happens, it holds what it held before or all of `data`."""
    part = path.with_name(f".{path.name}{PART}")
    try:
        with part.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise OSError(error.errno, error.strerror, str(path)) from None
