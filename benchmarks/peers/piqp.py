"""PIQP, cold: the linear program of static equilibrium by a sparse proximal interior point method.

    balance @ x = load,  x >= 0,  no cost

A new solver for every question. The quadratic programs (Gauss's principle, and least squares with
x >= 0) were tried: from 1.1 times faster to 1.7 times slower, and on the pyramid, whose forces are
not unique, they stop at accelerations of 3e-5 g where this stops below 1e-10.

Timed: PIQP's own clock, its set-up included.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from assembly import Assembly
from peers.base import Answer, Peer, Present
from steps import Step

TOLERANCE = 1e-9
"""Absolute, on rows in units of g."""


class ColdSession:
    """A new solver for every question."""

    def __init__(self, assembly: Assembly) -> None:
        self.present = Present(assembly)

    def answer(self, step: Step) -> Answer:
        """Set up and solve."""
        import piqp

        self.present.take(step)
        assembly, rows, generators = (
            self.present.assembly,
            self.present.rows,
            self.present.generators,
        )
        count = len(generators)
        solver = piqp.SparseSolver()
        solver.settings.verbose = False
        solver.settings.num_threads = 1
        solver.settings.compute_timings = True
        solver.settings.eps_abs = TOLERANCE
        solver.settings.eps_rel = 0.0
        solver.setup(
            sp.csc_matrix((count, count)),
            np.zeros(count),
            assembly.balance[:, generators][rows].tocsc(),
            assembly.load[rows],
            x_l=np.zeros(count),
            x_u=np.full(count, np.inf),
        )
        status = solver.solve()
        info = solver.result.info
        seconds = info.setup_time + info.solve_time
        if status == piqp.PIQP_SOLVED:
            forces = solver.result.x * assembly.balance_scale[generators]
            return Answer(True, seconds, info.iter, self.present.residual(generators, forces))
        return Answer(False if status == piqp.PIQP_PRIMAL_INFEASIBLE else None, seconds, info.iter)


class Cold(Peer):
    """PIQP with a new solver for every question."""

    name = "PIQP cold"
    package = "piqp"

    def open(self, assembly: Assembly, cap: float) -> ColdSession:
        """See `Peer.open`."""
        return ColdSession(assembly)
