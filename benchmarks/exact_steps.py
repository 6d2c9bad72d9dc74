"""How many steps of many heaps are not exact: within the tolerance of Coulomb's law.

    .venv/bin/python benchmarks/exact_steps.py [--seeds N]

Heaps of 100 and 200 boxes in space (heaps.py) and of 50, 100 and 200 in the plane at friction .3,
.5 and .8 (heaps_in_plane.py), of as many seeds each. Some minutes.
"""

from __future__ import annotations

import threads  # noqa: F401  (before anything that loads NumPy)

# isort: split

import argparse
from collections.abc import Iterable

from rich.console import Console
from rich.table import Table

import drystone as ds
import heaps
import heaps_in_plane

IN_SPACE = (100, 200)
IN_PLANE = (50, 100, 200)


def counted(scenes: Iterable[ds.Scene], steps: int) -> list[str]:
    """Heaps, steps, and those that are not exact."""
    runs = [ds.simulate(scene, heaps.DT, steps) for scene in scenes]
    off = sum(run.not_exact for run in runs)
    return [str(len(runs)), f"{sum(run.steps for run in runs):,}", str(off)]


def main() -> None:
    """Print a line for each size."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--seeds", type=int, default=6)
    seeds = range(parser.parse_args().seeds)
    table = Table("", "heaps", "steps", "not exact")
    for boxes in IN_SPACE:
        many = (heaps.heap(boxes, seed) for seed in seeds)
        table.add_row(f"{boxes} boxes in space", *counted(many, heaps.STEPS))
    for boxes in IN_PLANE:
        many = (
            heaps_in_plane.heap(boxes, friction, seed)
            for friction in heaps_in_plane.FRICTION
            for seed in seeds
        )
        table.add_row(f"{boxes} boxes in the plane", *counted(many, heaps_in_plane.STEPS))
    Console(width=100).print(table)


if __name__ == "__main__":
    main()
