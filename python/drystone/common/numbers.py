"""Numbers and names from what callers give, or an error that says what is wanted.

Of the wrong type is a TypeError, text for a number too, and what cannot be used a SceneError.
"""

from __future__ import annotations

import operator
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from drystone import _core

if TYPE_CHECKING:
    from numpy.typing import NDArray

Floats: TypeAlias = "Sequence[float] | NDArray[Any]"
"""Numbers in a row: a tuple, a list or an array."""

FloatRows: TypeAlias = "Sequence[Floats] | NDArray[Any]"
"""Rows of them."""

WORDS = {
    1: "one number",
    2: "two numbers (x, y)",
    3: "three numbers (x, y, z)",
    4: "a quaternion (w, x, y, z)",
}
"""What so many numbers are, without a word about it."""

MOST = 2**63 - 1
"""The largest whole number that anything is counted with."""


def vector(
    value: object,
    count: int | tuple[int, int],
    what: str,
    wanted: str | None = None,
    error: type[Exception] = _core.SceneError,
) -> tuple[float, ...]:
    """`value` as so many floats, or one of two counts. TypeError or an `error` names `what` and
    what is `wanted`."""
    counts = (count,) if isinstance(count, int) else count
    found: tuple[float, ...] = ()
    fault: type[Exception] = error
    try:
        found = tuple(map(_float, _no_text(value)))
    except TypeError:
        fault = TypeError
    except (ValueError, OverflowError):
        pass
    if len(found) not in counts:
        words = wanted or WORDS[counts[0]]
        raise fault(f"{what} must be {words}, not {value!r:.80}")
    return found


def pair(value: object, what: str) -> tuple[float, float]:
    """Two floats (x, y)."""
    x, y = vector(value, 2, what)
    return x, y


def triple(value: object, what: str) -> tuple[float, float, float]:
    """Three floats (x, y, z)."""
    x, y, z = vector(value, 3, what)
    return x, y, z


def quaternion(value: object) -> tuple[float, float, float, float]:
    """An orientation (w, x, y, z)."""
    w, x, y, z = vector(value, 4, "orientation")
    return w, x, y, z


def number(
    value: object,
    what: str,
    wanted: str = "a number",
    error: type[Exception] = _core.SceneError,
) -> float:
    """`value` as a float. TypeError or an `error` names `what` and what is `wanted`."""
    try:
        return _float(value)
    except TypeError:
        raise TypeError(f"{what} must be {wanted}, not {value!r:.80}") from None
    except (ValueError, OverflowError):
        raise error(f"{what} must be {wanted}, not {value!r:.80}") from None


def optional_number(
    value: object, what: str, error: type[Exception] = _core.SceneError
) -> float | None:
    """The same of a number that need not be given."""
    return None if value is None else number(value, what, error=error)


def _float(value: object) -> float:
    return float(_no_text(value))


def _no_text(value: object) -> Any:
    """The same; TypeError for text, which Python would read as a number or as a list."""
    if isinstance(value, str | bytes | bytearray):
        raise TypeError
    return value


def whole(value: object, what: str, error: type[Exception] = _core.SceneError) -> int:
    """`value` as an int, which it must be already: 2.5 steps are none."""
    try:
        found = operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"{what} must be a whole number, not {value!r:.80}") from None
    if abs(found) > MOST:
        raise error(f"{what} is beyond 2^63: give a smaller number")
    return found


def optional_whole(value: object, what: str) -> int | None:
    """The same of a number that need not be given."""
    return None if value is None else whole(value, what)


def flag(value: object, what: str) -> bool:
    """`value` as a bool, which it must be already, Python's or NumPy's."""
    if type(value).__name__ not in ("bool", "bool_"):
        raise TypeError(f"{what} must be True or False, not {value!r:.80}")
    return bool(value)


def word(value: object, what: str) -> str:
    """`value` as text."""
    if not isinstance(value, str):
        raise TypeError(f"{what} must be text, not {value!r:.80}")
    return value


def name_of(name: str) -> str:
    """A name as the core takes it."""
    if not isinstance(name, str):
        raise TypeError(f"a name must be text, not {name!r:.80}")
    try:
        name.encode()
    except UnicodeEncodeError:
        raise _core.SceneError(f"a name must be text, not {name!r:.80}") from None
    return name


def optional_name(name: str | None) -> str | None:
    """The same of a name that need not be given."""
    return None if name is None else name_of(name)


def names_of(blocks: Iterable[str] | None, what: str = "blocks") -> list[str] | None:
    """Names of blocks; None for all."""
    if blocks is None:
        return None
    if isinstance(blocks, str):
        raise TypeError(f"{what} must be a list of names, not the string {blocks!r:.80}")
    try:
        names = list(blocks)
    except TypeError:
        raise TypeError(f"{what} must be a list of names, not {blocks!r:.80}") from None
    return [name_of(name) for name in names]
