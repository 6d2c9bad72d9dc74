"""Linear complementarity problems: w = M z + q, 0 <= z complementary to w >= 0.

>>> import numpy as np
>>> from drystone import lcp
>>> solution = lcp.solve(np.array([[2.0, 1.0], [1.0, 2.0]]), np.array([-5.0, -6.0]))
>>> solution.z.round(12)
array([1.33333333, 2.33333333])

The solution of a sub-problem is a start for the larger one (Theorem 1 of the paper). Here the
first two indices of three:

>>> M = np.array([[2.0, 1.0, 0.0], [1.0, 2.0, 1.0], [0.0, 1.0, 2.0]])
>>> larger = lcp.solve(M, np.array([-5.0, -6.0, -4.0]), start=solution.start([0, 1]))
>>> larger.status, larger.major_cycles
('solved', 1)

For a long sequence of related problems there is `Solver`, which keeps its factor.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from drystone import _core
from drystone._core import LcpError, StartError
from drystone.common.arrays import floats, vector
from drystone.common.compressed import by_columns, is_sparse
from drystone.common.text import counted

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray
    from typing_extensions import Self

    from drystone.common.compressed import Matrix

__all__ = [
    "METHODS",
    "Counts",
    "LcpError",
    "Snapshot",
    "Solution",
    "Solver",
    "Start",
    "StartError",
    "solve",
]

METHODS = ("dantzig", "lemke", "block")
"""The methods `solve` knows: see there."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Start:
    """The solution of a sub-problem, as a start for a larger one.

    The sub-problem is `M[indices][:, indices]`, `q[indices]` of the larger problem, and `z` its
    solution, in the order of `indices`.
    """

    indices: NDArray[np.int64]
    """(k,), which indices of the larger problem the sub-problem has; each at most once."""
    z: NDArray[np.float64]
    """(k,), its solution."""

    def __post_init__(self) -> None:
        indices = np.asarray(self.indices)
        if indices.size and indices.dtype.kind not in "iu":
            raise StartError(f"start: indices must be whole numbers, not {indices.dtype}")
        object.__setattr__(self, "indices", np.ascontiguousarray(indices, dtype=np.int64))
        object.__setattr__(self, "z", _vector(self.z, "start: z"))
        if self.indices.ndim != 1 or self.indices.shape != self.z.shape:
            raise StartError(
                "start: indices and z must be vectors of one length, "
                f"not of shapes {self.indices.shape} and {self.z.shape}"
            )
        if np.any(self.indices < 0):
            raise StartError(f"start: index {self.indices.min()} is negative")

    def __repr__(self) -> str:
        return f"<Start: z on {counted(len(self.indices), 'row')}>"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Solution:
    """The answer of `solve` and of `Solver.solve`."""

    z: NDArray[np.float64]
    """(n,). Zero on the rows of a `Solver` that are not present."""
    w: NDArray[np.float64]
    """(n,), M z + q, on rows that are not present too."""
    status: str
    """"solved" (the residual is at most 1e-9), "no_solution" (`ray` proves it), "ray_termination"
    (Lemke's method ended on a ray that proves nothing), "pivot_limit" or "numerical_trouble"."""
    pivots: int
    """Major plus minor cycles (of "block" rows moved, of "lemke" exchanges)."""
    major_cycles: int
    minor_cycles: int
    residual: float
    """How far z and w are from complementary, in the problem's own scale: the largest
    `|min(z_i, w_i)|`, with M scaled to a unit diagonal, divided by the largest entry of the scaled
    z and q."""
    ray: NDArray[np.float64] | None
    """(n,). With "no_solution" a proof of it: ray >= 0, M' ray <= 0 and q' ray < 0 (of a `Solver`:
    on the rows present, and zero elsewhere). M' ray is rounding of M's last digits, at most 1e-12
    of the ray (M scaled to a unit diagonal); q' ray is at least 1e-7 of q and the ray."""
    rows: NDArray[np.int64]
    """Rows that were present, ascending: all n of them but for a `Solver`."""

    def __repr__(self) -> str:
        rows = f"{len(self.rows)} of {counted(len(self.z), 'row')}"
        work = f"{counted(self.pivots, 'pivot')}, residual {self.residual:.1e}"
        return f"<Solution: {self.status}, {rows}; {work}>"

    def restricted(self) -> Solution:
        """The solution of `M[rows][:, rows]`, `q[rows]`: the vectors on `rows` only."""
        ray = None if self.ray is None else self.ray[self.rows]
        z, w, rows = self.z[self.rows], self.w[self.rows], np.arange(self.rows.size)
        return replace(self, z=z, w=w, ray=ray, rows=rows)

    def start(self, indices: Sequence[int] | NDArray[np.int64]) -> Start:
        """This solution as a start for a larger problem, whose `indices` this problem has."""
        return Start(np.asarray(indices), self.z)

    def recheck(self, M: Matrix, q: ArrayLike) -> float:
        """The `residual`, computed again from `M`, `q` and z alone, on `rows`."""
        matrix: Any = M if is_sparse(M) else np.asarray(M, dtype=np.float64)
        diagonal = np.asarray(matrix.diagonal(), dtype=np.float64)
        unit = 1 / np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
        q = np.asarray(q, dtype=np.float64)
        z, w = self.z / unit, unit * (matrix @ self.z + q)
        z, w, q = z[self.rows], w[self.rows], (unit * q)[self.rows]
        worst = np.max(np.abs(np.minimum(z, w)), initial=0.0)
        scale = max(np.max(np.abs(q), initial=0.0), np.max(np.abs(z), initial=0.0))
        return float(worst / scale) if worst > 0 else 0.0


def solve(
    M: Matrix,
    q: ArrayLike,
    start: Start | None = None,
    method: str = "dantzig",
    pivot_limit: int | None = None,
) -> Solution:
    """Find z and w = M z + q with 0 <= z complementary to w >= 0.

    `M` is an (n, n) NumPy array or SciPy sparse matrix, `q` has length n. Methods:

    - "dantzig": principal pivoting, for symmetric positive semidefinite M, singular or not.
      With a `start` of k indices it takes at most n - k major cycles.
    - "block": block principal pivoting, for the same M: all infeasible rows are exchanged at once,
      and Dantzig's method finishes where that leads nowhere. A block exchange is a major cycle,
      every row that it moves a pivot.
    - "lemke": Lemke's method, also for M that is not symmetric. A `start` is its first basis.

    Raises LcpError for entries that are not finite, shapes that do not match, or an M that the
    method cannot take; StartError for a start that is not a solution of its sub-problem. A problem
    without a solution and a `pivot_limit` reached are statuses, not errors. An M written with few
    decimals may not be semidefinite any more: where that leaves no answer, the error names its
    least eigenvalue (M scaled to a unit diagonal).
    """
    if start is not None and not isinstance(start, Start):
        raise StartError(f"start must be an lcp.Start (see Solution.start), not {start!r:.60}")
    if method not in METHODS:
        raise LcpError(f"unknown method {method!r}: choose one of {', '.join(METHODS)}")
    _require_limit(pivot_limit)
    indptr, indices, data = by_columns(M, "M", LcpError, square=True).arrays
    core = _core.lcp_solve(
        indptr,
        indices,
        data,
        _vector(q, "q"),
        method,
        None if start is None else (start.indices, start.z),
        pivot_limit,
    )
    return _solution(core, np.arange(core.z.size))


class Counts(NamedTuple):
    """Work done by a `Solver` so far: exact, the same on every machine."""

    major_cycles: int
    minor_cycles: int
    pivots: int
    """Major plus minor cycles."""
    refactorisations: int
    """Times the factor was built again because updates had lost accuracy."""
    factor_rows: int
    """Rows put into the factor of the active block and taken out of it."""
    entries_solved: int
    """Stored numbers of the factor read by triangular solves."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Snapshot:
    """A state of a `Solver`: its rows, q and solution. Opaque; see `Solver.snapshot`."""

    _core: _core.LcpSnapshot

    def __repr__(self) -> str:
        return "<Snapshot of a Solver>"

    def __deepcopy__(self, memo: dict[int, Any]) -> Snapshot:
        """Nothing changes a state."""
        return self


class Solver:
    """A sequence of related problems: rows of a complete problem come and go, and q changes.

    `M` is the complete (n, n) matrix, a symmetric positive semidefinite NumPy array or SciPy sparse
    matrix, singular or not, and `q` has length n. No row is present at first. Every `solve` is for
    `M[rows][:, rows]`, `q[rows]` on the rows present. It starts from what the solver had, the
    active set and its factor, and gives the answer of a fresh solve: w is the same, and z where it
    is unique.

    >>> import numpy as np
    >>> from drystone import lcp
    >>> M = np.array([[2.0, 1.0, 0.0], [1.0, 2.0, 1.0], [0.0, 1.0, 2.0]])
    >>> solver = lcp.Solver(M, np.array([-5.0, -6.0, -4.0]))
    >>> solver.add_rows([0, 1])
    >>> solver.solve().z.round(6)
    array([1.333333, 2.333333, 0.      ])

    A state can be kept and gone back to. From there the third row takes one pivot:

    >>> state = solver.snapshot()
    >>> solver.add_rows([2])
    >>> whole = solver.solve()
    >>> whole.z.round(6), whole.pivots
    (array([1.75, 1.5 , 1.25]), 1)
    >>> solver.restore(state)
    >>> solver.rows, solver.solve().pivots
    (array([0, 1]), 0)

    `copy.copy`, `copy.deepcopy` and `pickle` make solvers of their own, with the active set and the
    factor as they are, so that they answer with the same numbers. States kept before are those of
    the copies too, but not of what was pickled.

    Raises LcpError for bad input, as `solve` does. One thread at a time may use a solver: BusyError
    otherwise, and nothing has changed then.
    """

    __slots__ = ("_core", "_n")

    def __init__(self, M: Matrix, q: ArrayLike, pivot_limit: int | None = None) -> None:
        _require_limit(pivot_limit)
        self._core = _core.LcpSolver(
            *by_columns(M, "M", LcpError, square=True).arrays, _vector(q, "q"), pivot_limit
        )
        self._n = len(self._core.q())

    @classmethod
    def from_generators(
        cls, G: Matrix, W: ArrayLike, h: ArrayLike, pivot_limit: int | None = None
    ) -> Self:
        """M = G' W G and q = -G' W h, without forming anything dense.

        `G` (rows, n) is a NumPy array or SciPy sparse matrix of generators; for contacts, the
        wrenches of unit forces on the bodies. `W` (rows,) is a diagonal of entries that are zero or
        more (inverse masses and inverse moments of inertia), `h` (rows,) the load to balance (the
        applied wrenches with the opposite sign).

        Of all z >= 0 the solution's G z is the nearest to h in the norm of W; w = 0 on every row if
        it reaches h.

        >>> G = np.array([[1.0, -1.0, 0.0], [0.0, 1.0, -1.0]])
        >>> solver = Solver.from_generators(G, [0.5, 0.25], [3.0, -1.0])
        >>> solver.add_rows([0, 1, 2])
        >>> (G @ solver.solve().z).round(6)
        array([ 3., -1.])
        """
        _require_limit(pivot_limit)
        columns = by_columns(G, "G", LcpError)
        W, h = _vector(W, "W"), _vector(h, "h")
        if not columns.shape[0] == W.size == h.size:
            raise LcpError(
                f"G has {columns.shape[0]} rows but W has {W.size} entries and h has {h.size}: "
                "give one of each for every row"
            )
        return cls._of(_core.LcpSolver.from_generators(*columns.arrays, W, h, pivot_limit))

    @classmethod
    def _of(cls, core: _core.LcpSolver) -> Self:
        solver = cls.__new__(cls)
        solver._core, solver._n = core, len(core.q())
        return solver

    @classmethod
    def _again(cls, state: bytes) -> Self:
        """What was pickled; LcpError for other bytes."""
        return cls._of(_core.LcpSolver.from_bytes(state))

    def __copy__(self) -> Self:
        return self._of(self._core.copy())

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self.__copy__()

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._again, (self._core.to_bytes(),)

    def __len__(self) -> int:
        """Rows of the complete problem, n."""
        return self._n

    def __repr__(self) -> str:
        return f"<Solver: {len(self._core.rows())} of {self._n} rows, {self.counts.pivots} pivots>"

    @property
    def rows(self) -> NDArray[np.int64]:
        """Rows that are present, ascending. Read-only: see `add_rows` and `remove_rows`."""
        return _read_only(np.array(self._core.rows(), dtype=np.int64))

    @property
    def q(self) -> NDArray[np.float64]:
        """(n,), as it is now. Read-only: change it with `set_q`."""
        return _read_only(np.array(self._core.q(), dtype=np.float64))

    @property
    def counts(self) -> Counts:
        """Work done since the solver was made; going back to a state does not take it back."""
        return Counts(*self._core.counts())

    def add_rows(self, rows: ArrayLike) -> None:
        """Add rows of the complete problem; those already present stay as they are."""
        self._core.add_rows(_indices(rows))

    def remove_rows(self, rows: ArrayLike) -> None:
        """Take rows out: their z becomes zero. Those that are not present stay so."""
        self._core.remove_rows(_indices(rows))

    def set_q(self, q: ArrayLike, rows: ArrayLike | None = None) -> None:
        """Replace q, or its entries on some `rows`, present or not."""
        if rows is None:
            self._core.set_q(_vector(q, "q"))
        else:
            self._core.set_q_at(_indices(rows), _vector(q, "q"))

    def solve(self) -> Solution:
        """Solve for the rows present. `pivots` and the like are those of this solve."""
        return _solution(self._core.solve(), self.rows)

    def snapshot(self) -> Snapshot:
        """The state, to come back to: rows, q and, after a solve, the solution."""
        return Snapshot(self._core.snapshot())

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to a snapshot of this solver; solving again takes no pivot if it was solved."""
        if not isinstance(snapshot, Snapshot):
            raise LcpError(f"restore takes a Snapshot of this solver, not {snapshot!r:.60}")
        self._core.restore(snapshot._core)


def _read_only(array: NDArray[Any]) -> NDArray[Any]:
    array.flags.writeable = False
    return array


def _solution(core: _core.LcpSolution, rows: NDArray[np.int64]) -> Solution:
    return Solution(
        core.z,
        core.w,
        core.status,
        core.pivots,
        core.major_cycles,
        core.minor_cycles,
        core.residual,
        core.ray,
        rows,
    )


def _require_limit(pivot_limit: int | None) -> None:
    if pivot_limit is not None and pivot_limit < 0:
        raise LcpError(f"pivot_limit is {pivot_limit}: it must be zero or more")


def _indices(rows: ArrayLike) -> NDArray[np.int64]:
    indices = np.asarray(rows)
    if indices.size and indices.dtype.kind not in "iu":
        raise LcpError(f"rows must be whole numbers, not {indices.dtype}")
    if indices.ndim != 1:
        raise LcpError(f"rows must be a vector, not of shape {indices.shape}")
    if np.any(indices < 0):
        raise LcpError(f"row {indices.min()} is negative")
    return np.ascontiguousarray(indices, dtype=np.int64)


def _vector(value: ArrayLike, what: str) -> NDArray[np.float64]:
    return vector(_floats(value, what), what, LcpError)


def _floats(value: ArrayLike, what: str) -> NDArray[np.float64]:
    """One number is an array of one."""
    return np.ascontiguousarray(floats(value, what, LcpError))
