"""Files are written whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

PART = ".part"
"""Ending of a file that is being written. One left by a killed process is overwritten."""


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
