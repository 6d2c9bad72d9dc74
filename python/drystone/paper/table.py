"""Table I: total number of pivots by algorithm, for frictionless examples."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from drystone import scenes
from drystone.paper.plain import plain_table
from drystone.planning.answer import Plan
from drystone.planning.search import StabilityTest, plan

if TYPE_CHECKING:
    from rich.table import Table
    from rich.text import Text

    from drystone.scene import Scene

COLUMNS: tuple[StabilityTest, ...] = ("lp", "lp-warm", "lcp", "reuse-dantzig", "reuse")
"""Stability tests. The paper has lp, lcp and reuse-dantzig, which it calls LCP + Reuse."""


@dataclass(frozen=True, slots=True)
class Example:
    """A row of the paper's table."""

    name: str
    build: Callable[[], Scene]
    printed: Mapping[str, int]
    """The paper's pivots; its lp is lp_solve's revised simplex method."""


EXAMPLES = (
    Example(
        "Random 10", lambda: scenes.random_stack(10), {"lp": 102, "lcp": 127, "reuse-dantzig": 13}
    ),
    Example("Column 50", lambda: scenes.column(50), {"lp": 2352, "lcp": 2352, "reuse-dantzig": 96}),
    Example(
        "Column 80", lambda: scenes.column(80), {"lp": 6162, "lcp": 6162, "reuse-dantzig": 156}
    ),
    Example(
        "Random 84",
        lambda: scenes.random_stack(84),
        {"lp": 11975, "lcp": 15136, "reuse-dantzig": 420},
    ),
    Example(
        "Pyramid 91", lambda: scenes.pyramid(13), {"lp": 8190, "lcp": 8190, "reuse-dantzig": 180}
    ),
)
"""The paper's random structures are not published: ours are others of the same kind and size."""

IN_SPACE = (
    Example("Column 50 cubes", lambda: scenes.column(50).extruded(), {}),
    Example("Pyramid 91 cubes", lambda: scenes.pyramid(13).extruded(), {}),
    Example("Square pyramid 140", scenes.square_pyramid, {}),
)
"""Structures that the paper claims its method for and does not show."""


@dataclass(frozen=True, slots=True, eq=False)
class Row:
    """One example planned with every stability test."""

    example: Example
    plans: Mapping[str, Plan]

    @property
    def found(self) -> bool:
        """Whether every test led to an order."""
        return all(plan.found for plan in self.plans.values())


def measure(
    announce: Callable[[str], None] = lambda what: None,
    examples: Iterable[Example] = (*EXAMPLES, *IN_SPACE),
) -> list[Row]:
    """Plan every example with every test; `announce` is told what comes next."""
    rows = []
    for example in examples:
        scene = example.build()
        plans: dict[str, Plan] = {}
        for test in COLUMNS:
            announce(f"{example.name} ({test})")
            plans[test] = plan(scene, test, shortcuts=False, threads=1)
            if plans[test].status == "interrupted":  # its pivots are not those of the whole search
                raise KeyboardInterrupt
        rows.append(Row(example, plans))
    return rows


def as_tables(rows: list[Row]) -> list[Table]:
    """Pivots beside the paper's, and how much fewer reuse takes; then the times; then in space."""
    plane = [row for row in rows if row.example not in IN_SPACE]
    space = [row for row in rows if row.example in IN_SPACE]
    title = "Total number of pivots, frictionless examples (the paper's in brackets)"
    planar = _tables(plane, title)
    planar[
        0
    ].caption = "random examples: other structures than the paper's, which are not published"
    return [*planar, *_tables(space, "Total number of pivots in space, frictionless")]


def _tables(rows: list[Row], title: str) -> list[Table]:
    if not rows:
        return []
    pivots = _table(title)
    times = _table("Time of all these tests in milliseconds, on this machine")
    for row in rows:
        tests = str(row.plans["reuse"].tests)
        pivots.add_row(
            row.example.name,
            tests,
            *(_beside(row.plans[test].pivots, row.example.printed.get(test)) for test in COLUMNS),
            f"{_ratio(row, lambda plan: plan.pivots):.1f}",
        )
        times.add_row(
            row.example.name,
            tests,
            *(f"{1e3 * row.plans[test].test_seconds:.3g}" for test in COLUMNS),
            f"{_ratio(row, lambda plan: plan.test_seconds):.1f}",
        )
    return [pivots, times]


def _table(title: str) -> Table:
    table = plain_table(title)
    table.add_column("structure", no_wrap=True)
    for heading in ("tests", *COLUMNS, "lcp / reuse"):
        # A heading of two words goes on two lines.
        broken = heading.replace("-", "-\n").replace(" / ", " /\n")
        table.add_column(broken, justify="right", no_wrap=True)
    return table


def write_csv(rows: list[Row], folder: Path) -> Path:
    """One line an example and test."""
    path = folder / "table1.csv"
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(
            ["structure", "test", "found", "tests", "pivots", "pivots_paper", "test_seconds"]
        )
        for row in rows:
            for test, found in row.plans.items():
                writer.writerow(
                    [
                        row.example.name,
                        test,
                        found.found,
                        found.tests,
                        found.pivots,
                        row.example.printed.get(test, ""),
                        f"{found.test_seconds:.6f}",
                    ]
                )
    return path


def _beside(ours: int, printed: int | None) -> Text:
    from rich.text import Text

    told = Text(str(ours))
    return told if printed is None else told.append(f" ({printed})", style="dim")


def _ratio(row: Row, work: Callable[[Plan], float]) -> float:
    return work(row.plans["lcp"]) / max(work(row.plans["reuse"]), 1e-9)
