"""Gauss's principle by public interior-point methods: how a structure begins to move, from nothing.

    min 1/2 u' u - target' u   over   J u >= 0  or  J u in second-order cones

u = M^1/2 a / c with a the accelerations; target = M^-1/2 F / c, c such that its largest is one.
Rows of J: those of G' M^-1/2 with norm one, one for each edge of a friction cone; or three for each
contact point, of which the largest has norm one. A structure stands if u = 0.

    .venv/bin/pip install piqp==0.7.0 clarabel==0.11.1
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

import drystone as ds
from drystone import _core

Floats = NDArray[np.float64]

TOLERANCE = 1e-9
"""Absolute, of residuals and gap, in the units above."""

AT_REST = 1e-4
"""A structure stands if none of u is above: the objective is strictly convex, and a gap of
`TOLERANCE` leaves an error of sqrt(2 TOLERANCE) = 4.5e-5."""


@dataclass(frozen=True, slots=True, eq=False)
class Gauss:
    """The problem above, with pyramids, and in space with round cones."""

    target: Floats
    """(components,)"""
    pyramids: sp.csc_matrix
    """(generators, components)"""
    round: sp.csc_matrix | None
    """(3 contact points, components); None in the plane, where both are the same."""
    unit: Floats
    """(components,), u times this is a, m/s^2 and 1/s^2."""

    @classmethod
    def of(cls, scene: ds.Scene) -> Gauss:
        """The problem of all movable bodies of `scene`."""
        g = _core.generators(scene._core)
        root = np.sqrt(g.inverse_mass)
        scale = float(np.max(np.abs(root * g.applied)))
        shape = (len(g.applied), len(g.indptr) - 1)
        G = sp.csc_matrix((g.data, g.indices.astype(np.int32), g.indptr), shape=shape)
        rows = sp.csr_matrix((sp.diags(root) @ G).T)
        cones = None
        if scene.dimension == 3:
            axes = sp.csr_matrix(_axes(g.contact) @ rows)
            largest = np.repeat(_norms(axes).reshape(-1, 3).max(axis=1), 3)
            cones = sp.csc_matrix(sp.diags(1 / largest) @ axes)
        return cls(
            target=root * g.applied / scale,
            pyramids=sp.csc_matrix(sp.diags(1 / _norms(rows)) @ rows),
            round=cones,
            unit=scale * root,
        )

    def stands(self, u: Floats) -> bool:
        """Whether nothing moves."""
        return float(np.abs(u).max()) <= AT_REST

    def fastest(self, u: Floats, dimension: int) -> float:
        """The largest acceleration of a centre of mass, m/s^2."""
        components = (self.unit * u).reshape(-1, 3 * (dimension - 1))
        return float(np.linalg.norm(components[:, :dimension], axis=1).max())


def _norms(rows: sp.csr_matrix) -> Floats:
    squares: Floats = np.asarray(rows.multiply(rows).sum(axis=1)).ravel()
    return np.sqrt(squares)


def _axes(contact: NDArray[np.int64]) -> sp.csr_matrix:
    """From the eight edges of a pyramid to the axis of the round cone and two radii at its base.

    x of these three is a force in Coulomb's cone if and only if |(x_1, x_2)| <= x_0.
    """
    points = contact.reshape(-1, 8)
    if (points != points[:, :1]).any():
        raise ValueError("a contact point without eight edges: give every body some friction")
    half = np.zeros((2, 8))
    half[0, [0, 4]] = half[1, [2, 6]] = 0.5, -0.5
    return sp.kron(sp.eye(len(points)), sp.csr_matrix(np.vstack([np.full(8, 1 / 8), half])))


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """What a peer says."""

    seconds: float
    """Of the set-up and the solution."""
    iterations: int
    u: Floats | None
    """None if it did not converge."""
    status: str


def by_piqp(gauss: Gauss) -> Solution:
    """PIQP on the pyramids: sparse, proximal, one thread."""
    import piqp

    J, m = gauss.pyramids, len(gauss.target)
    solver = piqp.SparseSolver()
    solver.settings.num_threads = 1
    solver.settings.eps_abs = TOLERANCE
    solver.settings.eps_rel = 0.0
    identity = sp.eye(m, format="csc")
    begun = time.perf_counter()
    solver.setup(identity, -gauss.target, G=J, h_l=np.zeros(J.shape[0]))
    status = solver.solve()
    seconds = time.perf_counter() - begun
    solved = status == piqp.PIQP_SOLVED
    u = np.array(solver.result.x) if solved else None
    return Solution(seconds, solver.result.info.iter, u, "" if solved else status.name)


def by_clarabel(gauss: Gauss) -> Solution:
    """Clarabel on the pyramids."""
    import clarabel

    return _by_clarabel(gauss, gauss.pyramids, [clarabel.NonnegativeConeT(gauss.pyramids.shape[0])])


def by_clarabel_round(gauss: Gauss) -> Solution:
    """Clarabel on the round cones."""
    import clarabel

    assert gauss.round is not None
    points = gauss.round.shape[0] // 3
    return _by_clarabel(gauss, gauss.round, [clarabel.SecondOrderConeT(3)] * points)


def _by_clarabel(gauss: Gauss, J: sp.csc_matrix, cones: list[object]) -> Solution:
    import clarabel

    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    settings.tol_gap_abs = settings.tol_feas = TOLERANCE
    settings.tol_gap_rel = 0.0
    identity, opposite = sp.eye(len(gauss.target), format="csc"), sp.csc_matrix(-J)
    nothing = np.zeros(J.shape[0])
    begun = time.perf_counter()
    solver = clarabel.DefaultSolver(identity, -gauss.target, opposite, nothing, cones, settings)
    found = solver.solve()
    seconds = time.perf_counter() - begun
    solved = found.status in (clarabel.SolverStatus.Solved, clarabel.SolverStatus.AlmostSolved)
    status = "" if found.status == clarabel.SolverStatus.Solved else str(found.status)
    return Solution(seconds, found.iterations, np.array(found.x) if solved else None, status)


@dataclass(frozen=True, slots=True)
class Peer:
    """A public solver on one kind of cones."""

    name: str
    package: str
    solve: Callable[[Gauss], Solution]
    round: bool = False
    """It takes Coulomb's cones: in space only."""

    def version(self) -> str | None:
        """Of its package; None if that is not installed."""
        try:
            return version(self.package)
        except PackageNotFoundError:
            return None


PEERS = (
    Peer("PIQP", "piqp", by_piqp),
    Peer("Clarabel", "clarabel", by_clarabel),
    Peer("Clarabel, round", "clarabel", by_clarabel_round, round=True),
)
