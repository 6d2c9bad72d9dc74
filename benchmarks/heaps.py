"""Heaps of boxes that tumble in space beside MuJoCo, and a cube thrown at a wall of bricks.

    .venv/bin/pip install "mujoco<4"      # as far as wanted
    .venv/bin/python benchmarks/heaps.py [BOXES ...]

All fall at once, turned at random, and meet one another: on no other input does a step take as
long. MuJoCo has elliptic cones and its own settings for the rest; it lets boxes overlap by
millimetres. Microseconds of a step, over two seconds at 240 steps a second; the worst step; how
many steps are not within the tolerance of Coulomb's law.
"""

from __future__ import annotations

import threads  # noqa: F401  (before anything that loads NumPy)

# isort: split

import argparse

import numpy as np
from rich.console import Console
from rich.table import Table

import drystone as ds
from simulators.base import Velocities
from simulators.mujoco import MuJoCo

BOXES = (10, 27, 54, 200, 500)
STEPS, DT = 480, 1 / 240
SPACING = 1.3
"""Metres between the middles of boxes of .3 to .8 m, three by three in a layer."""
THROWN = {"thrown": (0, 9, 0, 0, 0, 0)}
"""m/s, rad/s."""


def heap(boxes: int, seed: int = 0) -> ds.Scene:
    """Boxes above a ground, that fall when the first step is made."""
    random = np.random.default_rng(seed)
    scene = ds.Scene(dimension=3, friction=0.5)
    scene.add_box((0, 0, -0.5), (40, 40, 1), name="ground", fixed=True)
    for k in range(boxes):
        layer, i, j = k // 9, k % 9 // 3, k % 3
        size, turn = random.uniform(0.3, 0.8, 3), random.normal(size=4)
        place = (SPACING * (i - 1), SPACING * (j - 1), 0.8 + SPACING * layer)
        turn = tuple(turn / np.linalg.norm(turn))
        scene.add_box(place, tuple(size), orientation=turn, name=f"b{k}")
    return scene


def thrown() -> ds.Scene:
    """A wall of 27 bricks, and a cube that hits it when it flies as `THROWN` says."""
    scene = ds.scenes.brick_wall(6, 4)
    scene.add_box((2, -4, 1.5), (0.6, 0.6, 0.6), name="thrown", density=3)
    return scene


def line(scene: ds.Scene, steps: int, velocities: Velocities | None = None) -> list[str]:
    """The cells of one line: ours, and MuJoCo's where it is installed."""
    run = ds.simulate(scene, DT, steps, velocities=velocities)
    seconds = run.step_seconds
    exact = f"{run.not_exact} of {run.steps}"
    ours = [f"{1e6 * seconds.mean():.0f}", f"{1e3 * seconds.max():.0f}", exact]
    peer = MuJoCo(cone="elliptic")
    if peer.missing():
        return [*ours, "", ""]
    step = peer.run(scene, DT, steps, steps, velocities).seconds / steps
    return [*ours, f"{1e6 * step:.0f}", f"{seconds.mean() / step:.1f}"]


def main() -> None:
    """Print a line for each heap, and one for the cube."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("boxes", nargs="*", type=int, default=BOXES)
    table = Table("", "us a step", "worst, ms", "not exact", "MuJoCo, us", "ratio")
    for boxes in parser.parse_args().boxes:
        table.add_row(f"{boxes} boxes", *line(heap(boxes), STEPS))
    table.add_row("thrown cube", *line(thrown(), 360, THROWN))
    Console(width=100).print(table)


if __name__ == "__main__":
    main()
