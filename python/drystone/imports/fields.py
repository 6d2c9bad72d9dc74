"""Values out of files that anyone may have written."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from drystone.common.files import EMPTY
from drystone.imports.collected import FormatError


def read_json(path: Path) -> Any:
    """The data in a JSON file; FormatError if it is not JSON."""
    text = path.read_bytes()
    if not text.strip():
        raise FormatError(f"{path}: {EMPTY}")
    try:
        return json.loads(text, object_pairs_hook=_unique)
    except (ValueError, RecursionError) as error:
        raise FormatError(f"{path}: not a JSON file: {error}") from None


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object; ValueError if it names a field twice."""
    made = dict(pairs)
    if len(made) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in made if names.count(name) > 1)
        raise ValueError(f"an object names {twice!r:.60} twice")
    return made


def finite(value: Any, what: str) -> float:
    """A finite number; FormatError naming `what` otherwise."""
    try:
        number = math.nan if isinstance(value, bool | str | None) else float(value)
    except (OverflowError, TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        raise FormatError(f"{what} must be a finite number, not {value!r:.60}")
    return number


def numbers(value: Any, count: int, what: str) -> list[float]:
    """So many finite numbers."""
    if not isinstance(value, (list, tuple)) or len(value) != count:
        raise FormatError(f"{what} must be {count} numbers, not {value!r:.60}")
    return [finite(x, what) for x in value]


def entries(value: Any, otherwise: str) -> dict[str, Any]:
    """An object that is not empty; FormatError saying `otherwise`."""
    if not isinstance(value, dict) or not value:
        raise FormatError(otherwise)
    return value
