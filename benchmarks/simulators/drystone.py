"""drystone in one mode of reuse.

Timed: the whole of `World::step` by its own clock (`Run.step_seconds`): finding contacts, making
the problem, all its solves, moving, taking back overlaps. Recording is left out.
"""

from __future__ import annotations

import numpy as np

import drystone as ds
from simulators.base import Motion, Simulator, Velocities


class Drystone(Simulator):
    """`drystone.simulate`."""

    dimensions = (2, 3)

    def __init__(self, reuse: str) -> None:
        self.reuse = reuse
        self.name = f"drystone {reuse}"

    def version(self) -> str:
        """See `Simulator.version`."""
        return ds.__version__

    def missing(self) -> str:
        """See `Simulator.missing`."""
        return ""

    def run(
        self,
        scene: ds.Scene,
        dt: float,
        steps: int,
        every: int,
        velocities: Velocities | None = None,
    ) -> Motion:
        """See `Simulator.run`."""
        run = ds.simulate(scene, steps=steps, dt=dt, reuse=self.reuse, velocities=velocities)
        frames = np.concatenate([run.poses, run.velocities], axis=2)[::every]
        seconds = run.step_seconds
        worst = float(seconds.max(initial=0.0))
        return Motion(float(seconds.sum()), frames, run.reason or "", worst, run.not_exact)
