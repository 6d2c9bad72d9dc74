"""One rigid body of an MJCF or URDF file while it is put together."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, get_args

from drystone.common.choices import Joints
from drystone.imports.collected import Collected, FormatError
from drystone.imports.weight import Weight, of_pieces, together
from drystone.meshes.hull import hull_corners

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

JOINTS = get_args(Joints)
"""What may be done with joints that turn or slide."""


class JointError(FormatError):
    """A body hangs on a joint that a scene does not have; it stops the import."""


@dataclass(slots=True, eq=False)
class Rigid:
    """What is rigidly joined together, in the world."""

    name: str
    fixed: bool
    pieces: list[NDArray[np.float64]] = field(default_factory=list)
    """Convex, (k, 3) each; they may overlap."""
    weights: list[Weight] = field(default_factory=list)
    frictions: list[float] = field(default_factory=list)
    tolerance: float = 0.0
    """How far vertices of its meshes may be off, metres."""

    def finish(self, collected: Collected) -> None:
        """Add the body, if there is something that touches."""
        if not self.pieces:
            collected.lack(f"body {self.name}", "it has no box and no mesh that collides")
            return
        if self.frictions and max(self.frictions) > min(self.frictions):
            collected.messages.append(
                f"{self.name}: its shapes have different friction: the smallest is taken"
            )
        collected.add(
            self.name,
            [hull_corners(piece) for piece in self.pieces],
            friction=min(self.frictions) if self.frictions else None,
            fixed=self.fixed,
            tolerance=self.tolerance,
            weight=None if self.fixed else self._weight(collected),
        )

    def _weight(self, collected: Collected) -> Weight:
        weight = together(self.weights)
        if weight.mass <= 0:
            raise FormatError("it moves, but weighs nothing: give it a mass")
        if weight.is_of_a_body():
            return weight
        filled = of_pieces(self.pieces)
        collected.messages.append(
            f"{self.name}: no rigid body has its inertia: that of its shape is taken"
        )
        return Weight(weight.mass, weight.center, weight.mass / filled.mass * filled.inertia)


def joint_of(name: str, kind: str, joints: str, collected: Collected, to: str) -> None:
    """Note that a body is welded where its joint is at zero, or refuse it."""
    if joints != "fixed":
        raise JointError(
            f"{name} hangs on a {kind} joint, and bodies of a scene are free or fixed: "
            "joints='fixed' (--joints fixed) welds it where it is"
        )
    collected.messages.append(f"{name}: its {kind} joint is welded, to {to}")
