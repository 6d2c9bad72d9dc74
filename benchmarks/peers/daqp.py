"""DAQP, hot: Gauss's principle in one live workspace.

    minimise |u - target|^2 / 2    with    normals @ u >= 0

DAQP is a dual active-set method: it moves from one active set to the next by updating an LDL^T
factor of the active block of G' M^-1 G, so its multipliers solve our contact problem. The
workspace holds the complete assembly; contacts of absent blocks have no bound, and the active set
and its factor carry over from question to question. A new workspace of each sub-assembly's own size
is no way out: its set-up alone, which transforms a dense matrix, took 4 times as long on col80.

Timed: `solve_time`, DAQP's own clock. Changing the bounds is left out.
"""

from __future__ import annotations

import numpy as np

from assembly import Assembly
from peers.base import Answer, Peer, Present
from steps import Step, Workload

MOST_ENTRIES = 30_000_000
"""Of the dense matrix (240 MB). DAQP holds two of that size and a set-up of work entries * rows."""

PRIMAL_TOLERANCE = 1e-9
"""Bounds accelerations relative to g along unit rows: the accuracy that is asked of everybody. The
default, 1e-6, takes the same iterations on the column and the pyramid."""

AT_REST = 1e-6
"""Accelerations below this, relative to g, count as none: 1000 times the solver's tolerance, and
the least that its default tolerance would resolve."""

UNBOUNDED = 1e30
"""DAQP's infinity."""


class HotSession:
    """One workspace of the complete assembly."""

    def __init__(self, assembly: Assembly) -> None:
        import daqp

        self.present = Present(assembly)
        count, size = assembly.normals.shape
        self.upper = np.full(count, UNBOUNDED)
        self.model = daqp.Model()
        flag, _ = self.model.setup(
            np.eye(size),
            -assembly.target,
            assembly.normals.toarray(),
            self.upper,
            np.full(count, -UNBOUNDED),
            np.zeros(count, dtype=np.int32),
        )
        if flag < 0:
            raise RuntimeError(f"DAQP's set-up failed with exit flag {flag}")
        self.model.settings = {"primal_tol": PRIMAL_TOLERANCE}

    def answer(self, step: Step) -> Answer:
        """Bound the contacts present, then solve."""
        self.present.take(step)
        assembly, generators = self.present.assembly, self.present.generators
        lower = np.full(len(self.upper), -UNBOUNDED)
        lower[generators] = 0.0
        self.model.update(bupper=self.upper, blower=lower)
        u, _, flag, info = self.model.solve()
        if flag != 1:
            return Answer(None, info["solve_time"], info["iterations"])
        stands = bool(np.max(np.abs(u[self.present.rows]), initial=0.0) <= AT_REST)
        residual = np.nan
        if stands:
            forces = -info["lam"][generators] * assembly.normals_scale[generators]
            residual = self.present.residual(generators, forces)
        return Answer(stands, info["solve_time"], info["iterations"], residual)


class Hot(Peer):
    """DAQP on one live workspace."""

    name = "DAQP hot"
    package = "daqp"

    def refuses(self, assembly: Assembly, workload: Workload) -> str:
        """Dense matrices beyond what fits in time and memory."""
        count, size = assembly.normals.shape
        if count * size > MOST_ENTRIES:
            return f"dense {count} x {size}: {8e-9 * count * size:.1f} GB each of two matrices"
        return ""

    def open(self, assembly: Assembly, cap: float) -> HotSession:
        """See `Peer.open`."""
        return HotSession(assembly)
