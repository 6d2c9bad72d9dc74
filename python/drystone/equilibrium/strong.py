"""Must it stand? What the search for another motion than rest has found."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from drystone import _core
from drystone.common import later
from drystone.common.drawn import Paged
from drystone.common.text import MOST_ROWS, counted, shorten
from drystone.equilibrium.contact_force import ANY, ContactForces
from drystone.scene import Scene

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Progress = Callable[[int, float], None]
"""Called during a search with (nodes looked at, share of the budget that is used, 0 to 1)."""

MOVES = 1e-6
"""A block slower than this share of the fastest is at rest in an escape: what the tolerances of the
linear programs leave."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Escape(Paged):
    """A motion, with contact forces, in which blocks at rest can begin to move although they could
    stay: it obeys every law of contact (Newton and Euler, no penetration, no force where contacts
    part, Coulomb's friction against what slides)."""

    names: tuple[str, ...]
    """The movable bodies checked, in the order of the rows of `accelerations`."""
    accelerations: NDArray[np.float64]
    """(bodies, 3): x and y in m/s^2, and the angular one in rad/s^2, counter-clockwise. In space
    (bodies, 6): x, y and z, and the angular ones about x, y and z."""
    forces: ContactForces
    """The forces at the contact points, N."""
    error: float
    """The largest error in any of the laws, as a share of the fastest acceleration, computed anew
    from bodies and contact points: at most 1e-7."""
    scene: Scene = field(repr=False)

    @classmethod
    def _of(cls, core: _core.Escape, scene: Scene) -> Escape:
        forces = ContactForces(None, ANY, core.forces)
        return cls(tuple(core.names), core.accelerations, forces, core.error, scene)

    @property
    def falling(self) -> tuple[str, ...]:
        """Names of the bodies that move."""
        speeds = abs(self.accelerations).max(axis=1, initial=0.0)
        least = MOVES * speeds.max(initial=0.0)
        return tuple(name for name, s in zip(self.names, speeds, strict=True) if s > least)

    def acceleration(self, name: str) -> NDArray[np.float64]:
        """The row of `accelerations` of the body called `name`, in m/s^2 and rad/s^2."""
        try:
            row: NDArray[np.float64] = self.accelerations[self.names.index(name)]
        except ValueError:
            raise _core.SceneError(f"{name!r} is not a movable body of this check") from None
        return row

    def __str__(self) -> str:
        blocks = f"{len(self.falling)} of {counted(len(self.names), 'block')}"
        return f"Escape: {blocks} ({shorten(self.falling)}); error {self.error:.1e}."

    def __repr__(self) -> str:
        return f"<{self}>"

    def table(self, rows: int = MOST_ROWS) -> str:
        """The accelerations of the first `rows` blocks that move, as text."""
        return later.table(self, rows)

    def to_dict(self) -> dict[str, Any]:
        """Accelerations, and the forces as those of a verdict."""
        lines = self.forces.json_lines()
        return {
            "accelerations": {
                name: row.tolist() for name, row in zip(self.names, self.accelerations, strict=True)
            },
            "forces": [force for some in lines for force in json.loads(f"[{some}]")],
            "error": self.error,
        }
