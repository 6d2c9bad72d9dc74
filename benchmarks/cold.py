"""Verdicts from nothing beside public interior-point methods, in one process on one thread.

    .venv/bin/pip install piqp==0.7.0 clarabel==0.11.1      # as far as wanted
    .venv/bin/python benchmarks/cold.py [--quick] [--scenes FAMILY ...] [--cap SECONDS]

Does a structure stand, and if not, how does it begin to fall? Asked once, with nothing known from
before. The structures are in cold_scenes.py, what the others solve is in cold_peers.py: the same
problem on the same contact points, to 1e-9.

Timed: everything from the contact points on. For drystone that is `Verdict.seconds` of the core's
`check`, by its own clock, less the time in which it finds the contacts and makes the generators of
their forces; that is measured apart, by a `Structure` of the same scene, whose `set_up_seconds` say
what is not that. For the others it is set-up and solution, by a clock around the calls, on matrices
that are made before. The least of three rounds in which all take turns, or more; one of what takes
more than a second. A peer leaves out the sizes of a family after one that took more than `--cap`.

"drystone" is `check` as it is; "drystone, pyramids" has, in space, the eight edges that PIQP has in
place of Coulomb's cones; "drystone, interior" makes no pivots, as method "interior" says. The exit
status is 1 if two verdicts differ.
"""

from __future__ import annotations

import threads  # noqa: F401  (before anything that loads NumPy)

# isort: split

import argparse
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import TypeVar

import numpy as np
from rich.console import Console

import drystone as ds
import results
from cold_peers import PEERS, Gauss, Peer
from cold_results import COLUMNS, OURS, PYRAMIDS, Answer, Row, show
from cold_scenes import FAMILIES, Build, Family
from drystone import _core
from drystone.common.cones import FACETS

T = TypeVar("T")

REPEATS = 3
SHORT = 0.1
"""Seconds: what is shorter is repeated more often, until the repetitions take so long together."""

MOST_REPEATS = 100
"""Also of a tiny scene, whose time may be lost in that of its contacts."""

CAP = 10.0
"""Seconds."""


def in_turns(asked: dict[str, Callable[[], T]], seconds: Callable[[T], float]) -> dict[str, T]:
    """The quickest answer of each in a few rounds, in which everybody takes a turn."""
    best: dict[str, T] = {}
    spent = dict.fromkeys(asked, 0.0)
    left, rounds = list(asked), 0
    while left:
        rounds += 1
        for name in left:
            answer = asked[name]()
            spent[name] += seconds(answer)
            best[name] = min(best.get(name, answer), answer, key=seconds)
        left = [name for name in left if _again(seconds(best[name]), spent[name], rounds)]
    return best


def _again(best: float, spent: float, rounds: int) -> bool:
    if best >= 1 or rounds >= MOST_REPEATS:
        return False
    return rounds < REPEATS or spent < SHORT


def contact_seconds(scene: ds.Scene) -> float:
    """Finding contact points and making the generators, as `check` does before it begins."""

    def once() -> float:
        begun = time.perf_counter()
        structure = _core.Structure(scene._core)
        return time.perf_counter() - begun - structure.set_up_seconds

    return in_turns({"contacts": once}, float)["contacts"]


def ours(solver: str, scene: ds.Scene, contacts: float) -> Answer:
    """The verdict of `check`, by the method and with the cones of `OURS`."""
    method, round_cones = OURS[solver]
    cones = (FACETS, "inscribed")
    said = _core.check(scene._core, None, method, cones, round_cones)
    linear = said.accelerations[:, : scene.dimension]
    fastest = float(np.linalg.norm(linear, axis=1).max())
    solved = said.status == "solved"
    return Answer(
        solver,
        ds.__version__,
        ("stands" if said.stable else "falls") if solved else "",
        "" if solved else said.status,
        said.iterations,
        said.pivots,
        said.seconds - contacts,
        fastest,
    )


def theirs(peer: Peer, scene: ds.Scene, gauss: Gauss) -> Answer:
    """The verdict of a public solver."""
    found = peer.solve(gauss)
    verdict, fastest = "", float("nan")
    if found.u is not None:
        verdict = "stands" if gauss.stands(found.u) else "falls"
        fastest = gauss.fastest(found.u, scene.dimension)
    return Answer(
        peer.name,
        peer.version() or "",
        verdict,
        found.status,
        found.iterations,
        None,
        found.seconds,
        fastest,
    )


def measure(family: Family, name: str, build: Build, peers: list[Peer]) -> Row:
    """One structure, by all who take it."""
    scene = build()
    space = scene.dimension == 3
    gauss = Gauss.of(scene)
    edges = FACETS if space else 2
    contacts = contact_seconds(scene)
    blocks = sum(not body.fixed for body in scene.bodies)
    points = gauss.pyramids.shape[0] // edges
    asked: dict[str, Callable[[], Answer]] = {}
    for solver in OURS:
        if space or solver != PYRAMIDS:
            asked[solver] = partial(ours, solver, scene, contacts)
    for peer in peers:
        if space or not peer.round:
            asked[peer.name] = partial(theirs, peer, scene, gauss)
    answers = in_turns(asked, lambda answer: answer.seconds)
    return Row(family.name, name, blocks, points, contacts, results.load(), answers)


def run(families: list[Family], quick: bool, cap: float, peers: list[Peer]) -> Iterator[Row]:
    """All structures, the smallest of a family first."""
    for family in families:
        left = list(peers)
        sizes = list(family.sizes.items())
        for name, build in sizes[: family.quick] if quick else sizes:
            row = measure(family, name, build, left)
            yield row
            taken = {answer.solver: answer.seconds for answer in row.answers.values()}
            left = [peer for peer in left if taken.get(peer.name, 0.0) <= cap]


def main() -> int:
    """Measure what the arguments say; 1 if two verdicts differ."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="the smallest of each family")
    parser.add_argument(
        "--scenes", nargs="+", default=[], metavar="FAMILY", help="families, by their names"
    )
    parser.add_argument(
        "--cap", type=float, default=CAP, metavar="SECONDS", help=f"default: {CAP:g}"
    )
    results.add_output(parser)
    arguments = parser.parse_args()
    names = [family.name for family in FAMILIES]
    unknown = set(arguments.scenes) - set(names)
    if unknown:
        parser.error(f"no family is called {min(unknown)!r}: choose from {', '.join(names)}")
    peers = [peer for peer in PEERS if peer.version() is not None]
    for package in sorted({peer.package for peer in PEERS} - {peer.package for peer in peers}):
        print(f"without {package}: pip install {package}", file=sys.stderr)
    families = [f for f in FAMILIES if not arguments.scenes or f.name in arguments.scenes]
    rows = []
    for row in run(families, arguments.quick, arguments.cap, peers):
        rows.append(row)
        times = ", ".join(f"{a.solver} {a.seconds:.3g} s" for a in row.answers.values())
        print(f"{row.family}, {row.scene}: {times}", file=sys.stderr, flush=True)
    show(Console(width=200), rows)
    path = results.path_in(arguments.output)
    path = path.with_name(path.name + "-cold.csv")
    results.write_lines(path, COLUMNS, (line for row in rows for line in row.lines()))
    return int(not all(row.agree for row in rows))


if __name__ == "__main__":
    sys.exit(main())
