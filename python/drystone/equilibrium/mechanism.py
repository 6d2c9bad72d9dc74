"""What is shown of a structure that moves: forces, and how blocks go."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from drystone.equilibrium.contact_force import ContactForces
    from drystone.equilibrium.limits import Limit
    from drystone.equilibrium.margins import Margin
    from drystone.scene import Scene


class Moved(Protocol):
    """A structure with forces, and with blocks that move, if any do; `str` is its caption."""

    @property
    def scene(self) -> Scene: ...
    @property
    def names(self) -> tuple[str, ...]:
        """The movable bodies that are there."""

    @property
    def forces(self) -> ContactForces | None: ...
    @property
    def falling(self) -> tuple[str, ...]: ...
    def acceleration(self, name: str) -> NDArray[np.float64]:
        """(3,), in space (6,)."""


@dataclass(frozen=True, slots=True)
class Mechanism:
    """What is shown of a structure that collapses, as a `Moved`."""

    scene: Scene
    names: tuple[str, ...]
    forces: ContactForces | None
    motion: dict[str, NDArray[np.float64]]
    """Velocities of the blocks that move, m/s and rad/s."""
    text: str

    @property
    def falling(self) -> tuple[str, ...]:
        return tuple(self.motion)

    def acceleration(self, name: str) -> NDArray[np.float64]:
        return self.motion[name]

    def __str__(self) -> str:
        return self.text


def at_limit(limit: Limit) -> Mechanism:
    """At the greatest factor, with the push as loads."""
    scene = limit.scene
    if limit.push and math.isfinite(limit.factor):
        scene = scene.with_gravity(scene.gravity)
        n = scene.dimension
        for name, entries in limit.push.items():
            force, moment = entries[:n], entries[n:]
            turn = limit.factor * moment[0] if n == 2 else [limit.factor * m for m in moment]
            scene.add_load(name, [limit.factor * f for f in force], moment=turn)
    return Mechanism(scene, limit.names, limit.forces, limit.mechanism, str(limit))


def at_margin(margin: Margin) -> Mechanism:
    """Under the least horizontal acceleration."""
    return Mechanism(margin.scene, margin.names, margin.forces, margin.mechanism, str(margin))
