"""Arrays from what callers give, or an error that names it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from drystone._core import DrystoneError


def floats(
    value: ArrayLike, what: str, error: type[DrystoneError], wanted: str = "hold real numbers"
) -> NDArray[np.float64]:
    """As contiguous floats. TypeError, also for text, or an `error` names `what` if they are none,
    and what is `wanted`."""
    try:
        given = np.asarray(value)
        if given.dtype.kind in "SU":
            raise TypeError
        if given.dtype.kind == "O" and any(one is None for one in given.flat):
            raise ValueError  # NumPy takes it as nan
        made = np.asarray(given, dtype=None if given.dtype.kind == "c" else np.float64)
    except (TypeError, ValueError, OverflowError) as reason:
        fault = TypeError if isinstance(reason, TypeError) else error
        raise fault(f"{what} must {wanted}, not {value!r:.60}") from None
    if made.dtype.kind == "c":
        raise error(f"{what} must {wanted}, not complex ones")
    return np.ascontiguousarray(made) if made.ndim else made


def vector(value: ArrayLike, what: str, error: type[DrystoneError]) -> NDArray[np.float64]:
    """The same of one dimension."""
    made = floats(value, what, error)
    if made.ndim != 1:
        raise error(f"{what} must be a vector, not of shape {made.shape}")
    return made
