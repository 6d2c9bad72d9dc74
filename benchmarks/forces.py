"""Canonical forces beside the verdict that they belong to, for docs/theory/canonical-forces.md.

    .venv/bin/python benchmarks/forces.py

Milliseconds of processor time, the least of several: `ds.check(scene)`, contacts included, and then
reading its `forces`. One after the other on one core; other programs on the machine make it slower
all the same, by some tenths.
"""

from __future__ import annotations

import threads  # noqa: F401  (before anything that loads NumPy)

# isort: split

import time
from collections.abc import Callable

import cold_scenes
import drystone as ds

REPEATS = 8

STRUCTURES: dict[str, Callable[[], ds.Scene]] = {
    "wall 10": lambda: cold_scenes.wall(10, 0.0),
    "wall 20": lambda: cold_scenes.wall(20, 0.0),
    "wall 30": lambda: cold_scenes.wall(30, 0.0),
    "wall 40": lambda: cold_scenes.wall(40, 0.0),
    "wall 10, k = 0.2": lambda: cold_scenes.wall(10, 0.2),
    "wall 20, k = 0.2": lambda: cold_scenes.wall(20, 0.2),
    "wall 20, k = 0.5": lambda: cold_scenes.wall(20, 0.5),
    "arch": lambda: ds.scenes.arch(200, friction=0.5),
    "pyramid 20": lambda: ds.scenes.pyramid(20, friction=0.5),
    "bricks in space 10 x 15": lambda: ds.scenes.brick_wall(10, 15),
    "bricks in space 20 x 30": lambda: ds.scenes.brick_wall(20, 30),
    "bricks in space 25 x 40": lambda: ds.scenes.brick_wall(25, 40),
    "dome, 8 rings": lambda: cold_scenes.dome(8, 0.7),
    "square pyramid 10": lambda: ds.scenes.square_pyramid(10, friction=0.5),
    "loose brick 8": lambda: cold_scenes.loose_brick(8),
}


def milliseconds(call: Callable[[], object]) -> float:
    """Of processor time."""
    begun = time.process_time()
    call()
    return 1e3 * (time.process_time() - begun)


def row(name: str, build: Callable[[], ds.Scene]) -> str:
    """A line of the table."""
    scene = build()
    checks, forces = [], []
    for _ in range(REPEATS):
        found: list[ds.Verdict] = []
        checks.append(milliseconds(lambda: found.append(ds.check(scene))))  # noqa: B023
        forces.append(milliseconds(lambda: found[0].forces.vectors))  # noqa: B023
        verdict = found[0]
    ends = "stands" if verdict.stable else "falls"
    counts = f"{len(verdict.names):,} | {len(scene.contacts):,}"
    return f"| {name} | {counts} | {ends} | {two_digits(min(checks))} | {two_digits(min(forces))} |"


def two_digits(value: float) -> str:
    """0.44, 3.5, 23, 360."""
    return f"{value:.2g}" if value < 99.5 else f"{10 * round(value / 10):d}"


if __name__ == "__main__":
    print("| structure | blocks | points | | check | forces |\n|---|---:|---:|---|---:|---:|")
    for name, build in STRUCTURES.items():
        print(row(name, build), flush=True)
