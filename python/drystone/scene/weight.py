"""A body's own mass, centre of mass and inertia, as the compiled core takes them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from drystone import _core

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Inertia: TypeAlias = "float | Sequence[Sequence[float]] | NDArray[np.float64]"
"""kg m^2 about the centre of mass: a number in the plane, (3, 3) in space."""

_Rows: TypeAlias = tuple[tuple[float, float, float], ...]


def in_plane(
    mass: float | None, center_of_mass: Sequence[float] | None, inertia: Inertia | None
) -> tuple[float | None, tuple[float, float] | None, float | None]:
    """The three for a body in the plane; SceneError naming what is not usable."""
    center = None if center_of_mass is None else _numbers(center_of_mass, 2, "center_of_mass")
    moment = None
    if inertia is not None:
        try:
            moment = float(inertia)  # type: ignore[arg-type]
        except (TypeError, ValueError):
            raise _core.SceneError(
                f"inertia in the plane must be a number (kg m^2), not {inertia!r}"
            ) from None
    return mass, None if center is None else (center[0], center[1]), moment


def in_space(
    mass: float | None, center_of_mass: Sequence[float] | None, inertia: Inertia | None
) -> tuple[float | None, tuple[float, float, float] | None, _Rows | None]:
    """The three for a body in space; SceneError naming what is not usable."""
    center = None if center_of_mass is None else _numbers(center_of_mass, 3, "center_of_mass")
    return (
        mass,
        None if center is None else (center[0], center[1], center[2]),
        None if inertia is None else _rows(inertia),
    )


def _numbers(value: Any, count: int, what: str) -> tuple[float, ...]:
    try:
        found = tuple(float(x) for x in value)
    except (TypeError, ValueError):
        found = ()
    if len(found) != count:
        raise _core.SceneError(f"{what} must be {count} numbers, not {value!r}")
    return found


def _rows(value: Any) -> _Rows:
    try:
        rows = [tuple(float(x) for x in row) for row in value]
    except (TypeError, ValueError):
        rows = []
    if [len(row) for row in rows] != [3, 3, 3]:
        raise _core.SceneError(f"inertia in space must be 3 rows of 3 numbers, not {value!r}")
    return tuple((x, y, z) for x, y, z in rows)
