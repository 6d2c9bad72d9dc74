"""Does a structure stand under many combinations of a few loads?"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone import _core
from drystone.common.arrays import floats
from drystone.common.cones import FACETS, INSCRIBED, ROUND, Cone, core_cones
from drystone.common.numbers import Floats, names_of
from drystone.common.text import counted
from drystone.equilibrium.limits import Push, core_push
from drystone.scene import Scene
from drystone.scene.scene import scene_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

MOST_FACTOR = 1e9
"""Beyond it a factor is a mistake."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class LoadCases:
    """The answer of `load_cases`."""

    factors: NDArray[np.float64]
    """(cases, loads): what was asked."""
    stands: NDArray[np.bool_]
    """(cases,): whether the structure can stand in each."""
    decided: NDArray[np.bool_]
    """(cases,): False where neither standing nor falling is proved, within rounding of the limit;
    `stands` is False there."""
    solved: int
    """How many cases took a computation of their own. What others proved told the rest."""
    seconds: float
    """Wall time."""
    scene: Scene = field(repr=False)
    """The scene asked about."""

    @property
    def falling(self) -> NDArray[np.intp]:
        """The cases in which it falls, ascending."""
        return np.flatnonzero(self.decided & ~self.stands)

    def __str__(self) -> str:
        falls, open_cases = len(self.falling), int((~self.decided).sum())
        told = f"Can stand in {int(self.stands.sum())} of {counted(len(self.stands), 'load case')}"
        told += f", falls in {falls}"
        told += f", undecided {open_cases}" if open_cases else ""
        return f"{told}; {self.solved} solved."

    def __repr__(self) -> str:
        return f"<LoadCases: {self}>"

    def to_dict(self) -> dict[str, Any]:
        """Everything but the scene, in types that JSON knows; None where a case is not decided."""
        stands = [
            bool(stands) if decided else None
            for stands, decided in zip(self.stands, self.decided, strict=True)
        ]
        return {
            "factors": self.factors.tolist(),
            "stands": stands,
            "solved": self.solved,
            "seconds": self.seconds,
        }


def load_cases(
    scene: Scene,
    loads: Sequence[Push | Floats],
    factors: ArrayLike,
    blocks: Iterable[str] | None = None,
    *,
    facets: int = FACETS,
    cone: Cone = ROUND,
) -> LoadCases:
    """Does a structure stand under each of many load cases?

    A case is the scene's own loads and the sum of some others, each times a factor: wind from the
    left times 1.5 and snow times 0.7, say. `loads` are these others, each either forces on bodies
    (`push` of `limit`: N, and N m) or an acceleration of all bodies (`gravity` of `limit`: m/s^2).
    `factors` is (cases, loads). `blocks`, `facets` and `cone` are as in `limit`.

    The verdicts are those of `check` with the loads of a case. They are found together: the loads
    that a structure bears are a convex set, forces that hold it in one case can be changed to hold
    it in those around, and a mechanism brings it down in all cases in which the loads do work in
    it. Few cases need a computation of their own, the fewer the less there are loads.

    Raises SceneError for what `limit` does, and for factors that are not (cases, loads) finite
    numbers of at most 1e9.

    >>> import drystone as ds
    >>> tower = ds.scenes.column(11, friction=2.0)  # ten unit blocks: 0.1 g sideways is the limit
    >>> wind, quake = {"10": (1.0, 0.0)}, (9.81, 0.0)
    >>> cases = ds.load_cases(tower, [wind, quake], [(0, 0.09), (0, -0.11), (3, 0.04), (3, 0.05)])
    >>> cases.stands.tolist()
    [True, False, True, False]
    """
    names = names_of(blocks)
    cones = core_cones(facets, INSCRIBED if cone == ROUND else cone)
    scene = copy.copy(scene_of(scene))
    if isinstance(loads, Mapping | str):
        raise TypeError(f"loads must be a list of loads, not {loads!r:.80}")
    pushes = [_push(scene, load) for load in loads]
    rows = _factors(factors, len(pushes))
    found = _core.load_cases(scene._core, pushes, rows.tolist(), names, cones, cone == ROUND)
    stands, solved, seconds = found
    return LoadCases(rows, stands == 1, stands >= 0, solved, seconds, scene)


def _push(scene: Scene, load: Any) -> Any:
    """A load as the core takes it."""
    return (
        core_push(scene, load, None) if isinstance(load, Mapping) else core_push(scene, None, load)
    )


def _factors(factors: ArrayLike, loads: int) -> NDArray[np.float64]:
    """(cases, loads), read-only; TypeError or SceneError for what is none."""
    wanted = f"factors must be numbers, (cases, {loads})"
    rows: NDArray[np.float64] = floats(
        factors, "factors", _core.SceneError, f"be numbers, (cases, {loads})"
    ).copy()
    if rows.size == 0:
        rows = rows.reshape(len(rows), loads) if rows.ndim else rows
    if rows.ndim != 2 or rows.shape[1] != loads:
        raise _core.SceneError(f"{wanted}, not of shape {rows.shape}")
    if not (np.abs(rows) <= MOST_FACTOR).all():
        raise _core.SceneError(f"{wanted}, each from -1e9 to 1e9")
    rows.setflags(write=False)
    return rows
