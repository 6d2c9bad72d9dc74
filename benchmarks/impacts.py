"""What is hit: walls, columns and dominoes at three sizes each, beside MuJoCo and Rapier.

    .venv/bin/pip install "mujoco<4"      # as far as wanted; Rapier needs cargo
    .venv/bin/python benchmarks/impacts.py [--kinds KIND ...] [-o DIR]

A heavy block flies at 15 or 20 m/s against what has stood so far, so that all its contacts bear
anew at once: on no other input does a single step take as long. Half a second to three at 240
steps a second. The others have their own settings and leave overlaps; MuJoCo's cones are elliptic,
Rapier is there in the plane. Results go to results/<machine>/<version>-<date>-impacts.csv.
"""

from __future__ import annotations

import threads  # noqa: F401  (before anything that loads NumPy)

# isort: split

import argparse
from collections.abc import Callable
from dataclasses import dataclass

import drystone as ds
import fastest_run
import kept_table
import results
from kept_table import KeptTable
from simulators import Simulator
from simulators.base import Velocities
from simulators.drystone import Drystone
from simulators.mujoco import MuJoCo
from simulators.rapier import Rapier

COLUMNS = (*results.WHERE, *fastest_run.COLUMNS, *fastest_run.BESIDE)
"""Explained in benchmarks/README.md."""

SHOWN = {"scene": "", "simulator": "", **fastest_run.BESIDE}
FRICTION = 0.6


def wall_in_space(rows: int) -> ds.Scene:
    """A wall of as many columns, half a brick off in turns, and a heavy cube."""
    scene = ds.Scene(dimension=3, friction=FRICTION)
    scene.add_box((0, 0, -0.5), (60, 60, 1), name="ground", fixed=True)
    for row in range(rows):
        for k in range(rows):
            x = k - (rows - 1) / 2 + (0.25 if row % 2 else -0.25)
            scene.add_box((x, 0, 0.25 + 0.5 * row), (1, 0.5, 0.5), name=f"{row}-{k}")
    scene.add_box((0, -2, rows / 4), (0.8, 0.8, 0.8), name="thrown", density=5000)
    return scene


def wall(rows: int) -> ds.Scene:
    """The wall of `drystone.scenes`, and a heavy block beside it."""
    scene = ds.scenes.wall(rows, friction=FRICTION)
    scene.add_box((-1, 0.25 * rows), (1, 1), name="thrown", density=4000)
    return scene


def column(blocks: int) -> ds.Scene:
    """A column, and a heavy block beside its upper half."""
    scene = ds.scenes.column(blocks, friction=FRICTION)
    scene.add_box((-2, 0.6 * blocks), (1, 1), name="thrown", density=3000)
    return scene


def dominoes(count: int) -> ds.Scene:
    """Dominoes in a row; the first is pushed."""
    scene = ds.Scene(friction=0.5)
    scene.add_box((0.15 * count, -0.5), (0.3 * count + 10, 1), name="ground", fixed=True)
    for k in range(count):
        scene.add_box((0.3 * k, 0.4), (0.08, 0.8), name="thrown" if k == 0 else f"{k}")
    return scene


@dataclass(frozen=True)
class Kind:
    """One kind of scene, at its sizes."""

    build: Callable[[int], ds.Scene]
    sizes: tuple[int, ...]
    velocity: tuple[float, ...]
    steps: int

    def velocities(self) -> Velocities:
        """Of what is thrown."""
        return {"thrown": self.velocity}


KINDS = {
    "wall in space": Kind(wall_in_space, (6, 8, 12), (0, 20, 0, 0, 0, 0), 240),
    "wall": Kind(wall, (6, 10, 20), (15, 0, 0), 120),
    "column": Kind(column, (20, 80, 200), (15, 0, 0), 240),
    "dominoes": Kind(dominoes, (50, 200, 800), (1, 0, -2), 720),
}


def measure(name: str, size: int, simulators: list[Simulator]) -> list[dict[str, object]]:
    """A line for each simulator."""
    kind = KINDS[name]
    scene = kind.build(size)
    able = [s for s in simulators if scene.dimension in s.dimensions]
    common = fastest_run.common(f"{name} of {size}", len(scene), scene.friction, kind.steps)
    return list(fastest_run.beside(common, scene, kind.steps, able, kind.velocities()))


def main() -> None:
    """Measure what the arguments say."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS))
    results.add_output(parser)
    arguments = parser.parse_args()
    every: list[Simulator] = [Drystone("full"), MuJoCo(cone="elliptic"), Rapier()]
    ready = kept_table.ready(every)
    table = KeptTable(arguments.output, "impacts", COLUMNS, SHOWN)
    for name in arguments.kinds:
        for size in KINDS[name].sizes:
            table.add(measure(name, size, ready))
    table.show(every)


if __name__ == "__main__":
    main()
