"""How much work known problems take: pivots, tests and solves, whatever the machine's speed.

    python benchmarks/work.py           print them beside those that are kept
    python benchmarks/work.py --check   end with status 1 where there is more work than is kept
    python benchmarks/work.py --keep    write results/work.csv anew

Another processor may round otherwise, and then take a pivot more or less. So up to `LEEWAY` more is
no step back; more is, and so is an answer of another kind.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Callable
from pathlib import Path

import drystone as ds
from results import write_lines

KEPT = Path(__file__).parent / "results" / "work.csv"
LEEWAY = 0.02
"""Share of a count."""
FEW = 2
"""And so many in any case."""

Counts = dict[str, int | str]


def main() -> int:
    parser = argparse.ArgumentParser(description="Counts of work on known problems.")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--keep", action="store_true")
    given = parser.parse_args()
    now = measured()
    if given.keep:
        lines = ({"case": c, "count": k, "value": v} for (c, k), v in now.items())
        write_lines(KEPT, ("case", "count", "value"), lines)
    kept = read(KEPT)
    worse = [key for key, value in now.items() if is_worse(value, kept.get(key))]
    missing = kept.keys() - now.keys()
    print(table(now, kept, set(worse)))
    for case, count in sorted(missing):
        print(f"\n{case}, {count}: kept, and not measured any more")
    return 1 if given.check and (worse or missing) else 0


def measured() -> dict[tuple[str, str], str]:
    """All counts, by case and kind."""
    return {
        (case, count): str(value)
        for case, measure in CASES.items()
        for count, value in measure().items()
    }


def plan(scene: ds.Scene, test: str = "reuse", **options: int) -> Callable[[], Counts]:
    def counts() -> Counts:
        found = ds.plan(scene, test=test, threads=1, **options)
        return {"status": found.status, "tests": found.tests, "pivots": found.pivots}

    return counts


def check(scene: ds.Scene, **options: str) -> Callable[[], Counts]:
    def counts() -> Counts:
        verdict = ds.check(scene, **options)
        return {
            "stable": str(verdict.stable),
            "pivots": verdict.pivots,
            "iterations": verdict.iterations,
        }

    return counts


def simulate(scene: ds.Scene, steps: int) -> Callable[[], Counts]:
    def counts() -> Counts:
        run = ds.simulate(scene, steps=steps)
        return {
            "status": run.ending,
            "pivots": int(run.pivots.sum()),
            "solves": int(run.solves.sum()),
        }

    return counts


def limit(scene: ds.Scene, block: str, push: tuple[float, ...]) -> Callable[[], Counts]:
    def counts() -> Counts:
        found = ds.limit(scene, push={block: push})
        return {"status": found.status, "factor": f"{found.factor:.6g}"}

    return counts


scenes = ds.scenes
CASES: dict[str, Callable[[], Counts]] = {
    "plan column:80": plan(scenes.column(80)),
    "plan column:80, reuse-dantzig": plan(scenes.column(80), "reuse-dantzig"),
    "plan column:80, lcp": plan(scenes.column(80), "lcp"),
    "plan pyramid:13": plan(scenes.pyramid(13)),
    "plan pyramid:13, reuse-dantzig": plan(scenes.pyramid(13), "reuse-dantzig"),
    "plan random_stack:84": plan(scenes.random_stack(84)),
    "plan random_stack:84, reuse-dantzig": plan(scenes.random_stack(84), "reuse-dantzig"),
    "plan random_stack:84, lcp": plan(scenes.random_stack(84), "lcp"),
    "plan random_stack:300": plan(scenes.random_stack(300)),
    "plan wall:30": plan(scenes.wall(30)),
    "plan arch:9, one hand": plan(scenes.arch(9, thickness=0.3), hold=1),
    "plan brick_wall:6,8": plan(scenes.brick_wall(6, 8)),
    "check arch:100": check(scenes.arch(100)),
    "check arch:thickness=0.1": check(scenes.arch(thickness=0.1)),
    "check random_stack:300": check(scenes.random_stack(300)),
    "check brick_wall:10,12": check(scenes.brick_wall(10, 12)),
    "check brick_wall:10,12, interior": check(scenes.brick_wall(10, 12), method="interior"),
    "check square_pyramid:6": check(scenes.square_pyramid(6)),
    "limit column:10": limit(scenes.column(10, friction=0.5), "9", (1.0, 0.0)),
    "simulate falling_column": simulate(scenes.falling_column(), 240),
    "simulate three_segments": simulate(scenes.three_segments(), 240),
    "simulate col20": simulate(scenes.col20(), 60),
    "simulate drop84": simulate(scenes.drop84(), 60),
}


def read(path: Path) -> dict[tuple[str, str], str]:
    """What is kept."""
    with path.open(newline="") as file:
        return {(line["case"], line["count"]): line["value"] for line in csv.DictReader(file)}


def is_worse(now: str, kept: str | None) -> bool:
    """More work than is kept, another answer, or nothing to compare with."""
    if kept is None or not (now.isdecimal() and kept.isdecimal()):
        return now != kept
    return int(now) > max(int(kept) * (1 + LEEWAY), int(kept) + FEW)


def table(
    now: dict[tuple[str, str], str], kept: dict[tuple[str, str], str], worse: set[tuple[str, str]]
) -> str:
    """As Markdown; what is worse is marked."""
    lines = ["| case | count | kept | now |", "|---|---|---:|---:|"]
    for key, value in now.items():
        mark = " **more**" if key in worse else ""
        lines.append(f"| {key[0]} | {key[1]} | {kept.get(key, '')} | {value}{mark} |")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
