"""A body's own mass, centre of mass and inertia, as the compiled core takes them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

from drystone import _core
from drystone.common.numbers import Floats, number, optional_number, pair, triple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Inertia: TypeAlias = "float | Sequence[Sequence[float]] | NDArray[np.float64]"
"""kg m^2 about the centre of mass: a number in the plane, (3, 3) in space."""

_Rows: TypeAlias = tuple[tuple[float, float, float], ...]


def in_plane(
    mass: float | None, center_of_mass: Floats | None, inertia: Inertia | None
) -> tuple[float | None, tuple[float, float] | None, float | None]:
    """The three for a body in the plane; SceneError naming what is not usable."""
    center = None if center_of_mass is None else pair(center_of_mass, "center_of_mass")
    moment = None
    if inertia is not None:
        moment = number(inertia, "inertia in the plane", "a number (kg m^2)")
    return optional_number(mass, "mass"), center, moment


def in_space(
    mass: float | None, center_of_mass: Floats | None, inertia: Inertia | None
) -> tuple[float | None, tuple[float, float, float] | None, _Rows | None]:
    """The three for a body in space; SceneError naming what is not usable."""
    center = None if center_of_mass is None else triple(center_of_mass, "center_of_mass")
    return (
        optional_number(mass, "mass"),
        center,
        None if inertia is None else _rows(inertia),
    )


def _rows(value: object) -> _Rows:
    what = "inertia in space"
    try:
        rows = [triple(row, what) for row in value]  # type: ignore[attr-defined]
    except (TypeError, _core.SceneError) as error:
        raise type(error)(f"{what} must be 3 rows of 3 numbers, not {value!r:.80}") from None
    if len(rows) != 3:
        raise _core.SceneError(f"{what} must be 3 rows of 3 numbers, not {value!r:.80}")
    return tuple(rows)
