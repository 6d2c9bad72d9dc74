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


@pytest.mark.parametrize("method", lcp.METHODS)
def test_solutions_start_larger_problems(method: str) -> None:
    """Theorem 1: at most n - k major cycles, and the solution is one of the larger problem."""
    rng = np.random.default_rng(2)
    for _ in range(100):
        n = int(rng.integers(2, 25))
        B, c, distance = _nnls_problem(rng, n, int(rng.integers(1, n + 1)))
        M, q = B.T @ B, -B.T @ c
        indices = rng.permutation(n)[: int(rng.integers(1, n))]
        part = lcp.solve(M[np.ix_(indices, indices)], q[indices], method=method)
        whole = lcp.solve(M, q, start=part.start(indices), method=method)
        assert whole.status == "solved"
        if method == "dantzig":
            assert whole.major_cycles <= n - len(indices)
        assert whole.recheck(M, q) <= 1e-9
        assert np.linalg.norm(B @ whole.z - c) == pytest.approx(float(distance), abs=1e-7)


@pytest.mark.parametrize("method", lcp.METHODS)
def test_the_solution_of_the_problem_itself_needs_no_pivot(method: str) -> None:
    rng = np.random.default_rng(3)
    B, c, _ = _nnls_problem(rng, 12, 7)
    M, q = B.T @ B, -B.T @ c
    again = lcp.solve(M, q, start=lcp.solve(M, q).start(range(12)), method=method)
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
    assert solution.recheck([list(row) for row in np.asarray(M)], q) == solution.recheck(M, q)


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
    "M a vector": ([1.0], [1.0], "M must be a matrix of rows"),
    "q too long": ([[1.0]], [1.0, 2.0], "q"),
    "q a matrix": ([[1.0]], [[1.0]], "vector"),
    "complex M": ([[1j]], [1.0], "real"),
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


@pytest.mark.parametrize("method", lcp.METHODS)
@pytest.mark.parametrize("case", BAD_STARTS)
def test_a_start_that_is_none_is_refused(case: str, method: str) -> None:
    with pytest.raises(lcp.StartError):
        lcp.solve(np.eye(1), -ONE, start=BAD_STARTS[case](), method=method)


def test_lemke_starts_from_a_matrix_that_is_not_symmetric() -> None:
    """A chain of P-matrices: every part is a start of the next, and a solve from it costs less."""
    rng = np.random.default_rng(8)
    n = 30
    M = np.tril(rng.uniform(-2, 2, (n, n)), -1) + np.eye(n)
    q = rng.standard_normal(n)
    part = lcp.solve(M[:1, :1], q[:1], method="lemke")
    reused = fresh = 0
    for k in range(2, n + 1):
        start = part.start(range(k - 1))
        part = lcp.solve(M[:k, :k], q[:k], start=start, method="lemke")
        other = lcp.solve(M[:k, :k], q[:k], method="lemke")
        assert (part.status, other.status) == ("solved", "solved")
        assert part.z == pytest.approx(other.z, rel=1e-9, abs=1e-9)
        reused, fresh = reused + part.pivots, fresh + other.pivots
    assert 3 * reused < fresh


def test_an_unknown_method_is_an_error() -> None:
    with pytest.raises(ds.LcpError, match="newton"):
        lcp.solve(np.eye(1), ONE, method="newton")


def _columns(rng: np.random.Generator, rows: int, n: int) -> sparse.csc_array:
    """Generators with a few entries a column."""
    return sparse.random_array(
        (rows, n), density=0.3, rng=rng, format="csc", data_sampler=rng.standard_normal
    )


def test_a_sequence_gives_the_answers_of_fresh_solves() -> None:
    """Add, remove, change q, go back; w is unique, so it is what is compared."""
    rng = np.random.default_rng(5)
    kept = fresh_pivots = 0
    for case in range(15):
        n = int(rng.integers(4, 40))
        G = _columns(rng, int(rng.integers(2, n + 1)), n)
        M = (G.T @ G).tocsc()
        solver = lcp.Solver(M if case % 2 else M.toarray(), -G.T @ rng.standard_normal(G.shape[0]))
        solver.add_rows(rng.permutation(n)[: n // 2])
        saved = [(solver.snapshot(), solver.rows, solver.q)]
        for _ in range(25):
            some = rng.permutation(n)[: int(rng.integers(1, 4))]
            match int(rng.integers(4)):
                case 0:
                    solver.add_rows(some)
                case 1:
                    solver.remove_rows(some)
                case 2:
                    # q in the range of G', so that every part has a solution.
                    solver.set_q(solver.q - 0.3 * G.T @ rng.standard_normal(G.shape[0]))
                case _:
                    state, rows, q = saved[int(rng.integers(len(saved)))]
                    solver.restore(state)
                    assert list(solver.rows) == list(rows)
                    assert list(solver.q) == list(q)
            before = solver.counts.pivots
            solution = solver.solve()
            assert solution.pivots == solver.counts.pivots - before
            rows = solution.rows
            fresh = lcp.solve(M[rows][:, rows], solver.q[rows])
            assert (solution.status, fresh.status) == ("solved", "solved")
            assert solution.recheck(M, solver.q) <= 1e-9
            part = solution.restricted()
            assert part.recheck(M[rows][:, rows], solver.q[rows]) <= 1e-9
            scale = max(np.abs(solver.q).max(), np.abs(part.z).max(initial=0.0))
            assert part.w == pytest.approx(fresh.w, abs=1e-8 * scale)
            assert not np.any(np.delete(solution.z, rows))
            kept, fresh_pivots = kept + solution.pivots, fresh_pivots + fresh.pivots
            saved.append((solver.snapshot(), solver.rows, solver.q))
    assert 2 * kept < fresh_pivots


def test_generators_make_their_matrix() -> None:
    rng = np.random.default_rng(6)
    G = _columns(rng, 12, 30)
    W, h = rng.uniform(0.1, 3, 12), rng.standard_normal(12)
    M, q = (G.T @ sparse.diags_array(W) @ G).toarray(), -G.T @ (W * h)
    for form in (G, G.toarray()):
        solver = lcp.Solver.from_generators(form, W, h)
        assert solver.q == pytest.approx(q)
        solver.add_rows(np.arange(30))
        assert solver.solve().w == pytest.approx(lcp.solve(M, q).w, abs=1e-9)


def test_a_part_without_a_solution_comes_with_a_proof_and_the_solver_goes_on() -> None:
    M = np.array([[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 2.0]])
    solver = lcp.Solver(M, [-1.0, -1.0, -2.0])
    solver.add_rows([0, 1])
    none = solver.solve()
    assert none.status == "no_solution"
    assert none.ray is not None
    assert none.ray / none.ray.max() == pytest.approx([1, 1, 0])
    solver.add_rows([2])
    solver.remove_rows([1])
    assert solver.solve().z == pytest.approx([1, 0, 1])


def _two() -> lcp.Solver:
    solver = lcp.Solver(np.eye(2), [-1.0, -2.0])
    solver.add_rows([0])
    return solver


BAD_CHANGES = {
    "row too large": (lambda s: s.add_rows([2]), "row 2"),
    "negative row": (lambda s: s.remove_rows([-1]), "negative"),
    "fractional row": (lambda s: s.add_rows([0.5]), "whole"),
    "one number": (lambda s: s.add_rows(1), "vector"),
    "q too short": (lambda s: s.set_q([1.0]), "q"),
    "nan in q": (lambda s: s.set_q([1.0, NAN]), r"q\[1\]"),
    "nan on a row": (lambda s: s.set_q([NAN], rows=[1]), r"q\[1\]"),
    "values that are too many": (lambda s: s.set_q([1.0, 2.0], rows=[1]), "2 values"),
    "a snapshot of another": (lambda s: s.restore(_two().snapshot()), "another solver"),
    "no snapshot": (lambda s: s.restore(None), "Snapshot"),
    "a negative limit": (
        lambda s: lcp.Solver(np.eye(2), [1.0, 1.0], pivot_limit=-1),
        "pivot_limit",
    ),
    "M not symmetric": (lambda s: lcp.Solver([[1.0, 2.0], [0.0, 1.0]], [1.0, 1.0]), "symmetric"),
    "W negative": (lambda s: lcp.Solver.from_generators([[1.0]], [-1.0], ONE), "inverse mass"),
    "h too long": (lambda s: lcp.Solver.from_generators([[1.0]], ONE, [1.0, 2.0]), "h has 2"),
    "G a vector": (lambda s: lcp.Solver.from_generators([1.0], ONE, ONE), "G must be a matrix"),
}


@pytest.mark.parametrize("case", BAD_CHANGES)
def test_what_a_solver_refuses_changes_nothing(case: str) -> None:
    solver = _two()
    change, part = BAD_CHANGES[case]
    with pytest.raises(lcp.LcpError, match=part):
        change(solver)
    assert list(solver.rows) == [0]
    assert list(solver.solve().z) == [1.0, 0.0]
