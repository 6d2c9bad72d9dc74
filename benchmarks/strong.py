"""Strong stability: random structures beside a mixed-integer program, and simulations with gaps.

    .venv/bin/python benchmarks/strong.py [--random 1000] [--reference 60] [--runs 500] [--csv FILE]

`reference`: random planar structures of up to six blocks (`contact_laws.cut_stone`), those that can
stand: `check(strong=True)` beside HiGHS's mixed-integer search on the laws of contact, given so
many seconds each, for as long as `--budget` lasts, those of few contact points first.

`gaps`: structures that must stand and bear a horizontal acceleration of more than 1e-3 g, in all
500 simulations of a second. In each the blocks are made smaller by up to 1e-8 m at every corner, at
random, so that no joint is closed at first. What has moved by more than 1e-6 m has fallen, and is
told. "need friction": those that would fall without; for the others a fall could not be. As a
control the same is done with structures that need not stand, of which some should fall.
"""

from __future__ import annotations

import argparse
import csv
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

import drystone as ds

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "python"))
from contact_laws import check_escape, cut_stone, most_power
from test_strong import with_gaps

OFF = 1e-5
"""Power that counts as none in the mixed-integer search: its integers are off by up to 1e-6."""

MARGIN = 1e-3
MOVED = 1e-6
"""m: a hundred gaps."""

COLUMNS = ("seed", "blocks", "points", "must stand", "nodes", "reference", "seconds")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--random", type=int, default=1000, help="structures for the reference")
    parser.add_argument("--reference", type=float, default=60.0, help="seconds for each")
    parser.add_argument("--budget", type=float, default=600.0, help="seconds for all of them")
    parser.add_argument("--runs", type=int, default=500)
    parser.add_argument("--csv", type=Path)
    arguments = parser.parse_args()
    wrong = reference(arguments) if arguments.random else 0
    wrong += gaps(arguments.runs) if arguments.runs else 0
    return 1 if wrong else 0


def reference(arguments: argparse.Namespace) -> int:
    """How many disagree."""
    found = []
    for seed in range(arguments.random):
        scene = cut_stone(seed)
        verdict = ds.check(scene, strong=True)
        if not verdict.stable:
            continue
        if verdict.escape is not None:
            check_escape(scene, verdict.escape)
        blocks = sum(not body.fixed for body in scene.bodies)
        found.append([seed, blocks, len(scene.contacts), verdict.must_stand, verdict.nodes])
    found.sort(key=lambda row: (row[2], row[0]))
    count = Counter(row[3] for row in found)
    print(f"{arguments.random} structures, {len(found)} can stand: {count[True]} must, ", end="")
    print(
        f"{count[False]} need not, {count[None]} undecided; most nodes {max(r[4] for r in found)}"
    )
    begun, wrong, closed, asked = time.perf_counter(), 0, 0, 0
    for row in found:
        now = time.perf_counter()
        if now - begun > arguments.budget:
            row += ["", ""]
            continue
        asked += 1
        power = most_power(cut_stone(row[0]), arguments.reference)
        row += ["open" if power is None else power < OFF, f"{time.perf_counter() - now:.2f}"]
        closed += power is not None
        if power is not None and row[3] is not None and row[3] != (power < OFF):
            wrong += 1
            print(f"seed {row[0]}: ours {row[3]}, most power {power}")
    told = f"{asked} put to the mixed-integer search, up to {found[asked - 1][2]} contact points: "
    print(f"{told}{closed} closed, {wrong} disagree", flush=True)
    if arguments.csv:
        with arguments.csv.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([COLUMNS, *found])
    return wrong


def gaps(runs: int) -> int:
    """How many that must stand have fallen."""
    scenes = candidates()
    verdicts = [ds.check(scene, strong=True) for scene in scenes]
    pairs = list(zip(scenes, verdicts, strict=True))
    must = [scene for scene, verdict in pairs if verdict.must_stand]
    must = [scene for scene in must if ds.margin(scene).acceleration > MARGIN]
    need = sum(ds.margin(scene).friction > 0.0 for scene in must)
    fallen = simulated(must, runs, "must stand")
    print(f"{runs} runs of {len(must)} structures that must stand ", end="")
    print(f"({need} need friction): {fallen} have fallen")
    hung = [scene for scene, verdict in pairs if verdict.stable and verdict.must_stand is False]
    print(f"{len(hung)} runs of as many that need not: ", end="")
    print(f"{simulated(hung, len(hung))} have fallen")
    return fallen


def simulated(scenes: list[ds.Scene], runs: int, told: str = "") -> int:
    """How many of so many runs have fallen."""
    fallen = 0
    for run in range(runs):
        apart = with_gaps(scenes[run % len(scenes)], np.random.default_rng(run))
        moved = ds.simulate(apart, steps=240)
        way = np.abs(moved.poses[-1] - moved.poses[0])[:, :2].max()
        fallen += bool(way > MOVED)
        if way > MOVED and told:
            print(f"{told}: run {run}, structure {run % len(scenes)} moved {way:.1e} m")
    return fallen


def candidates() -> list[ds.Scene]:
    """Random ones, and some that need friction."""
    tilted = []
    for rows, columns, slope in ((1, 3, 0.15), (2, 2, 0.2), (2, 3, 0.1), (3, 2, 0.1)):
        wall = ds.scenes.wall(rows, columns, friction=0.7)
        tilted.append(wall.with_gravity((9.81 * slope, -9.81)))
    arches = [ds.scenes.arch(n, thickness=0.25, friction=0.7) for n in (5, 9, 15)]
    return tilted + arches + [cut_stone(seed) for seed in range(300)]


if __name__ == "__main__":
    sys.exit(main())
