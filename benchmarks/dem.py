"""The reference structures of compas_dem, beside its own back end RBE: resultants and times.

    .venv/bin/pip install compas_dem==0.6.0 compas_cra==0.8.0
    .venv/bin/python benchmarks/dem.py [--csv FILE]

The four models of `scripts/DEM_Analysis_References` in its repository, under their own weight with
friction .5: two blocks, three blocks, an arch of 30 voussoirs, a barrel vault. drystone reads the
same `BlockModel` (`drystone.imports.load`) and finds contacts by itself; a resultant is the sum of
the forces between two blocks.

Forces are unique only where the structure is statically determinate. A component of a resultant
counts as unique if the least and the greatest that the friction cones allow (pyramids around them,
by HiGHS) are within 1e-6 of the weight; these must be equal on both sides, to what RBE's solver
leaves open. Of structures of more than 300 contacts, whose programs take minutes, none is looked
at.

Times are of the processor, the least of a few: RBE's `Problem.solve` with its interfaces known,
ours reading the model, `check` with contacts found, and again with the forces of least norm, which
RBE's are too, in another norm, as arrays. The last two columns are `Problem.solve` with drystone as
its solver, model in and `Results` out, and how many times as long `compute_contacts` and
`Problem.solve` with RBE take, which is as much.
"""

from __future__ import annotations

import threads  # noqa: F401  (before anything that loads NumPy)

# isort: split

import argparse
import contextlib
import csv
import io
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import highspy
import numpy as np
from compas_dem.models import BlockModel
from compas_dem.problem import Solver
from scipy.sparse import csc_matrix

import drystone as ds
from drystone import _core, imports
from drystone.statics import QuietHighs

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "python"))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "compas_drystone" / "tests"))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "compas_drystone" / "src"))
from reference_models import FRICTION, arch, barrel_vault, problem_of, three_blocks, two_blocks

from compas_drystone import Drystone
from limit_programs import balance

UNIQUE = 1e-6
"""Range of a component, of the weight of all."""

SAME = 1e-5
"""How far resultants may be apart, of the weight of all: RBE's solver stops there."""

MOST = 300
"""Contacts of a structure whose resultants are looked at."""

REPEATS = 5

COLUMNS = (
    *("structure", "blocks", "contacts", "resultants", "unique components", "apart"),
    *("RBE, s", "read, s", "check, s", "with forces, s", "RBE / check", "RBE / with forces"),
    *("Drystone().solve, s", "all by RBE / Drystone()"),
)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--csv", type=Path)
    arguments = parser.parse_args()
    rows, wrong = [], 0
    for build in (two_blocks, three_blocks, arch, barrel_vault):
        row, apart = compared(build)
        wrong += apart > SAME
        rows.append(row)
        print(dict(zip(COLUMNS, row, strict=True)), flush=True)
    if arguments.csv:
        with arguments.csv.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([COLUMNS, *rows])
    return 1 if wrong else 0


def compared(build: Callable[[], BlockModel]) -> tuple[list[Any], float]:
    """A row, and how far unique components are apart."""
    model = build()
    _, finding = least(model.compute_contacts, 1)
    problem = problem_of(model)
    problem.set_solver(Solver.RBE())
    with contextlib.redirect_stdout(io.StringIO()):
        results, rbe = least(lambda: problem.solve(verbose=False))
    scene, reading = least(lambda: imports.load(model, friction=FRICTION).scene)
    contacts = len(scene.contacts)
    verdict, alone = least(lambda: ds.check(scene))
    assert verdict.stable
    (bodies, vectors), with_forces = least(lambda: arrays(ds.check(scene).forces))
    names = [int(name) for name in scene.names]
    ours: dict[tuple[int, int], Any] = {}
    for (a, b), vector in zip(bodies, vectors, strict=True):
        pair = names[a], names[b]
        ours[pair] = ours.get(pair, 0.0) + vector
    problem.set_solver(Drystone())
    _, within = least(problem.solve)
    weight = sum(9.81 * body.mass for body in scene.bodies if not body.fixed)
    pairs = [pair for pair in ours if pair in set(results.edges()) and contacts <= MOST]
    unique, apart = 0, 0.0
    for pair, spread in zip(pairs, ranges(scene, pairs), strict=True):
        for axis in np.flatnonzero(spread <= UNIQUE * weight):
            unique += 1
            theirs = results.resultant_global(pair)[axis]
            apart = max(apart, abs(theirs - ours[pair][axis]) / weight)
    blocks = len(list(model.elements()))
    times = [f"{value:.2g}" for value in (rbe, reading, alone, with_forces)]
    ratios = [f"{rbe / value:.0f}" for value in (alone, with_forces)]
    told = [build.__name__, blocks, contacts, len(pairs), unique, f"{apart:.1e}"]
    whole = [f"{within:.2g}", f"{(finding + rbe) / within:.0f}"]
    return [*told, *times, *ratios, *whole], apart


def arrays(forces: ds.ContactForces) -> tuple[Any, Any]:
    """Which bodies, as numbers, and the forces."""
    return forces.bodies, forces.vectors


def least(ask: Callable[[], Any], repeats: int = REPEATS) -> tuple[Any, float]:
    """An answer, and the least processor time."""
    answer, best = None, float("inf")
    for _ in range(repeats):
        begun = time.process_time()
        answer = ask()
        best = min(best, time.process_time() - begun)
    return answer, best


def ranges(scene: ds.Scene, pairs: list[tuple[int, int]]) -> list[np.ndarray]:
    """Of each resultant the range of its components, N, over all forces that hold the structure."""
    g = _core.generators(scene._core, (8, "circumscribed"))
    unit = np.abs(g.applied).max()
    columns = len(g.indptr) - 1
    rows = len(g.applied)
    highs = balance(g, -g.applied / unit)
    matrix = csc_matrix((g.data, g.indices, g.indptr), shape=(rows, columns))
    place = {int(name): 6 * index for index, name in enumerate(g.names)}
    contacts = [(int(contact.a), int(contact.b)) for contact in scene.contacts]
    of = np.array([contacts[contact] for contact in g.contact])
    found = []
    for a, b in pairs:
        mine = np.flatnonzero((of == (a, b)).all(axis=1))
        sign, first = (1.0, place[b]) if b in place else (-1.0, place[a])
        ends = []
        for axis in range(3):
            cost = np.zeros(columns)
            cost[mine] = sign * matrix[first + axis, mine].toarray().ravel()
            ends.append([_least(highs, way * cost) for way in (1.0, -1.0)])
        found.append(-unit * np.sum(ends, axis=1))
    return found


def _least(highs: QuietHighs, cost: np.ndarray) -> float:
    """The least cost of forces that hold the structure; minus infinity without one."""
    highs.changeColsCost(len(cost), np.arange(len(cost), dtype=np.int32), cost)
    highs.run()
    if highs.getModelStatus() != highspy.HighsModelStatus.kOptimal:
        return -np.inf
    return float(highs.getInfo().objective_function_value)


if __name__ == "__main__":
    sys.exit(main())
