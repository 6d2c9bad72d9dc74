"""Walls that lean: one block less and one more, and verdicts ever nearer to the limit.

    .venv/bin/python benchmarks/hard_walls.py [--rows N ...] [-o DIR]

Walls of as many rows as columns under gravity with a share k of g sideways, friction .5. The first
table asks a `Structure` for its first answer, then without the block that came last, then with it
again, beside a `check` from nothing. The second asks `check` at a share below and above the limit
that `drystone.limit` gives: what it says, and how long it takes. Seconds by a clock around the
calls.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path

from rich.console import Console
from rich.table import Table

import drystone as ds
import results

G = 9.81
ROWS = (20, 40, 60, 80)
SHARES = (0.1, 0.2, 0.34)
"""Of g, sideways: below the limit of every size."""
NEAR = (-1e-2, -1e-4, -1e-6, 1e-6, 1e-4, 1e-2)
"""Distances from the limit, as shares of it."""

COLUMNS = (
    *results.WHERE,
    *("table", "rows", "blocks", "k", "check_s", "first_s", "less_s", "more_s"),
    *("share", "verdict", "iterations"),
)


def leaning(rows: int, k: float) -> ds.Scene:
    wall = json.loads(ds.scenes.wall(rows, columns=rows, friction=0.5).to_json())
    wall["gravity"] = [k * G, -G]
    return ds.Scene.from_json(json.dumps(wall))


def seconds(call: Callable[[], object]) -> float:
    start = time.perf_counter()
    call()
    return time.perf_counter() - start


def change(rows: int, k: float) -> dict[str, object]:
    scene = leaning(rows, k)
    names = [body.name for body in scene.bodies if not body.fixed]
    nothing = seconds(lambda: ds.check(scene, forces="any"))
    structure = ds.Structure(scene, blocks=names)
    first = seconds(structure.stands)
    structure.remove(names[-1])
    less = seconds(structure.stands)
    structure.add(names[-1])
    more = seconds(structure.stands)
    return {
        "table": "changes",
        "rows": rows,
        "blocks": len(names),
        "k": k,
        "check_s": nothing,
        "first_s": first,
        "less_s": less,
        "more_s": more,
    }


def near(rows: int, limit: float, share: float) -> dict[str, object]:
    scene = leaning(rows, limit * (1 + share))
    start = time.perf_counter()
    verdict = ds.check(scene, forces="any")
    said = "stands" if verdict.stable else "falls"
    return {
        "table": "near the limit",
        "rows": rows,
        "blocks": sum(not body.fixed for body in scene.bodies),
        "k": limit,
        "share": share,
        "verdict": said if verdict.status == "solved" else verdict.status,
        "iterations": verdict.iterations,
        "check_s": time.perf_counter() - start,
    }


def show(title: str, rows: list[dict[str, object]]) -> None:
    columns = list(rows[0])[1:]
    table = Table(*columns, title=title)
    for row in rows:
        said = (row[name] for name in columns)
        table.add_row(*(f"{x:.4g}" if isinstance(x, float) else str(x) for x in said))
    Console().print(table)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rows", type=int, nargs="+", default=ROWS, metavar="N")
    results.add_output(parser)
    options = parser.parse_args()
    changes = [change(rows, k) for rows in options.rows for k in SHARES]
    show("a block less, a block more", changes)
    verdicts = []
    for rows in options.rows:
        below = 0.3
        scene = leaning(rows, below)
        limit = below + ds.limit(scene, gravity=[G, 0.0]).upper.factor
        verdicts += [near(rows, limit, share) for share in NEAR]
    show("near the limit", verdicts)
    path = Path(f"{results.path_in(options.output)}-hard-walls.csv")
    where = results.where(results.load())
    results.write_lines(path, COLUMNS, (where | line for line in changes + verdicts))
    Console().print(f"wrote {path}")


if __name__ == "__main__":
    main()
