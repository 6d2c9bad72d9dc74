"""How blocks follow supports that settle: hinges, displacements, and the forces after it."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, cast

from drystone import _core
from drystone.common import later
from drystone.common.drawn import Paged
from drystone.common.text import MOST_ROWS, counted, shorten
from drystone.equilibrium.contact_force import ContactForces, WhichForces
from drystone.equilibrium.limits import finite
from drystone.scene import Scene

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

JointOpening: TypeAlias = Literal["hinge", "slides", "parts"]
"""What an open joint does."""

ROUNDING = 1e-12
"""Work below this share of all weights times the largest displacement is rounding."""


@dataclass(frozen=True, slots=True)
class Joint:
    """A face between two bodies that a settlement opens, or lets slide."""

    a: str
    b: str
    opening: JointOpening
    """"hinge": it opens about a point, in space mostly an edge, which stays closed. "slides": it
    slides, and opens by the angle of friction (the associated flow rule); it can still bear.
    "parts": it opens all over."""
    at: tuple[float, ...]
    """The hinge, metres, world coordinates (of an edge its middle); of what slides or parts the
    middle of where it opens least."""
    opens: float
    """The largest displacement of `b` away from `a` along the normal, metres."""
    slides: float
    """The largest displacement across the normal, metres."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Settled(Paged):
    """How the blocks of a structure follow the settlements of its supports.

    Displacements are small: positions of contacts, and their normals, count as they were before.
    So a settlement twice as large gives displacements twice as large, and the same forces."""

    status: str
    """"solved"; "no_solution" if the supports squeeze blocks (`squeezed`), so that no small
    displacement of rigid blocks goes with theirs; or why there is no answer."""
    names: tuple[str, ...]
    """The movable bodies, in the order of the rows of `displacements`."""
    displacements: NDArray[np.float64]
    """(bodies, 3): x and y of the centre of mass in metres, and the turn in radians,
    counter-clockwise. In space (bodies, 6): x, y and z, and the turns about x, y and z. NaN
    without an answer.

    Of all displacements in which no contact closes they are the ones with the least potential
    energy of the loads; of several such the nearest to rest, masses being the weights."""
    joints: tuple[Joint, ...]
    """The joints that open or slide by more than 1e-4 of the largest displacement."""
    forces: ContactForces | None
    """The contact forces after the settlement: of those that hold the structure, the ones with
    which the loads did all the work that they could. There is none where a joint has opened, and
    at a hinge it acts in the hinge. What this leaves open is decided as in `Verdict.forces`. None
    without an answer."""
    work: float
    """Work of the loads in these displacements, J: the potential energy that is set free."""
    bound: float
    """The work of the forces on the supports, J: the loads cannot do more in any displacement. The
    same number as `work`, computed in another way: it is the proof."""
    imbalance: float
    """What the forces leave unbalanced on the worst block, as a share of its load or of the largest
    force on it: rounding."""
    closing: float
    """How far a contact closes, as a share of the largest displacement: rounding."""
    squeezed: tuple[str, ...]
    """Without a solution: the bodies between which forces grow without end."""
    iterations: int
    """Matrices factored by the interior-point method."""
    seconds: float
    """Wall time."""
    resolution: float
    """Metres: smaller displacements between bodies count as none."""
    scene: Scene = field(repr=False)
    """The scene asked about."""

    @classmethod
    def _of(cls, core: _core.Settled, scene: Scene, forces: WhichForces) -> Settled:
        def joint(
            a: str, b: str, opening: str, at: tuple[float, ...], opens: float, slides: float
        ) -> Joint:
            return Joint(a, b, cast("JointOpening", opening), at, opens, slides)

        return cls(
            core.status,
            tuple(core.names),
            core.displacements,
            tuple(joint(*found) for found in core.joints),
            None if core.forces is None else ContactForces(core.forces, forces),
            core.work,
            core.bound,
            core.imbalance,
            core.closing,
            tuple(core.squeezed),
            core.iterations,
            core.seconds,
            core.resolution,
            scene,
        )

    @property
    def hinges(self) -> tuple[Joint, ...]:
        """The joints that are hinges."""
        return tuple(joint for joint in self.joints if joint.opening == "hinge")

    @property
    def moving(self) -> tuple[str, ...]:
        """Names of the blocks that move, of those at all."""
        sizes = abs(self.displacements).max(axis=1, initial=0.0)
        return tuple(n for n, s in zip(self.names, sizes, strict=True) if s > self.resolution)

    def displacement(self, name: str) -> NDArray[np.float64]:
        """The row of `displacements` of the body called `name`, in metres and radians."""
        try:
            row: NDArray[np.float64] = self.displacements[self.names.index(name)]
        except ValueError:
            raise _core.SceneError(f"{name!r} is not a movable body of this check") from None
        return row

    def table(self, rows: int = MOST_ROWS) -> str:
        """The first `rows` joints that open, as text."""
        return later.table(self, rows)

    def __str__(self) -> str:
        work = counted(self.iterations, "iteration")
        if self.status == "no_solution":
            return f"Settlement: no rigid blocks can follow it, squeezed: {shorten(self.squeezed)}."
        if self.status != "solved":
            return f"Settlement: no answer ({self.status}); {work}."
        blocks = f"{len(self.moving)} of {counted(len(self.names), 'block')}"
        if not self.moving:
            return f"Settlement: nothing follows it; {work}."
        joints = counted(len(self.joints), "joint") + (
            " opens" if len(self.joints) == 1 else " open"
        )
        return (
            f"Settlement: {blocks} move, {joints} ({counted(len(self.hinges), 'hinge')}); "
            f"the loads do {self._work_said():.4g} J; {work}."
        )

    def _work_said(self) -> float:
        """The work, or 0 where it is rounding of what the weights could do."""
        weights = sum(body.mass for body in self.scene.bodies) * math.hypot(*self.scene.gravity)
        could = weights * float(abs(self.displacements).max(initial=0.0))
        return self.work if abs(self.work) > ROUNDING * could else 0.0

    def __repr__(self) -> str:
        return f"<{self}>"

    def to_dict(self) -> dict[str, Any]:
        """Everything but the scene, in types that JSON knows."""
        lines = () if self.forces is None else self.forces.json_lines()
        solved = self.status == "solved"
        rows = zip(self.names, self.displacements, strict=True) if solved else ()
        return {
            "status": self.status,
            "settlements": [
                {
                    "body": s.body,
                    "displacement": list(s.displacement),
                    "rotation": s.rotation if isinstance(s.rotation, float) else list(s.rotation),
                    "at": list(s.at),
                }
                for s in self.scene.settlements
            ],
            "displacements": {name: row.tolist() for name, row in rows},
            "joints": [
                {
                    "a": joint.a,
                    "b": joint.b,
                    "opening": joint.opening,
                    "at": list(joint.at),
                    "opens": joint.opens,
                    "slides": joint.slides,
                }
                for joint in self.joints
            ],
            "forces": [force for some in lines for force in json.loads(f"[{some}]")],
            "work": finite(self.work),
            "bound": finite(self.bound),
            "imbalance": finite(self.imbalance),
            "closing": finite(self.closing),
            "squeezed": list(self.squeezed),
            "iterations": self.iterations,
            "seconds": self.seconds,
        }
