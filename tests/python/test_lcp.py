"""`lcp.solve` against an independent reference, and against what it says about itself."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import sparse
from scipy.optimize import nnls

import drystone as ds
from drystone import lcp

Array = NDArray[np.float64]


def _nnls_problem(rng: np.random.Generator, n: int, rank: int) -> tuple[Array, Array, Array]:
    """min |B z - c| over z >= 0 is the problem M = B'B, q = -B'c, of the given rank."""
    B = rng.standard_normal((rank, n))
    c = rng.standard_normal(rank)
    _, distance = nnls(B, c)
    return B, c, np.array(distance)


@pytest.mark.parametrize("method", lcp.METHODS)
def test_random_problems_of_every_rank_against_least_squares(method: str) -> None:
    rng = np.random.default_rng(1)
    for _ in range(150):
        n = int(rng.integers(1, 25))
        rank = int(rng.integers(1, n + 1))
        B, c, distance = _nnls_problem(rng, n, rank)
        M, q = B.T @ B, -B.T @ c
        solution = lcp.solve(M, q, method=method)
        assert solution.status == "solved"
        assert solution.recheck(M, q) <= 1e-9
        # z need not be unique where M is singular; the distance it reaches is.
        assert np.linalg.norm(B @ solution.z - c) == pytest.approx(float(distance), abs=1e-7)


def test_solutions_start_larger_problems() -> None:
    """Theorem 1: at most n - k major cycles, and the solution is one of the larger problem."""
    rng = np.random.default_rng(2)
    for _ in range(100):
        n = int(rng.integers(2, 25))
        B, c, distance = _nnls_problem(rng, n, int(rng.integers(1, n + 1)))
        M, q = B.T @ B, -B.T @ c
        indices = rng.permutation(n)[: int(rng.integers(1, n))]
        part = lcp.solve(M[np.ix_(indices, indices)], q[indices])
        whole = lcp.solve(M, q, start=part.start(indices))
        assert whole.status == "solved"
        assert whole.major_cycles <= n - len(indices)
        assert whole.recheck(M, q) <= 1e-9
        assert np.linalg.norm(B @ whole.z - c) == pytest.approx(float(distance), abs=1e-7)


def test_the_solution_of_the_problem_itself_needs_no_pivot() -> None:
    rng = np.random.default_rng(3)
    B, c, _ = _nnls_problem(rng, 12, 7)
    M, q = B.T @ B, -B.T @ c
    again = lcp.solve(M, q, start=lcp.solve(M, q).start(range(12)))
    assert (again.status, again.pivots) == ("solved", 0)


@pytest.mark.parametrize("kind", ["csr_array", "csc_array", "coo_array", "csr_matrix", "dok_array"])
def test_sparse_and_dense_give_the_same(kind: str) -> None:
    rng = np.random.default_rng(4)
    B, c, _ = _nnls_problem(rng, 10, 6)
    M, q = B.T @ B, -B.T @ c
    dense, thin = lcp.solve(M, q), lcp.solve(getattr(sparse, kind)(M), q)
    assert dense.z == pytest.approx(thin.z, abs=1e-12)
    assert dense.pivots == thin.pivots


def test_no_solution_comes_with_a_proof() -> None:
    M = np.array([[1.0, -1.0], [-1.0, 1.0]])
    q = np.array([-1.0, -1.0])
    solution = lcp.solve(M, q)
    assert solution.status == "no_solution"
    ray = solution.ray
    assert ray is not None
    assert np.all(ray >= 0)
    assert np.all(M.T @ ray <= 1e-12)
    assert q @ ray < 0


def test_a_pivot_limit_is_a_status() -> None:
    M, q = np.eye(6), -np.ones(6)
    solution = lcp.solve(M, q, pivot_limit=2)
    assert solution.status == "pivot_limit"
    assert solution.pivots <= 2
    assert solution.recheck(M, q) > 1e-3


def test_lemke_takes_a_matrix_that_is_not_symmetric() -> None:
    """A P-matrix, so the solution is unique: z = (0, 3), w = (4, 0) by hand."""
    M = np.array([[1.0, 3.0], [0.0, 1.0]])
    q = np.array([-5.0, -3.0])
    assert lcp.solve(M, q, method="lemke").z == pytest.approx([0.0, 3.0])
    with pytest.raises(lcp.LcpError, match="symmetric"):
        lcp.solve(M, q)


def test_the_empty_problem_is_solved() -> None:
    solution = lcp.solve(np.zeros((0, 0)), np.zeros(0))
    assert (solution.status, solution.pivots, solution.residual) == ("solved", 0, 0.0)


NAN, INF = float("nan"), float("inf")
ONE = np.ones(1)
BAD = {
    "nan in M": ([[NAN]], [1.0], "M"),
    "infinity in q": ([[1.0]], [INF], "q"),
    "M not square": ([[1.0, 2.0]], [1.0], "square"),
    "M a vector": ([1.0], [1.0], "square"),
    "q too long": ([[1.0]], [1.0, 2.0], "q"),
    "q a matrix": ([[1.0]], [[1.0]], "vector"),
    "complex M": ([[1j]], [1.0], "real"),
    "words": ([["a"]], [1.0], "real"),
    "M of None": (None, [1.0], "M"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_problems_are_errors(case: str) -> None:
    M, q, part = BAD[case]
    with pytest.raises(lcp.LcpError, match=part):
        lcp.solve(M, q)


BAD_STARTS = {
    "index too large": lambda: lcp.Start([1], ONE),
    "negative index": lambda: lcp.Start([-1], ONE),
    "index twice": lambda: lcp.Start([0, 0], [1.0, 1.0]),
    "fractional index": lambda: lcp.Start([0.5], ONE),
    "lengths that differ": lambda: lcp.Start([0], [1.0, 2.0]),
    "not a solution": lambda: lcp.Start([0], [5.0]),
    "negative z": lambda: lcp.Start([0], [-1.0]),
    "nan": lambda: lcp.Start([0], [NAN]),
    "not a start": lambda: np.array([1.0]),
}


@pytest.mark.parametrize("case", BAD_STARTS)
def test_a_start_that_is_none_is_refused(case: str) -> None:
    with pytest.raises(lcp.StartError):
        lcp.solve(np.eye(1), -ONE, start=BAD_STARTS[case]())


def test_lemke_takes_no_start() -> None:
    with pytest.raises(lcp.StartError):
        lcp.solve(np.eye(1), -ONE, start=lcp.Start([0], ONE), method="lemke")


def test_an_unknown_method_is_an_error() -> None:
    with pytest.raises(ds.LcpError, match="newton"):
        lcp.solve(np.eye(1), ONE, method="newton")
