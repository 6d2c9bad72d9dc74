"""Numbers from what callers give, or an error that names them."""

from __future__ import annotations

from typing import Any

from drystone import _core


def vector(value: Any, dimension: int, what: str) -> tuple[float, ...]:
    """`value` as so many floats; SceneError naming `what` otherwise."""
    try:
        found = tuple(float(x) for x in value)
    except (TypeError, ValueError):
        found = ()
    if len(found) != dimension or isinstance(value, str):
        words = "two numbers (x, y)" if dimension == 2 else "three numbers (x, y, z)"
        raise _core.SceneError(f"{what} must be {words}, not {value!r}")
    return found


def number(value: Any, what: str) -> float:
    """`value` as a float; SceneError naming `what` otherwise."""
    try:
        return float(value)
    except (TypeError, ValueError):
        raise _core.SceneError(f"{what} must be a number, not {value!r}") from None
