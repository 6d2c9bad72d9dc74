"""Random linear complementarity problems of forty families: how many answers are wrong or missing.

    .venv/bin/python benchmarks/random_lcps.py [--quick] [--count N] [--families NAME ...]

Every problem is put to every method that takes it, from scratch and from the solution of a random
sub-problem; in the families of walks rows come and go in one `lcp.Solver`. Answers are judged from
M and q alone (`lcp_reference.py`). The exit status is 1 if an answer is wrong.
"""

from __future__ import annotations

import threads  # noqa: F401  (before anything that loads NumPy)

# isort: split

import argparse
import collections
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

import results
from drystone import lcp
from lcp_families import FAMILIES, Array, Family, Problem, Random
from lcp_reference import Judgement, judge, reference

PROBLEMS = 100_000
QUICK = 4_100
METHODS = ("dantzig", "block", "lemke")
SOLVES_IN_A_WALK = 8
SHOWN = 5
"""Of a family so many wrong and missing answers are listed."""

SHARE_OF_START = 0.6
"""Rows of the sub-problem whose solution is a start, of all rows."""

WALKS = (
    "condition 1e10",
    "near opposite columns",
    "near columns, any q",
    "dependent, any q",
    "dependent, infeasible",
    "contact, masses 1e6",
    "12 decimals",
    "10 decimals",
    "8 decimals",
    "ties, any q",
)
"""Families that an `lcp.Solver` walks through too."""


COLUMNS = (
    *results.WHERE,
    "family",
    "problems",
    "answers",
    "solved",
    "no_solution",
    "refused",
    "unanswered",
    "wrong",
    "seconds",
)
"""Explained in benchmarks/README.md."""

Said = lcp.Solution | lcp.LcpError


@dataclass
class Tally:
    """What came of one family."""

    family: str
    problems: int = 0
    said: collections.Counter[str] = field(default_factory=collections.Counter)
    judged: collections.Counter[Judgement] = field(default_factory=collections.Counter)
    remarks: dict[Judgement, list[str]] = field(default_factory=dict)
    seconds: float = 0.0
    """Of the solves alone."""

    @property
    def answers(self) -> int:
        """How often a solver was asked."""
        return self.judged.total()

    def ask(self, problem: Problem, label: str, solve: Callable[[], lcp.Solution]) -> Said:
        """Put one problem to a solver and judge what it says."""
        begun = time.perf_counter()
        try:
            said: Said = solve()
        except lcp.LcpError as error:
            said = error
        self.seconds += time.perf_counter() - begun
        if isinstance(said, lcp.StartError):
            return said
        verdict = judge(problem, said)
        self.said["refused" if isinstance(said, lcp.LcpError) else said.status] += 1
        self.judged[verdict.judgement] += 1
        if verdict.reason:
            self.remarks.setdefault(verdict.judgement, []).append(f"{label}: {verdict.reason}")
        return said

    def line(self) -> dict[str, object]:
        """The line of the file."""
        return results.where(results.load()) | {
            "family": self.family,
            "problems": self.problems,
            "answers": self.answers,
            "solved": self.said["solved"],
            "no_solution": self.said["no_solution"],
            "refused": self.said["refused"],
            "unanswered": self.judged[Judgement.UNANSWERED],
            "wrong": self.judged[Judgement.WRONG],
            "seconds": results.number(self.seconds, 3),
        }


def single_problems(family: Family, seeds: range) -> Tally:
    """Put problems of a family to all methods, from scratch and from a start."""
    tally = Tally(family.name, len(seeds))
    for seed in seeds:
        rng = _random(family, seed)
        problem = family.make(rng)
        if problem.expected is None and problem.clear:
            problem = replace(problem, expected=reference(problem))
        part = np.flatnonzero(rng.random(len(problem.q)) < SHARE_OF_START)
        for method in METHODS if problem.semidefinite else METHODS[-1:]:
            tally.ask(
                problem, f"{seed}, {method}", partial(lcp.solve, problem.M, problem.q, None, method)
            )
            start = _start(problem, part, method)
            if start is not None:
                label = f"{seed}, {method} from a start"
                tally.ask(problem, label, partial(lcp.solve, problem.M, problem.q, start, method))
    return tally


def _start(problem: Problem, part: NDArray[np.int64], method: str) -> lcp.Start | None:
    """A solution of a sub-problem, if it has one."""
    try:
        known = lcp.solve(problem.M[np.ix_(part, part)], problem.q[part], method=method)
    except lcp.LcpError:
        return None
    return known.start(part) if known.status == "solved" else None


def walks(family: Family, seeds: range) -> Tally:
    """Let rows come and go, and q change, in one solver for each problem of a family."""
    tally = Tally(f"walk: {family.name}", SOLVES_IN_A_WALK * len(seeds))
    for seed in seeds:
        rng = _random(family, seed)
        problem = family.make(rng)
        try:
            solver = lcp.Solver(problem.M, problem.q)
        except lcp.LcpError as error:
            _judge_refusal(tally, problem, seed, error)
            continue
        n, q = len(problem.q), problem.q
        for step in range(SOLVES_IN_A_WALK):
            if problem.another_q and rng.random() < 0.3:
                q = problem.another_q(rng)
                solver.set_q(q)
            solver.remove_rows(np.flatnonzero(rng.random(n) < 0.3))
            solver.add_rows(np.flatnonzero(rng.random(n) < 0.5))
            rows = solver.rows
            part = _part(problem, q, rows)
            tally.ask(part, f"{seed}, step {step}", lambda s=solver: s.solve().restricted())
    return tally


def _part(problem: Problem, q: Array, rows: NDArray[np.int64]) -> Problem:
    """The sub-problem of some rows, with its answer."""
    part = replace(problem, M=problem.M[np.ix_(rows, rows)], q=q[rows])
    if problem.another_q:
        return part
    return replace(part, expected=reference(part) if part.clear and len(rows) else None)


def _judge_refusal(tally: Tally, problem: Problem, seed: int, error: lcp.LcpError) -> None:
    def refuse() -> lcp.Solution:
        raise error

    tally.ask(problem, f"{seed}", refuse)


def _random(family: Family, seed: int) -> Random:
    return np.random.default_rng([FAMILIES.index(family), seed])


def measure(total: int, names: list[str]) -> Iterator[Tally]:
    """Everything, family by family, a few thousand problems each."""
    each = -(-total // (len(FAMILIES) + len(WALKS)))
    for family in FAMILIES:
        if not names or family.name in names:
            yield single_problems(family, range(each))
        if family.name in WALKS and (not names or family.name in names):
            yield walks(family, range(-(-each // SOLVES_IN_A_WALK)))


def show(console: Console, tallies: list[Tally]) -> None:
    """A row for each family, and what went wrong."""
    table = Table(title="Random linear complementarity problems", title_justify="left")
    table.add_column("family", no_wrap=True)
    for title in (
        "problems",
        "answers",
        "solved",
        "no solution",
        "refused",
        "unanswered",
        "wrong",
        "ms each",
    ):
        table.add_column(title, justify="right")
    for t in tallies:
        counts = (t.problems, t.answers, *(t.said[s] for s in ("solved", "no_solution", "refused")))
        bad = (t.judged[Judgement.UNANSWERED], t.judged[Judgement.WRONG])
        cells = [*map(str, counts), *(f"[red]{count}[/]" if count else "0" for count in bad)]
        table.add_row(t.family, *cells, f"{1e3 * t.seconds / max(t.answers, 1):.2f}")
    console.print(table)
    for t in tallies:
        for judgement, remarks in t.remarks.items():
            for remark in remarks[:SHOWN]:
                console.print(f"{judgement.value}: {t.family}, problem {remark}", highlight=False)
    wrong, missing = (
        sum(t.judged[j] for t in tallies) for j in (Judgement.WRONG, Judgement.UNANSWERED)
    )
    problems, answers = sum(t.problems for t in tallies), sum(t.answers for t in tallies)
    console.print(f"{problems} problems, {answers} answers: {wrong} wrong, {missing} missing")


def main() -> int:
    """Measure what the arguments say; 1 if an answer is wrong."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help=f"{QUICK} problems")
    parser.add_argument("--count", type=int, default=PROBLEMS, help=f"default: {PROBLEMS}")
    parser.add_argument("--families", nargs="+", default=[], metavar="NAME")
    results.add_output(parser)
    arguments = parser.parse_args()
    unknown = set(arguments.families) - {family.name for family in FAMILIES}
    if unknown:
        parser.error(f"no family is called {min(unknown)!r}")
    tallies = []
    for tally in measure(QUICK if arguments.quick else arguments.count, arguments.families):
        tallies.append(tally)
        print(f"{tally.family}: {tally.judged[Judgement.WRONG]} wrong", file=sys.stderr)
    show(Console(width=140), tallies)
    if not arguments.families:
        path = results.path_in(arguments.output)
        path = path.with_name(path.name + "-random-lcps.csv")
        results.write_lines(path, COLUMNS, (tally.line() for tally in tallies))
    return int(any(tally.judged[Judgement.WRONG] for tally in tallies))


if __name__ == "__main__":
    sys.exit(main())
