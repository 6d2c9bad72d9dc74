"""A structure at its limit, with the forces that still hold it; and one that can leave rest."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from drystone.pictures.figures import moved_figure

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from drystone.equilibrium.contact_force import ContactForces
    from drystone.equilibrium.limits import Limit
    from drystone.equilibrium.margins import Margin
    from drystone.equilibrium.strong import Escape
    from drystone.scene import Scene


@dataclass(frozen=True, slots=True)
class Mechanism:
    """What is drawn of a structure that collapses."""

    scene: Scene
    names: tuple[str, ...]
    forces: ContactForces | None
    motion: dict[str, NDArray[np.float64]]
    text: str

    @property
    def falling(self) -> tuple[str, ...]:
        return tuple(self.motion)

    def acceleration(self, name: str) -> NDArray[np.float64]:
        return self.motion[name]

    def __str__(self) -> str:
        return self.text


def escape_figure(escape: Escape) -> Figure:
    """How blocks leave rest although they could stay, with the forces in that motion."""
    return moved_figure(escape, "m/s²")


def margin_figure(margin: Margin) -> Figure:
    """The collapse under the least horizontal acceleration, with the forces before it."""
    motion = margin.mechanism
    shown = Mechanism(margin.scene, margin.names, margin.forces, motion, str(margin))
    return moved_figure(shown, "m/s")


def limit_figure(limit: Limit) -> Figure:
    """The greatest factor: contact forces and the push to scale, blocks that move in red."""
    scene = limit.scene
    if limit.push and math.isfinite(limit.factor):
        scene = scene.with_gravity(scene.gravity)
        n = scene.dimension
        for name, entries in limit.push.items():
            force, moment = entries[:n], entries[n:]
            turn = limit.factor * moment[0] if n == 2 else [limit.factor * m for m in moment]
            scene.add_load(name, [limit.factor * f for f in force], moment=turn)
    shown = Mechanism(scene, limit.names, limit.forces, limit.mechanism, str(limit))
    return moved_figure(shown, "m/s")
