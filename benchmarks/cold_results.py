"""What cold.py has found: the lines of its file, its tables, and exponents fitted to families."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from rich.console import Console
from rich.table import Table

import results
from cold_peers import PEERS
from plots import exponent

OURS = {
    "drystone": ("equilibrium", True),
    "drystone, pyramids": ("equilibrium", False),
    "drystone, interior": ("interior", True),
}
"""Method of `check`, and whether in space it takes Coulomb's round cones."""

CHECK = "drystone"
PYRAMIDS = "drystone, pyramids"
LARGE = 1000
"""Blocks from which on a structure counts as large."""

COLUMNS = (
    *results.WHERE,
    "family",
    "scene",
    "blocks",
    "points",
    "solver",
    "solver_version",
    "verdict",
    "status",
    "iterations",
    "pivots",
    "seconds",
    "ratio",
    "fastest",
    "contact_seconds",
)
"""Explained in benchmarks/README.md."""


@dataclass(frozen=True, slots=True)
class Answer:
    """What one solver says of a structure."""

    solver: str
    version: str
    verdict: str
    """stands, falls, or empty: no answer."""
    status: str
    """What went wrong, if anything."""
    iterations: int
    pivots: int | None
    seconds: float
    fastest: float
    """The largest acceleration of a centre of mass, m/s^2."""


@dataclass(slots=True)
class Row:
    """One structure, with all answers."""

    family: str
    scene: str
    blocks: int
    points: int
    contact_seconds: float
    load: float
    answers: dict[str, Answer] = field(default_factory=dict)

    @property
    def agree(self) -> bool:
        """No two verdicts differ."""
        return len({a.verdict for a in self.answers.values() if a.verdict}) < 2

    def ratio(self, solver: str) -> float:
        """The time of a solver by ours; NaN if one of them has no answer."""
        one, ours = self.answers.get(solver), self.answers[CHECK]
        if one is None or not (one.verdict and ours.verdict):
            return float("nan")
        return one.seconds / ours.seconds

    def lines(self) -> Iterator[dict[str, object]]:
        """Those of the file."""
        for a in self.answers.values():
            yield results.where(self.load) | {
                "family": self.family,
                "scene": self.scene,
                "blocks": self.blocks,
                "points": self.points,
                "solver": a.solver,
                "solver_version": a.version,
                "verdict": a.verdict,
                "status": a.status,
                "iterations": a.iterations,
                "pivots": "" if a.pivots is None else a.pivots,
                "seconds": results.number(a.seconds, 4),
                "ratio": results.number(self.ratio(a.solver), 4),
                "fastest": results.number(a.fastest, 3),
                "contact_seconds": results.number(self.contact_seconds, 3),
            }


def show(console: Console, rows: list[Row]) -> None:
    """A line for each structure, then the exponents, then what is to be said of all."""
    peers = [peer.name for peer in PEERS if any(peer.name in row.answers for row in rows)]
    table = Table(title="Verdicts from nothing: iterations, ms (times ours)", title_justify="left")
    table.add_column("family", no_wrap=True)
    table.add_column("scene", no_wrap=True)
    for title in ("blocks", "points", "", *OURS, *peers, "m/s^2", f"{peers[0]}'s" if peers else ""):
        table.add_column(title, justify="right")
    for row in rows:
        first = row.answers[CHECK]
        said = (first.verdict or first.status) if row.agree else "[red]differ[/]"
        cells = (_cell(row, solver) for solver in (*OURS, *peers))
        fastest = (_fastest(row, solver) for solver in (PYRAMIDS, *peers[:1]))
        sizes = (str(row.blocks), str(row.points))
        table.add_row(row.family, row.scene, *sizes, said, *cells, *fastest)
    console.print(table)
    _show_exponents(console, rows, peers)
    _show_summary(console, rows)


def _cell(row: Row, solver: str) -> str:
    answer = row.answers.get(solver)
    if answer is None:
        return "-"
    work = str(answer.iterations)
    if answer.pivots and not answer.iterations:
        work = f"{answer.pivots} pivots"
    text = f"{work}, {1e3 * answer.seconds:.3g}"
    if answer.status:
        text += f" {answer.status}"
    ratio = row.ratio(solver)
    return text if solver == CHECK or np.isnan(ratio) else f"{text} ({ratio:.2g})"


def _fastest(row: Row, solver: str) -> str:
    answer = row.answers.get(solver) or row.answers[CHECK]
    return results.number(answer.fastest, 3)


def exponents(rows: list[Row], solvers: list[str]) -> dict[str, dict[str, float]]:
    """Of time in contact points: by family, then by solver, as far as it has two answers."""
    fitted: dict[str, dict[str, float]] = {}
    for family in dict.fromkeys(row.family for row in rows):
        fitted[family] = {}
        for solver in solvers:
            of = [r for r in rows if r.family == family and solver in r.answers]
            points = tuple(float(row.points) for row in of)
            fitted[family][solver] = exponent(points, tuple(r.answers[solver].seconds for r in of))
    return fitted


def _show_exponents(console: Console, rows: list[Row], peers: list[str]) -> None:
    table = Table(title="Exponent of time in contact points", title_justify="left")
    table.add_column("family", no_wrap=True)
    solvers = [*OURS, *peers]
    for solver in solvers:
        table.add_column(solver, justify="right")
    for family, fitted in exponents(rows, solvers).items():
        table.add_row(family, *(results.number(fitted[solver], 3) or "-" for solver in solvers))
    console.print(table)


def _show_summary(console: Console, rows: list[Row]) -> None:
    for row in rows:
        if not row.agree:
            said = ", ".join(f"{a.solver} {a.verdict or a.status}" for a in row.answers.values())
            console.print(f"differ: {row.family}, {row.scene}: {said}", highlight=False)
    for peer in PEERS:
        for title, least in (("", 0), (f" from {LARGE} blocks on", LARGE)):
            ratios = {
                f"{row.family}, {row.scene}": row.ratio(peer.name)
                for row in rows
                if row.blocks >= least and row.ratio(peer.name) > 0
            }
            if ratios:
                worst = min(ratios, key=lambda name: ratios[name])
                console.print(
                    f"{peer.name}{title}: at least {ratios[worst]:.3g} times our time ({worst})",
                    highlight=False,
                )
