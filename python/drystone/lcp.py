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
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone import _core
from drystone._core import LcpError, StartError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["METHODS", "LcpError", "Solution", "Start", "StartError", "solve"]

METHODS = ("dantzig", "lemke")
"""The methods `solve` knows: see there."""


@dataclass(frozen=True, slots=True, eq=False)
class Start:
    """The solution of a sub-problem, as a start for a larger one.

    The sub-problem is M[indices][:, indices], q[indices] of the larger problem, and `z` its
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


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """The answer of `solve`."""

    z: NDArray[np.float64]
    """(n,)"""
    w: NDArray[np.float64]
    """(n,), M z + q."""
    status: str
    """"solved" (the residual is at most 1e-9), "no_solution" (`ray` proves it), "ray_termination"
    (Lemke's method ended on a ray that proves nothing), "pivot_limit" or "numerical_trouble"."""
    pivots: int
    """Major plus minor cycles."""
    major_cycles: int
    minor_cycles: int
    residual: float
    """The largest |min(z_i, w_i)| with M scaled to a unit diagonal, over the largest entry of the
    scaled z and q."""
    ray: NDArray[np.float64] | None
    """(n,). With "no_solution" a proof of it: ray >= 0, M' ray <= 0 and q' ray < 0."""

    def start(self, indices: Sequence[int] | NDArray[np.int64]) -> Start:
        """This solution as a start for a larger problem, whose `indices` this problem has."""
        return Start(np.asarray(indices), self.z)

    def recheck(self, M: Any, q: ArrayLike) -> float:
        """The `residual`, computed again from `M`, `q` and z alone."""
        diagonal = np.asarray(M.diagonal(), dtype=np.float64)
        unit = 1 / np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
        q = np.asarray(q, dtype=np.float64)
        z, w = self.z / unit, unit * (M @ self.z + q)
        worst = np.max(np.abs(np.minimum(z, w)), initial=0.0)
        scale = max(np.max(np.abs(unit * q), initial=0.0), np.max(np.abs(z), initial=0.0))
        return float(worst / scale) if worst > 0 else 0.0


def solve(
    M: Any,
    q: ArrayLike,
    start: Start | None = None,
    method: str = "dantzig",
    pivot_limit: int | None = None,
) -> Solution:
    """Find z and w = M z + q with 0 <= z complementary to w >= 0.

    `M` is an (n, n) NumPy array or SciPy sparse matrix, `q` has length n. Methods:

    - "dantzig": principal pivoting, for symmetric positive semidefinite M, singular or not.
      With a `start` of k indices it takes at most n - k major cycles.
    - "lemke": Lemke's method, also for M that is not symmetric; takes no `start`.

    Raises LcpError for entries that are not finite, shapes that do not match, or an M that the
    method cannot take; StartError for a start that is not a solution of its sub-problem. A problem
    without a solution and a `pivot_limit` reached are statuses, not errors.
    """
    if start is not None and not isinstance(start, Start):
        raise StartError(f"start must be an lcp.Start (see Solution.start), not {start!r:.60}")
    if method not in METHODS:
        raise LcpError(f"unknown method {method!r}: choose one of {', '.join(METHODS)}")
    if pivot_limit is not None and pivot_limit < 0:
        raise LcpError(f"pivot_limit is {pivot_limit}: it must be zero or more")
    indptr, indices, data = _compressed_columns(M)
    core = _core.lcp_solve(
        indptr,
        indices,
        data,
        _vector(q, "q"),
        method,
        None if start is None else (start.indices, start.z),
        pivot_limit,
    )
    return Solution(
        core.z,
        core.w,
        core.status,
        core.pivots,
        core.major_cycles,
        core.minor_cycles,
        core.residual,
        core.ray,
    )


def _compressed_columns(
    M: Any,
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """(indptr, indices, data) of a square matrix: rows in order and without repetition."""
    from scipy import sparse

    if not sparse.issparse(M):
        M = _floats(M, "M")
    if M.ndim != 2 or M.shape[0] != M.shape[1]:
        raise LcpError(f"M must be a square matrix, not of shape {M.shape}")
    if M.dtype.kind not in "fiub":
        raise LcpError(f"M must hold real numbers, not {M.dtype}")
    columns = sparse.csc_array(M, dtype=np.float64, copy=True)
    columns.sum_duplicates()
    return columns.indptr.astype(np.int64), columns.indices.astype(np.int64), columns.data


def _vector(value: ArrayLike, what: str) -> NDArray[np.float64]:
    vector = _floats(value, what)
    if vector.ndim != 1:
        raise LcpError(f"{what} must be a vector, not of shape {vector.shape}")
    return vector


def _floats(value: ArrayLike, what: str) -> NDArray[np.float64]:
    if np.iscomplexobj(value):
        raise LcpError(f"{what} must hold real numbers, not complex ones")
    try:
        return np.ascontiguousarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise LcpError(f"{what} must hold real numbers, not {value!r:.60}") from None
