"""Families of random linear complementarity problems, their answers known by how they are made.

A problem is made feasible by `q = s - M z0` with z0, s >= 0, which for a semidefinite M makes it
solvable; it is made to have no solution by a y >= 0 with M y = 0 and q'y < 0. Where q is anything,
the reference (`lcp_reference.py`) has to find out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Random = np.random.Generator


@dataclass(frozen=True)
class Problem:
    """One problem, and what is known of it."""

    M: Array
    q: Array
    expected: str | None = None
    """ "solved", "no_solution", or None where only the reference tells."""
    semidefinite: bool = True
    """Symmetric and positive semidefinite but for rounding: all three methods take it."""
    rounded: bool = False
    """M was written with few decimals, so that it may be indefinite."""
    clear: bool = True
    """Whether a linear program in double precision can tell."""
    another_q: Callable[[Random], Array] | None = None
    """Another q, if with every q from here every principal sub-problem has the expected answer."""


@dataclass(frozen=True)
class Family:
    """A kind of problem."""

    name: str
    make: Callable[[Random], Problem]


def _size(rng: Random, most: int = 40) -> int:
    return int(2 + (most - 1) * rng.random() ** 2)


def _sparse(rng: Random, n: int) -> Array:
    """Not negative, a third of it zero."""
    return np.where(rng.random(n) < 1 / 3, 0.0, rng.random(n))


def _gram(G: Array) -> Array:
    M = G.T @ G
    return (M + M.T) / 2


def _generators(rng: Random, definite: bool = False) -> Array:
    n = _size(rng)
    rank = n + 2 if definite else int(rng.integers(1, n + 1))
    return rng.standard_normal((rank, n))


def _feasible(rng: Random, M: Array) -> Problem:
    n = len(M)
    return Problem(M, _sparse(rng, n) - M @ _sparse(rng, n), "solved")


def _dependent(rng: Random, G: Array) -> tuple[Array, Array]:
    """G with one column more, which some others balance: G y = 0 with y >= 0."""
    n = G.shape[1]
    y = np.zeros(n + 1)
    chosen = rng.choice(n, size=min(n, int(rng.integers(1, 6))), replace=False)
    y[chosen] = rng.uniform(0.2, 1.0, len(chosen))
    y[n] = 1.0
    return np.column_stack([G, -(G @ y[:n])]), y


def _infeasible(rng: Random, M: Array, y: Array) -> Problem:
    """`q'y` is below zero by at least 1e-6 of q and y."""
    q = _feasible(rng, M).q
    support = y > 0
    q[support] -= q @ y / y.sum()
    share = 10 ** rng.uniform(-6, 0)
    q[support] -= share * np.abs(q).max()
    return Problem(M, q, "no_solution")


def _anything(rng: Random, M: Array) -> Problem:
    return Problem(M, rng.standard_normal(len(M)))


def _any_solvable(rng: Random, M: Array) -> Problem:
    """Any q, and always a solution."""

    def another_q(rng: Random) -> Array:
        return rng.standard_normal(len(M))

    return Problem(M, another_q(rng), "solved", another_q=another_q)


def _loaded(rng: Random, G: Array, decimals: int | None = None) -> Problem:
    """`q = -G'h`, which is solvable with whatever columns of G."""
    M = _gram(G)

    def another_q(rng: Random) -> Array:
        q = -G.T @ rng.standard_normal(len(G))
        return q if decimals is None else np.round(q, decimals)

    M = M if decimals is None else np.round(M, decimals)
    return Problem(M, another_q(rng), "solved", rounded=decimals is not None, another_q=another_q)


def _condition(rng: Random, digits: float) -> Array:
    """A definite M with a given condition number."""
    n = _size(rng, 24)
    Q = np.linalg.qr(rng.standard_normal((n, n)))[0]
    M = (Q * 10 ** np.linspace(-digits, 0, n)) @ Q.T
    return (M + M.T) / 2


def _near_columns(rng: Random, G: Array) -> Array:
    """Repeats columns of G up to a difference of 1e-14 to 1e-1."""
    copies = rng.choice(G.shape[1], size=int(rng.integers(1, 4)))
    near = 10 ** rng.uniform(-14, -1, len(copies))
    return np.column_stack([G, G[:, copies] + near * rng.standard_normal((len(G), len(copies)))])


def definite(rng: Random) -> Problem:
    """Definite M, any q: one solution."""
    return _any_solvable(rng, _gram(_generators(rng, definite=True)))


def condition(digits: float, rng: Random) -> Problem:
    """The same with a condition number of 10^digits."""
    return _any_solvable(rng, _condition(rng, digits))


def condition_feasible(rng: Random) -> Problem:
    """A condition number from 1e4 to 1e15, and a solution of the size of one."""
    return _feasible(rng, _condition(rng, rng.uniform(4, 15)))


def dependent_feasible(rng: Random) -> Problem:
    """M of any rank."""
    return _feasible(rng, _gram(_generators(rng)))


def dependent_infeasible(rng: Random) -> Problem:
    """M of any rank, no solution."""
    G, y = _dependent(rng, _generators(rng))
    return _infeasible(rng, _gram(G), y)


def dependent_anything(rng: Random) -> Problem:
    """M of any rank, any q."""
    return _anything(rng, _gram(_generators(rng)))


def near_feasible(rng: Random) -> Problem:
    """Columns repeated up to a small difference."""
    return _feasible(rng, _gram(_near_columns(rng, _generators(rng))))


def near_infeasible(rng: Random) -> Problem:
    """The same without a solution."""
    G, y = _dependent(rng, _generators(rng))
    near = _near_columns(rng, G)
    y = np.concatenate([y, np.zeros(near.shape[1] - len(y))])
    return _infeasible(rng, _gram(near), y)


def near_anything(rng: Random) -> Problem:
    """The same with any q."""
    M = _gram(_near_columns(rng, _generators(rng)))
    return replace(_anything(rng, M), clear=False)


def near_opposite(rng: Random) -> Problem:
    """Columns that are each other's opposite up to a small difference."""
    G = _generators(rng)
    opposite = -_near_columns(rng, G)[:, G.shape[1] :]
    return _loaded(rng, np.column_stack([G, opposite]))


def contact(spread: float, rng: Random) -> Problem:
    """M = G' W G, q = -G' W h of bodies in a row, their masses apart by 10^spread."""
    bodies, points = int(rng.integers(1, 6)), int(rng.integers(1, 5))
    G = np.zeros((3 * bodies, 2 * points * bodies))
    for j in range(G.shape[1]):
        body = j // (2 * points)
        lever, slope = rng.uniform(-1, 1), (0.5 if j % 2 else -0.5)
        wrench = np.array([slope, 1.0, lever + 0.5 * slope]) / np.hypot(slope, 1.0)
        G[3 * body : 3 * body + 3, j] = wrench
        if body > 0:
            G[3 * body - 3 : 3 * body, j] = -wrench
    W = np.repeat(10 ** rng.uniform(-spread / 2, spread / 2, bodies), 3)
    return _loaded(rng, np.sqrt(W)[:, None] * G)


def contact_infeasible(rng: Random) -> Problem:
    """Contacts that wedge a body in, and speeds along them that no impulse gives."""
    G, y = _dependent(rng, rng.standard_normal((3, int(rng.integers(3, 10)))))
    W = 10 ** rng.uniform(-2, 2, 3)
    return _infeasible(rng, _gram(np.sqrt(W)[:, None] * G), y)


def rounded(decimals: int, rng: Random) -> Problem:
    """M = G'G, q = -G'h, written with few decimals: solvable but for the rounding."""
    return _loaded(rng, rng.standard_normal((8, 30)), decimals)


def rounded_infeasible(rng: Random) -> Problem:
    """The same of a problem without a solution, with 6 to 12 decimals; M may be indefinite."""
    problem = dependent_infeasible(rng)
    decimals = int(rng.integers(6, 13))
    M, q = np.round(problem.M, decimals), np.round(problem.q, decimals)
    return Problem(M, q, None, rounded=True, clear=False)


def scaled(rng: Random) -> Problem:
    """Rows and columns in units from 1e-8 to 1e8."""
    make = (dependent_feasible, near_feasible, definite)[rng.integers(3)]
    return _in_units(make(rng), 10 ** rng.uniform(-8, 8, 100), 1.0)


def scaled_infeasible(rng: Random) -> Problem:
    """The same without a solution."""
    make = (dependent_infeasible, near_infeasible)[rng.integers(2)]
    return _in_units(make(rng), 10 ** rng.uniform(-8, 8, 100), 1.0)


def huge_or_tiny(rng: Random) -> Problem:
    """M and q each in another unit, 1e-90 to 1e90."""
    make = (dependent_feasible, near_feasible, dependent_infeasible, near_infeasible)[
        rng.integers(4)
    ]
    return _in_units(
        make(rng), np.full(100, 10 ** rng.uniform(-45, 45)), 10 ** rng.uniform(-90, 90)
    )


def _in_units(problem: Problem, d: Array, unit: float) -> Problem:
    """`D M D` and `D q`, in powers of two, which round nothing."""
    d = np.exp2(np.round(np.log2(d[: len(problem.q)])))
    M, q = problem.M * d * d[:, None], problem.q * d * np.exp2(np.round(np.log2(unit)))
    return replace(problem, M=M, q=q)


def _hilbert(n: int) -> Array:
    return 1.0 / (np.arange(n)[:, None] + np.arange(n) + 1.0)


def hilbert_feasible(rng: Random) -> Problem:
    """Hilbert's matrix, up to a condition number of 1e18."""
    return _feasible(rng, _hilbert(int(rng.integers(2, 14))))


def hilbert_anything(rng: Random) -> Problem:
    """Hilbert's matrix of order 8 at most (condition number 1.5e10), any q."""
    return _any_solvable(rng, _hilbert(int(rng.integers(2, 9))))


def ties(rng: Random) -> Problem:
    """Whole numbers: a solution with z and w both zero in a third of the pairs."""
    G = _whole(rng)
    M, n = G.T @ G, G.shape[1]
    kind = rng.integers(3, size=n)
    z, w = (
        np.where(kind == 0, rng.integers(1, 4, n), 0),
        np.where(kind == 1, rng.integers(1, 4, n), 0),
    )
    return Problem(M, w - M @ z, "solved")


def ties_anything(rng: Random) -> Problem:
    """Whole numbers, any q."""
    G = _whole(rng)
    return Problem(G.T @ G, rng.integers(-1, 2, G.shape[1]).astype(float))


def ties_infeasible(rng: Random) -> Problem:
    """Whole numbers, no solution."""
    G = _whole(rng)
    y = np.zeros(G.shape[1] + 1)
    y[rng.choice(len(y) - 1, size=min(len(y) - 1, 3), replace=False)] = 1.0
    y[-1] = 1.0
    G = np.column_stack([G, -(G @ y[:-1])])
    M = G.T @ G
    q = -M @ rng.integers(0, 3, len(y)) + np.where(y > 0, 0, rng.integers(0, 3, len(y)))
    q[-1] -= 1
    return Problem(M, q.astype(float), "no_solution")


def _whole(rng: Random) -> Array:
    n = _size(rng)
    G = rng.integers(-1, 2, (int(rng.integers(1, n + 1)), n)).astype(float)
    copies = rng.random(n) < 0.2
    G[:, copies] = G[:, rng.integers(n, size=int(copies.sum()))]
    return G


def obstacle(rng: Random) -> Problem:
    """A string over an obstacle: tridiagonal, definite, with as many as 120 points."""
    n = int(rng.integers(50, 121))
    M = 2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    return replace(_anything(rng, M), expected="solved")


def _skew(rng: Random, n: int) -> Array:
    K = rng.standard_normal((n, n))
    return K - K.T


def _plus_skew(rng: Random, M: Array) -> Array:
    return M + rng.uniform(0, 2) * _skew(rng, len(M))


def definite_unsymmetric(rng: Random) -> Problem:
    """Definite and not symmetric: one solution."""
    M = _plus_skew(rng, _gram(_generators(rng, definite=True)))
    return replace(_anything(rng, M), expected="solved", semidefinite=False)


def condition_unsymmetric(rng: Random) -> Problem:
    """The same with a condition number of the symmetric part up to 1e12, feasible."""
    M = _condition(rng, rng.uniform(0, 12))
    M = M + 10 ** rng.uniform(-8, 0) * _skew(rng, len(M))
    return replace(_feasible(rng, M), semidefinite=False)


def near_unsymmetric(rng: Random) -> Problem:
    """Semidefinite and not symmetric, with rows that nearly depend on one another; feasible."""
    G = _near_columns(rng, _generators(rng))
    K = _skew(rng, len(G))
    return replace(_feasible(rng, G.T @ (G + K @ G)), semidefinite=False)


def _program(rng: Random) -> tuple[Array, Array, Array, int, int]:
    rows, columns = int(rng.integers(1, 12)), int(rng.integers(1, 12))
    A = rng.standard_normal((rows, columns))
    if rng.random() < 0.3:
        A = np.round(A)
    n = rows + columns
    M = np.zeros((n, n))
    M[:columns, columns:], M[columns:, :columns] = -A.T, A
    return M, A, np.zeros(n), rows, columns


def program_feasible(rng: Random) -> Problem:
    """The conditions of a linear program with a solution: skew-symmetric, so copositive-plus."""
    M, A, q, rows, columns = _program(rng)
    x, y = _sparse(rng, columns), _sparse(rng, rows)
    q[:columns] = A.T @ y + _sparse(rng, columns)
    q[columns:] = -A @ x + _sparse(rng, rows)
    return Problem(M, q, "solved", semidefinite=False)


def program_infeasible(rng: Random) -> Problem:
    """The same of one whose constraints contradict one another."""
    M, A, q, rows, columns = _program(rng)
    y = rng.uniform(0.2, 1.0, rows)
    A = A - np.outer(y, np.maximum(y @ A, 0.0) + rng.random(columns)) / (y @ y)
    M[:columns, columns:], M[columns:, :columns] = -A.T, A
    q = rng.standard_normal(rows + columns)
    q[columns:] -= (q[columns:] @ y + rng.uniform(1e-3, 1.0) * np.abs(q).max() * y.sum()) / y.sum()
    return Problem(M, q, "no_solution", semidefinite=False)


def strictly_copositive(rng: Random) -> Problem:
    """Not negative with a positive diagonal: a solution for any q."""
    n = _size(rng, 20)
    M = np.where(rng.random((n, n)) < 0.5, 0.0, rng.random((n, n))) + np.diag(
        rng.uniform(0.1, 1, n)
    )
    return replace(_anything(rng, M), expected="solved", semidefinite=False)


def triangular(rng: Random) -> Problem:
    """A triangular P-matrix, far from semidefinite: one solution."""
    n = _size(rng, 16)
    M = np.tril(2 * rng.standard_normal((n, n)), -1) + np.eye(n)
    return replace(_anything(rng, M), expected="solved", semidefinite=False)


FAMILIES = [
    Family("definite", definite),
    *(Family(f"condition 1e{digits}", partial(condition, digits)) for digits in (4, 8, 10, 11, 12)),
    Family("condition to 1e15, feasible", condition_feasible),
    Family("dependent, feasible", dependent_feasible),
    Family("dependent, infeasible", dependent_infeasible),
    Family("dependent, any q", dependent_anything),
    Family("near columns, feasible", near_feasible),
    Family("near columns, infeasible", near_infeasible),
    Family("near columns, any q", near_anything),
    Family("near opposite columns", near_opposite),
    *(Family(f"contact, masses 1e{spread}", partial(contact, spread)) for spread in (1, 6, 10)),
    Family("contact, infeasible", contact_infeasible),
    *(
        Family(f"{decimals} decimals", partial(rounded, decimals))
        for decimals in (12, 11, 10, 9, 8, 6)
    ),
    Family("few decimals, infeasible", rounded_infeasible),
    Family("units 1e-8 to 1e8", scaled),
    Family("units 1e-8 to 1e8, infeasible", scaled_infeasible),
    Family("huge or tiny", huge_or_tiny),
    Family("Hilbert, feasible", hilbert_feasible),
    Family("Hilbert, any q", hilbert_anything),
    Family("ties, feasible", ties),
    Family("ties, any q", ties_anything),
    Family("ties, infeasible", ties_infeasible),
    Family("obstacle", obstacle),
    Family("definite, not symmetric", definite_unsymmetric),
    Family("condition to 1e12, not symmetric", condition_unsymmetric),
    Family("near columns, not symmetric", near_unsymmetric),
    Family("linear program, feasible", program_feasible),
    Family("linear program, infeasible", program_infeasible),
    Family("strictly copositive", strictly_copositive),
    Family("triangular P-matrix", triangular),
]
