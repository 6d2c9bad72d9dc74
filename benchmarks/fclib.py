"""Public contact problems of Siconos and FCLIB, beside block Gauss-Seidel.

    git clone --depth 1 https://github.com/siconos/siconos
    .venv/bin/pip install h5py      # for the HDF5 files
    .venv/bin/python benchmarks/fclib.py siconos/numerics/src/FrictionContact/test/data

Takes any folder of such files; none are kept here. Both sides solve to 1e-8 of the largest relative
velocity, and the same function says how far each is off Coulomb's law on the W of the file. Where a
file has W alone, drystone gets unit masses and a sparse root of W (`fclib_problems.py`), which is
in nobody's time.

The Gauss-Seidel method is in Python; compiled, as the sweeps of drystone are, a contact takes about
165 ns, and that is what its time is reckoned with. It is given up after half a minute, and its
error says how far it came by then.
"""

from __future__ import annotations

import threads  # noqa: F401  (before anything that loads NumPy)

# isort: split

import argparse
import time
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

import drystone as ds
import gauss_seidel
from fclib_problems import FrictionProblem, read

TOLERANCE = 1e-8
"""Of the largest relative velocity without impulses."""

SECONDS = 30.0
"""Of Gauss-Seidel, at most."""
COMPILED = 165e-9
"""Seconds a contact takes in a compiled sweep, measured (docs/theory/step-solver.md)."""

SMALL = 10
"""Contacts: smaller problems are solved, but have no line of their own."""


def tolerance_of(problem: FrictionProblem) -> float:
    """m/s."""
    u = problem.q.reshape(len(problem.friction), -1)
    return TOLERANCE * float(np.linalg.norm(u, axis=1).max())


def solved(problem: FrictionProblem, tolerance: float) -> tuple[ds.contact.Solution, float]:
    """What drystone finds, and the seconds of the fastest of three solves; of one that is long."""
    times: list[float] = []
    while len(times) < 3 and sum(times) < 1:
        begun = time.perf_counter()
        found = ds.contact.solve(
            problem.mass,
            problem.jacobian,
            problem.friction,
            problem.free,
            dimension=problem.dimension,
            tolerance=tolerance,
        )
        times.append(time.perf_counter() - begun)
    return found, min(times)


def line(name: str, problem: FrictionProblem) -> list[str]:
    """One line of the table."""
    tolerance, contacts = tolerance_of(problem), len(problem.friction)
    law = problem.delassus, problem.q, problem.friction
    found, seconds = solved(problem, tolerance)
    ours = gauss_seidel.coulomb_error(*law, found.impulses) / tolerance * TOLERANCE
    swept = gauss_seidel.solve(*law, tolerance, SECONDS)
    theirs = gauss_seidel.coulomb_error(*law, swept.impulses) / tolerance * TOLERANCE
    reckoned = swept.sweeps * contacts * COMPILED
    kind = "M, H" if problem.contains_mass else "W"
    return [
        name,
        f"{contacts}",
        kind,
        f"{found.newton_steps}",
        f"{1e3 * seconds:.2g}",
        f"{ours:.0e}",
        f"{swept.sweeps}",
        f"{1e3 * reckoned:.2g}",
        f"{theirs:.0e}",
    ]


def main() -> None:
    """Print a line for each problem, and what could not be read."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", default="", help="only files with this in their names")
    arguments = parser.parse_args()
    if not arguments.folder.is_dir():
        parser.error(f"{arguments.folder} is no folder")
    table = Table(
        "", "contacts", "given", "Newton", "ms", "error", "sweeps", "ms, reckoned", "error"
    )
    console, small, unread = Console(width=120), [0, 0], []
    for path in sorted(arguments.folder.iterdir()):
        if arguments.only not in path.name:
            continue
        try:
            problem = read(path)
        except (ValueError, IndexError, KeyError, OSError, ModuleNotFoundError) as error:
            unread.append(f"{path.name}: {error}")
            continue
        if not len(problem.friction):
            unread.append(f"{path.name}: no contacts")
            continue
        if len(problem.friction) < SMALL:
            tolerance = tolerance_of(problem)
            found, _ = solved(problem, tolerance)
            law = problem.delassus, problem.q, problem.friction
            small[0] += 1
            small[1] += gauss_seidel.coulomb_error(*law, found.impulses) <= tolerance
            continue
        with console.status(path.name):
            table.add_row(*line(path.name, problem))
    console.print(table)
    console.print(f"of fewer than {SMALL} contacts: {small[1]} of {small[0]} solved")
    console.print(*(f"not read: {text}" for text in unread), sep="\n", markup=False)


if __name__ == "__main__":
    main()
