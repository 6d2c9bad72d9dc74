"""Numbers and names from what callers give, or an error that says what is wanted.

Of the wrong type is a TypeError, and what cannot be read or used a SceneError.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from drystone import _core

if TYPE_CHECKING:
    from drystone._core import DrystoneError

WORDS = {
    1: "one number",
    2: "two numbers (x, y)",
    3: "three numbers (x, y, z)",
    4: "a quaternion (w, x, y, z)",
}
"""What so many numbers are, without a word about it."""


def vector(
    value: object,
    count: int,
    what: str,
    wanted: str | None = None,
    error: type[DrystoneError] = _core.SceneError,
) -> tuple[float, ...]:
    """`value` as so many floats. TypeError or an `error` names `what` and what is `wanted`."""
    found: tuple[float, ...] = ()
    fault: type[Exception] = error
    try:
        if isinstance(value, str | bytes):
            raise TypeError
        found = tuple(map(float, value))  # type: ignore[call-overload]
    except TypeError:
        fault = TypeError
    except ValueError:
        pass
    if len(found) != count:
        words = wanted or WORDS[count]
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


def number(value: object, what: str, wanted: str = "a number") -> float:
    """`value` as a float."""
    try:
        return float(value)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"{what} must be {wanted}, not {value!r:.80}") from None
    except ValueError:
        raise _core.SceneError(f"{what} must be {wanted}, not {value!r:.80}") from None


def whole(value: object, what: str) -> int:
    """`value` as an int, which it must be already: 2.5 steps are none."""
    try:
        return value.__index__()  # type: ignore[attr-defined, no-any-return]
    except AttributeError:
        raise TypeError(f"{what} must be a whole number, not {value!r:.80}") from None


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


def names_of(blocks: Iterable[str] | None) -> list[str] | None:
    """Names of blocks; None for all."""
    if blocks is None:
        return None
    if isinstance(blocks, str):
        raise TypeError(f"blocks must be a list of names, not the string {blocks!r:.80}")
    return [name_of(name) for name in _iterated(blocks)]


def _iterated(blocks: Iterable[str]) -> Sequence[str]:
    try:
        return list(blocks)
    except TypeError:
        raise TypeError(f"blocks must be a list of names, not {blocks!r:.80}") from None
