"""Recordings in space made by hand: five cubes on the ground, taken away one by one, and a fall."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import drystone as ds
from drystone.recording.contract import ABSENT, MOTIONLESS, NEXT, PRESENT
from drystone.scene import Solid
from drystone.viewer import FrameForces, Recording, Series


def box(
    name: str,
    center: Sequence[float],
    size: Sequence[float] = (1, 1, 1),
    fixed: bool = False,
    orientation: Sequence[float] = (1, 0, 0, 0),
) -> Solid:
    """A box as scenes have it, but in none: the next one may be anywhere."""
    scene = ds.Scene(dimension=3)
    scene.add_box(center, size, name=name, fixed=fixed, orientation=orientation)
    solid: Solid = scene.body(name)
    return solid


def solids() -> list[Solid]:
    """Four cubes with a gap of a tenth between them, and one on top of all."""
    low = [
        box(f"low{i}{j}", (1.1 * (i - 0.5), 1.1 * (j - 0.5), 0.5))
        for i in range(2)
        for j in range(2)
    ]
    ground = box("ground", (0, 0, -0.25), (5, 5, 0.5), fixed=True)
    return [ground, *low, box("top", (0, 0, 1.5))]


def plan_by_hand() -> Recording:
    """The top goes first; each cube stands on four points, each with a quarter of what it bears."""
    bodies = solids()
    order = [5, 4, 3, 2, 1]
    states = np.full((6, 6), PRESENT, dtype=np.uint8)
    for step, body in enumerate(order):
        states[step, body] = NEXT
        states[step + 1 :, body] = ABSENT
    return Recording(
        kind="plan",
        title="Order found for 5 blocks",
        bodies=bodies,
        states=states,
        gravity=(0.0, 0.0, -9.81),
        forces=_forces(bodies, order),
        series=[Series("pivots of the stability tests", np.array([np.nan, 4, 3, 2, 1, np.nan]))],
        captions=[(step, f"{5 - step} left.") for step in range(6)],
    )


def _forces(bodies: list[Solid], order: list[int]) -> FrameForces:
    pairs, points, vectors, offsets = [], [], [], [0]
    for step in range(6):
        for body in order[step:]:
            below = [0] if body < 5 else [1, 2, 3, 4]
            x, y, _ = bodies[body].centroid
            weight = 9.81 * (1.0 if body == 5 or step > 0 else 1.25)
            for i, (a, b) in enumerate([(-1, -1), (-1, 1), (1, -1), (1, 1)]):
                pairs.append((below[i % len(below)], body))
                points.append((x + 0.45 * a, y + 0.45 * b, 0.0 if body < 5 else 1.0))
                vectors.append((0.0, 0.0, weight / 4))
        offsets.append(len(pairs))
    return FrameForces(
        offsets,
        np.reshape(pairs, (-1, 2)),
        np.reshape(points, (-1, 3)),
        np.reshape(vectors, (-1, 3)),
    )


def run_by_hand(steps: int = 120) -> Recording:
    """The top slides off and turns, the others rest: steps of 1/240 s."""
    bodies = solids()
    times = np.arange(steps + 1) / 240
    pose = [[*body.centroid, *body.orientation] for body in bodies]
    poses = np.tile(pose, (steps + 1, 1, 1))
    poses[:, 5, 0] += 4 * times
    poses[:, 5, 2] -= 4.905 * np.clip(times - 0.2, 0, None) ** 2
    poses[:, 5, 3] = np.cos(2 * times)
    poses[:, 5, 5] = np.sin(2 * times)
    states = np.full((steps + 1, 6), MOTIONLESS, dtype=np.uint8)
    states[1:, 5] = PRESENT
    return Recording(
        kind="run",
        title="A cube slides off",
        bodies=bodies,
        states=states,
        gravity=(0.0, 0.0, -9.81),
        poses=poses,
        times=times,
        series=[Series("pivots per step", np.r_[np.nan, np.arange(steps) % 7])],
    )
