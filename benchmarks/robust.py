"""Robust orders beside plain ones, all orders, and the complete structure's own margin.

    .venv/bin/python benchmarks/robust.py [--csv FILE]

Ten random stacks of each size at friction .5. `bound` is the margin of the complete structure, with
which every order begins, so no order has more. `plain` and `robust` are the smallest margins on the
way of the plan that comes first and of `order="robust"`; `all orders` is the largest smallest
margin of any order, up to 10 bodies, found by going through all sub-assemblies.
"""

from __future__ import annotations

import argparse
import csv
import sys
from pathlib import Path

import drystone as ds

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "python"))
from test_plan_margin import best_smallest_margin

SIZES = (8, 10, 20, 40)
STACKS = 10
EXHAUSTIVE = 10
"""Bodies up to which all orders are looked at: a thousand margins."""

SAME = 1e-4
"""How near to the best the search comes, g, or a thousandth of it (`drystone.planning.robust`)."""

COLUMNS = ("bodies", "seed", "bound", "plain", "robust", "all orders", "share of bound")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--csv", type=Path)
    arguments = parser.parse_args()
    rows, wrong = [], 0
    for size in SIZES:
        shares = []
        for seed in range(STACKS):
            scene = ds.scenes.random_stack(size, seed=seed, friction=0.5)
            bound = ds.margin(scene).acceleration
            plain = min(ds.plan(scene).margins)
            robust = min(ds.plan(scene, order="robust").margins)
            best = best_smallest_margin(scene) if size <= EXHAUSTIVE else None
            worse = best is not None and robust < best - max(1e-3 * best, SAME)
            wrong += worse or robust < plain or robust > bound * (1 + 1e-9)
            shares.append(robust / bound)
            known = (bound, plain, robust, best, shares[-1])
            told = ["" if value is None else f"{value:.6f}" for value in known]
            rows.append([size, seed, *told])
            print(*rows[-1], flush=True)
        reached = sum(share >= 0.9 for share in shares)
        print(f"{size} bodies: {reached} of {STACKS} reach 90 % of the bound")
    print(f"{wrong} wrong")
    if arguments.csv:
        with arguments.csv.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([COLUMNS, *rows])
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
