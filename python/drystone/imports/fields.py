"""Values out of files that anyone may have written."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from drystone.imports.collected import FormatError


def read_json(path: Path) -> Any:
    """The data in a JSON file; FormatError if it is not JSON."""
    try:
        return json.loads(path.read_bytes())
    except (ValueError, RecursionError) as error:
        raise FormatError(f"{path}: not a JSON file: {error}") from None


def finite(value: Any, what: str) -> float:
    """A finite number; FormatError naming `what` otherwise."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise FormatError(f"{what} must be a finite number, not {value!r}")
    return float(value)


def numbers(value: Any, count: int, what: str) -> list[float]:
    """So many finite numbers."""
    if not isinstance(value, (list, tuple)) or len(value) != count:
        raise FormatError(f"{what} must be {count} numbers, not {value!r}")
    return [finite(x, what) for x in value]


def entries(value: Any, otherwise: str) -> dict[str, Any]:
    """An object that is not empty; FormatError saying `otherwise`."""
    if not isinstance(value, dict) or not value:
        raise FormatError(otherwise)
    return value
