"""The benchmark on files of Siconos: what it reads, and its Gauss-Seidel method."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from scipy import sparse

BENCHMARKS = str(Path(__file__).parents[2] / "benchmarks")
sys.path.insert(0, BENCHMARKS)

import fclib  # noqa: E402
import fclib_problems  # noqa: E402
import gauss_seidel  # noqa: E402

sys.path.remove(BENCHMARKS)

W = np.array([[4.0, 1, 0, 1], [1, 3, 1, 0], [0, 1, 5, 1], [1, 0, 1, 2]])
"""Two contacts in the plane."""
TAIL = "-1.0 0.5 -2.0 3.0\n0.5 0.25\n1\n"
DENSE = "2\n2\n0\n4\n4\n4\t4\n" + " ".join(str(x) for x in W.T.ravel()) + "\n" + TAIL


def _blocks() -> str:
    parts = [W[i : i + 2, j : j + 2].T.ravel() for i in (0, 2) for j in (0, 2)]
    head = "2\n2\n1\n4\n4\n4\n2\n2\n2 4\n2 4\n3\n4\n0 2 4\n0 1 0 1\n"
    lines = (f"{k}\n" + "\n".join(str(x) for x in part) for k, part in enumerate(parts))
    return head + "\n".join(lines) + "\n" + TAIL


def _csparse(columns: bool) -> str:
    found = sparse.csc_matrix(W)
    text = "2\n2\n2\n4\n4\n2\nCSparse Version 3.1.9\n4-by-4, nzmax: 12 nnz: 12"
    if not columns:
        entries = found.tocoo()
        lines = (
            f"{i} {j} : {x}" for i, j, x in zip(entries.row, entries.col, entries.data, strict=True)
        )
        return "\n".join([text, *lines, TAIL])
    text += ", 1-norm: 7"
    for j in range(4):
        first, last = found.indptr[j], found.indptr[j + 1]
        text += f"\n    col {j} : locations {first} to {last - 1}\n"
        text += "\n".join(f"{found.indices[k]} : {found.data[k]}" for k in range(first, last))
    return f"{text}\n{TAIL}"


@pytest.mark.parametrize("text", [DENSE, _blocks(), _csparse(True), _csparse(False)])
def test_all_kinds_of_files_say_the_same(text: str, tmp_path: Path) -> None:
    path = tmp_path / "problem.dat"
    path.write_text(text)
    problem = fclib_problems.read(path)
    assert problem.delassus.toarray() == pytest.approx(W)
    assert problem.q == pytest.approx([-1, 0.5, -2, 3])
    assert problem.friction == pytest.approx([0.5, 0.25])
    assert problem.jacobian @ problem.free == pytest.approx(problem.q)
    assert (problem.jacobian @ problem.jacobian.T).toarray() == pytest.approx(W, abs=1e-11)


def test_both_methods_solve_it(tmp_path: Path) -> None:
    path = tmp_path / "problem.dat"
    path.write_text(_blocks())
    problem = fclib_problems.read(path)
    tolerance = fclib.tolerance_of(problem)
    law = problem.delassus, problem.q, problem.friction
    found, _ = fclib.solved(problem, tolerance)
    swept = gauss_seidel.solve(*law, tolerance, 5.0)
    assert swept.impulses == pytest.approx(found.impulses, abs=1e-7)
    assert gauss_seidel.coulomb_error(*law, found.impulses) <= tolerance
    assert gauss_seidel.coulomb_error(*law, np.zeros(4)) > 0.1


def test_a_global_problem_has_its_masses(tmp_path: Path) -> None:
    """A block of 2 kg that slides on a ground which moves along: M v = H p + q, u = H' v + b."""
    path = tmp_path / "problem.dat"
    mass, h = np.diag([2.0, 2.0]), np.eye(2)
    matrices = "".join(
        "0\n2\n2\n2\t2\n" + " ".join(str(x) for x in matrix.ravel()) + "\n" for matrix in (mass, h)
    )
    path.write_text("2\n1\n" + matrices + "-2.0 6.0\n0.0 -1.0\n0.5\n")
    problem = fclib_problems.read(path)
    assert problem.contains_mass
    assert problem.q == pytest.approx([-1, 2])
    found, _ = fclib.solved(problem, 1e-8)
    assert found.impulses == pytest.approx([2, -1])
    assert found.velocities[:2] == pytest.approx([0, 2.5])


def test_what_is_no_problem_is_refused(tmp_path: Path) -> None:
    (tmp_path / "cut.dat").write_text(DENSE[:40])
    (tmp_path / "empty.dat").write_text("")
    for name in ("cut.dat", "empty.dat"):
        with pytest.raises((ValueError, IndexError)):
            fclib_problems.read(tmp_path / name)
