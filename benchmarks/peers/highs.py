"""HiGHS: static equilibrium as a linear program, balance @ x = load with x >= 0.

Warm: one live model. A block put on brings its rows and columns, and the simplex method goes on
from the basis it has. When blocks are taken away, their rows and columns are deleted, and the
basis of the last sub-assembly that stood is put back as far as it is still there.
Cold: a new model for every question, with HiGHS's own choice of presolve and algorithm.

Timed: `Highs.run` alone.
"""

from __future__ import annotations

import time
from typing import ClassVar

import highspy
import numpy as np

from assembly import Assembly, Indices, rows_of
from drystone.statics import QuietHighs
from peers.base import Answer, Peer, Present
from steps import Step

STRATEGY = {"dual": 1, "primal": 4}
"""HiGHS's simplex_strategy."""

BASIC = highspy.HighsBasisStatus.kBasic
AT_ZERO = highspy.HighsBasisStatus.kLower


class WarmSession:
    """One live model, whose rows are those of `blocks` and whose columns are `columns`."""

    def __init__(self, assembly: Assembly, strategy: str, cap: float) -> None:
        self.present = Present(assembly)
        self.touching = assembly.touching()
        self.blocks: Indices = np.zeros(0, dtype=np.int64)
        self.columns: Indices = np.zeros(0, dtype=np.int64)
        self.place = np.zeros(len(assembly), dtype=np.int64)
        self.stood: tuple[Indices, Indices, highspy.HighsBasis] | None = None
        self.highs = new_model(cap)
        self.highs.setOptionValue("presolve", "off")
        self.highs.setOptionValue("solver", "simplex")
        self.highs.setOptionValue("simplex_strategy", STRATEGY[strategy])
        # Perturbed bounds cost the primal method what the kept basis has won: 452 iterations
        # instead of 180 on pyr13, 671 instead of 257 with friction .5.
        self.highs.setOptionValue("primal_simplex_bound_perturbation_multiplier", 0.0)

    def answer(self, step: Step) -> Answer:
        """Edit the model, then solve."""
        self.present.take(step)
        if step.removed:
            self._delete(step.removed)
            self._put_basis_back()
        for block in step.added:
            self._add(block)
        stands, seconds = solve(self.highs)
        residual = np.nan
        if stands:
            self.stood = (self.blocks, self.columns, self.highs.getBasis())
            residual = forces_residual(self.highs, self.present, self.columns)
        return Answer(stands, seconds, iterations(self.highs), residual)

    def _add(self, block: int) -> None:
        assembly = self.present.assembly
        self.place[block] = len(self.blocks)
        self.blocks = np.append(self.blocks, block)
        there = assembly.nobody()
        there[self.blocks] = True
        touching = self.touching[block]
        new = touching[there[assembly.bodies[touching]].all(axis=1)]
        add_rows(self.highs, assembly.load[3 * block : 3 * block + 3])
        add_columns(self.highs, assembly, new, self.place)
        self.columns = np.concatenate((self.columns, new))

    def _delete(self, removed: tuple[int, ...]) -> None:
        """Delete the rows and columns of some blocks, also of one that is put on again."""
        keep = self.present.mask.copy()
        keep[list(removed)] = False
        gone = np.flatnonzero(~keep[self.blocks])
        keeps = keep[self.present.assembly.bodies[self.columns]].all(axis=1)
        columns = np.flatnonzero(~keeps).astype(np.int32)
        self.highs.deleteCols(len(columns), columns)
        rows = rows_of(gone).astype(np.int32)
        self.highs.deleteRows(len(rows), rows)
        self.blocks, self.columns = np.delete(self.blocks, gone), self.columns[keeps]
        self.place[self.blocks] = np.arange(len(self.blocks))

    def _put_basis_back(self) -> None:
        if self.stood is None:
            self.highs.clearSolver()
            return
        blocks, columns, basis = self.stood
        if np.array_equal(blocks, self.blocks) and np.array_equal(columns, self.columns):
            self.highs.setBasis(basis)
            return
        # Rows and columns that the basis does not know start as HiGHS starts new ones. HiGHS
        # completes a basis that is called alien: what was deleted may leave it short or singular.
        columns_known = dict(zip(columns.tolist(), basis.col_status, strict=True))
        rows_known = dict(zip(rows_of(blocks).tolist(), basis.row_status, strict=True))
        patched = highspy.HighsBasis()
        patched.col_status = [
            columns_known.get(column, AT_ZERO) for column in self.columns.tolist()
        ]
        patched.row_status = [rows_known.get(row, BASIC) for row in rows_of(self.blocks).tolist()]
        patched.alien = True
        patched.valid = True
        self.highs.setBasis(patched)


class ColdSession:
    """A new model for every question."""

    def __init__(self, assembly: Assembly, cap: float) -> None:
        self.present = Present(assembly)
        self.highs = new_model(cap)

    def answer(self, step: Step) -> Answer:
        """Build the model, then solve."""
        self.present.take(step)
        generators = load_model(self.highs, self.present)
        stands, seconds = solve(self.highs)
        residual = forces_residual(self.highs, self.present, generators) if stands else np.nan
        return Answer(stands, seconds, iterations(self.highs), residual)


class Warm(Peer):
    """The live model with the simplex method of one strategy."""

    package = "highspy"
    strategy: ClassVar[str]

    def open(self, assembly: Assembly, cap: float) -> WarmSession:
        """See `Peer.open`."""
        return WarmSession(assembly, self.strategy, cap)


class WarmPrimal(Warm):
    """Primal simplex: a block added leaves the others' basis feasible."""

    name = "HiGHS warm primal"
    strategy = "primal"


class WarmDual(Warm):
    """Dual simplex: with no costs, every basis is dual feasible."""

    name = "HiGHS warm dual"
    strategy = "dual"


class Cold(Peer):
    """A new model for every question."""

    name = "HiGHS cold"
    package = "highspy"

    def open(self, assembly: Assembly, cap: float) -> ColdSession:
        """See `Peer.open`."""
        return ColdSession(assembly, cap)


def new_model(cap: float) -> highspy.Highs:
    """An empty model on one thread; `cap` bounds the seconds of all its solves together."""
    highs = QuietHighs()
    highs.setOptionValue("threads", 1)
    highs.setOptionValue("parallel", "off")
    if np.isfinite(cap):
        highs.setOptionValue("time_limit", cap)
    return highs


def load_model(highs: highspy.Highs, present: Present) -> Indices:
    """Replace the model by that of the blocks present; returns its generators."""
    assembly, rows, generators = present.assembly, present.rows, present.generators
    place = np.zeros(len(assembly), dtype=np.int64)
    place[rows[::3] // 3] = np.arange(len(rows) // 3)
    highs.clearModel()
    add_rows(highs, assembly.load[rows])
    add_columns(highs, assembly, generators, place)
    return generators


def add_rows(highs: highspy.Highs, right: np.ndarray) -> None:
    """Equality rows without entries."""
    none = np.zeros(0, dtype=np.int32)
    starts = np.zeros(len(right), dtype=np.int32)
    highs.addRows(len(right), right, right, 0, starts, none, np.zeros(0))


def add_columns(
    highs: highspy.Highs, assembly: Assembly, generators: Indices, place: Indices
) -> None:
    """Generators' columns; `place[body]` says where the body's rows are in the model."""
    count = len(generators)
    if not count:
        return
    columns = assembly.balance[:, generators]
    rows = (3 * place[columns.indices // 3] + columns.indices % 3).astype(np.int32)
    zero = np.zeros(count)
    infinite = np.full(count, highspy.kHighsInf)
    starts = columns.indptr[:-1].astype(np.int32)
    highs.addCols(count, zero, zero, infinite, len(rows), starts, rows, columns.data)


def solve(highs: highspy.Highs) -> tuple[bool | None, float]:
    """Solve: (stands, falls or no answer; seconds)."""
    begin = time.perf_counter()
    highs.run()
    seconds = time.perf_counter() - begin
    status = highs.getModelStatus()
    if status in (highspy.HighsModelStatus.kOptimal, highspy.HighsModelStatus.kModelEmpty):
        return True, seconds
    return (False if status == highspy.HighsModelStatus.kInfeasible else None), seconds


def iterations(highs: highspy.Highs) -> int:
    """Simplex iterations of the last solve."""
    return max(int(highs.getInfo().simplex_iteration_count), 0)


def forces_residual(highs: highspy.Highs, present: Present, generators: Indices) -> float:
    """Residual of the program's solution as contact forces."""
    x = np.asarray(highs.getSolution().col_value)
    return present.residual(generators, x * present.assembly.balance_scale[generators])
