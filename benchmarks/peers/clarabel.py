"""Clarabel, cold: the linear program of static equilibrium by an interior point method.

    balance @ x + 0 = load,    -x + s = 0,  s >= 0,  no cost

A new solver for every question. As with PIQP the quadratic programs were tried and are slower.

Timed: Clarabel's own clock, its set-up included, the conversion of the matrices left out.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from assembly import Assembly
from peers.base import Answer, Peer, Present
from steps import Step

TOLERANCE = 1e-9
"""Clarabel's tol_feas, tol_gap_abs and tol_gap_rel."""


class ColdSession:
    """A new solver for every question."""

    def __init__(self, assembly: Assembly, cap: float) -> None:
        import clarabel

        self.present = Present(assembly)
        self.settings = clarabel.DefaultSettings()
        self.settings.verbose = False
        self.settings.max_threads = 1
        self.settings.time_limit = cap
        self.settings.tol_feas = TOLERANCE
        self.settings.tol_gap_abs = self.settings.tol_gap_rel = TOLERANCE

    def answer(self, step: Step) -> Answer:
        """Set up and solve."""
        import clarabel

        self.present.take(step)
        assembly, rows, generators = (
            self.present.assembly,
            self.present.rows,
            self.present.generators,
        )
        count = len(generators)
        balance = assembly.balance[:, generators][rows]
        solver = clarabel.DefaultSolver(
            sp.csc_matrix((count, count)),
            np.zeros(count),
            sp.vstack((balance, -sp.identity(count)), format="csc"),
            np.concatenate((assembly.load[rows], np.zeros(count))),
            [clarabel.ZeroConeT(len(rows)), clarabel.NonnegativeConeT(count)],
            self.settings,
        )
        solution = solver.solve()
        if solution.status == clarabel.SolverStatus.Solved:
            forces = np.asarray(solution.x) * assembly.balance_scale[generators]
            residual = self.present.residual(generators, forces)
            return Answer(True, solution.solve_time, solution.iterations, residual)
        falls = solution.status == clarabel.SolverStatus.PrimalInfeasible
        return Answer(False if falls else None, solution.solve_time, solution.iterations)


class Cold(Peer):
    """Clarabel with a new solver for every question."""

    name = "Clarabel cold"
    package = "clarabel"

    def open(self, assembly: Assembly, cap: float) -> ColdSession:
        """See `Peer.open`."""
        return ColdSession(assembly, cap)
