"""Static equilibrium as a linear program, decided by HiGHS.

A sub-assembly stands if some f >= 0 has G f = -F: generator forces f (N) that balance the applied
wrench F of every body present. Only generators whose bodies are all present (or fixed) count.
Body i's three rows are divided by its mass and inertia, and all by the largest applied
acceleration, so that HiGHS's feasibility tolerance (1e-7) bounds accelerations relative to that of
gravity; each column is scaled to a largest entry of one.

These are the rivals that the contact problem is compared with: `ColdProgram` builds and solves a
fresh model for every test, as the paper did with lp_solve; `WarmProgram` keeps one model alive.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone import _core
from drystone.common.cones import CONES, FACETS
from drystone.common.errors import StaticsError
from drystone.common.extras import extra

with extra("lp", "stability tests by linear programs"):
    import highspy

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from drystone.scene import Scene

PRIMAL_SIMPLEX = 4
"""HiGHS's simplex_strategy for cold and warm starts alike."""


RESCUES: tuple[dict[str, str | int], ...] = (
    {"solver": "ipm", "presolve": "on"},
    {"solver": "simplex", "presolve": "on", "simplex_strategy": 1},
)
"""What is tried, in this order, where the primal simplex method ends without an answer: the
interior point method (which without presolve seldom proves a model infeasible), then the dual
simplex method."""


@dataclass(frozen=True, slots=True, eq=False)
class Columns:
    """Columns of a linear program in HiGHS's compressed form."""

    starts: NDArray[np.int32]
    rows: NDArray[np.int32]
    values: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.starts)


@dataclass(frozen=True, slots=True, eq=False)
class Equilibrium:
    """The scaled program of the complete assembly: rows per_body i + k of movable body i."""

    indptr: NDArray[np.int64]
    rows: NDArray[np.int64]
    values: NDArray[np.float64]
    right: NDArray[np.float64]
    """(per_body bodies,), the accelerations to balance."""
    bodies: NDArray[np.int64]
    """(generators, 2), -1 for a fixed body."""
    touching: tuple[NDArray[np.int64], ...]
    """For each body the generators that act on it."""
    per_body: int
    """Rows of a body: 3 in the plane, 6 in space."""

    @classmethod
    def of(cls, scene: Scene, cones: tuple[int, str] = (FACETS, CONES[0])) -> Equilibrium:
        """The program of all movable bodies of `scene`."""
        g = _core.generators(scene._core, cones)
        per_column = np.diff(g.indptr)
        values = g.data * g.inverse_mass[g.indices]
        largest = np.zeros(len(per_column))
        np.maximum.at(largest, np.repeat(np.arange(len(per_column)), per_column), np.abs(values))
        values /= np.repeat(largest, per_column)
        right = -g.applied * g.inverse_mass
        right /= np.max(np.abs(right), initial=0.0) or 1.0
        touching = _touching(g.bodies, len(g.names))
        per_body = 3 if scene.dimension == 2 else 6
        return cls(g.indptr, g.indices, values, right, g.bodies, touching, per_body)

    def columns(self, generators: NDArray[np.int64], place: NDArray[np.int64]) -> Columns:
        """Some generators' columns; `place[body]` is where the body's rows are in the model."""
        lengths = self.indptr[generators + 1] - self.indptr[generators]
        starts = np.concatenate(([0], np.cumsum(lengths)))
        entries = np.arange(starts[-1]) + np.repeat(self.indptr[generators] - starts[:-1], lengths)
        rows, n = self.rows[entries], self.per_body
        return Columns(
            starts[:-1].astype(np.int32),
            (n * place[rows // n] + rows % n).astype(np.int32),
            self.values[entries],
        )


def _touching(bodies: NDArray[np.int64], count: int) -> tuple[NDArray[np.int64], ...]:
    """For each of `count` bodies the rows of `bodies` that name it, in order."""
    named = bodies.ravel()
    order = np.argsort(named, kind="stable")
    ends = np.searchsorted(named[order], np.arange(count + 1))
    return tuple(order[ends[i] : ends[i + 1]] // bodies.shape[1] for i in range(count))


class ColdProgram:
    """The paper's baseline: a new model for every test, solved from nothing."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._program = equilibrium
        self._highs = _new_model()
        self.rescued = 0
        """Tests on which the primal simplex method gave no answer."""

    def __call__(self, bodies: list[int], added: int) -> tuple[bool, int]:
        """Whether the sub-assembly of these `bodies` stands, and the simplex iterations taken."""
        program = self._program
        self._highs.clearModel()
        # One place more than there are bodies: index -1, a fixed body, is always present.
        present = np.zeros(len(program.touching) + 1, dtype=bool)
        present[bodies] = present[-1] = True
        place = np.zeros(len(program.touching), dtype=np.int64)
        place[bodies] = np.arange(len(bodies))
        n = program.per_body
        rows = (n * np.asarray(bodies)[:, None] + np.arange(n)).ravel()
        _add_rows(self._highs, program.right[rows])
        generators = np.flatnonzero(present[program.bodies].all(axis=1))
        _add_columns(self._highs, program.columns(generators, place))
        stands, pivots, rescued = _decide(self._highs)
        self.rescued += rescued
        return stands, pivots


class WarmProgram:
    """One live model. A block added brings its rows and columns; the basis is kept.

    When the search backs up, the rows and columns of the blocks taken away are deleted, and the
    basis that decided the remaining sub-assembly is put back.
    """

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._program = equilibrium
        self._highs = _new_model()
        self.rescued = 0
        """Tests on which the primal simplex method gave no answer."""
        self._placed: list[_Placed] = []
        # As in ColdProgram: index -1, a fixed body, is always present.
        self._present = np.zeros(len(equilibrium.touching) + 1, dtype=bool)
        self._present[-1] = True
        self._place = np.zeros(len(equilibrium.touching), dtype=np.int64)

    def __call__(self, bodies: list[int], added: int) -> tuple[bool, int]:
        """Whether the sub-assembly of these `bodies` stands, and the simplex iterations taken."""
        if not self._grows_by(added, bodies):
            wanted = np.zeros(len(self._present), dtype=bool)
            wanted[bodies] = True
            wanted[added] = False  # it is placed last, so that the basis without it is kept
            self._back_up_to(wanted)
            for body in np.flatnonzero(wanted & ~self._present):
                self._add(int(body))
        self._add(added)
        stands, pivots, rescued = _decide(self._highs)
        self.rescued += rescued
        self._placed[-1].basis = self._highs.getBasis() if stands else None
        return stands, pivots

    def _grows_by(self, added: int, bodies: list[int]) -> bool:
        """Whether `bodies` are what is placed and `added`."""
        return (
            len(bodies) == len(self._placed) + 1
            and not self._present[added]
            and int(np.count_nonzero(self._present[bodies])) == len(self._placed)
        )

    def _add(self, body: int) -> None:
        program = self._program
        self._present[body] = True
        self._place[body] = len(self._placed)
        touching = program.touching[body]
        generators = touching[self._present[program.bodies[touching]].all(axis=1)]
        n = program.per_body
        _add_rows(self._highs, program.right[n * body : n * body + n])
        _add_columns(self._highs, program.columns(generators, self._place))
        self._placed.append(_Placed(body, len(generators)))

    def _back_up_to(self, wanted: NDArray[np.bool_]) -> None:
        """Delete the blocks placed last until all that remain are wanted."""
        keep = len(self._placed)
        for depth, placed in enumerate(self._placed):
            if not wanted[placed.body]:
                keep = depth
                break
        dropped = self._placed[keep:]
        if not dropped:
            return
        del self._placed[keep:]
        self._present[[placed.body for placed in dropped]] = False
        count = sum(placed.columns for placed in dropped)
        rows = self._program.per_body * len(dropped)
        _delete_last(self._highs, columns=count, rows=rows)
        if self._placed and self._placed[-1].basis is not None:
            self._highs.setBasis(self._placed[-1].basis)


@dataclass(slots=True)
class _Placed:
    """A block in the live model."""

    body: int
    columns: int
    basis: Any = None
    """HiGHS's basis when the sub-assembly up to this block was found to stand."""


class QuietHighs(highspy.Highs):
    """HiGHS that writes nothing to standard output: there is somebody's JSON.

    From 1.16 on its constructor sets the callbacks, and the first call that is not about options
    prints a banner. So the output is turned off just before.
    """

    def __init__(self) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self.setOptionValue("output_flag", False)

    def enableCallbacks(self) -> None:  # noqa: N802 (HiGHS names it)
        self.setOptionValue("output_flag", False)
        untyped: Any = super()
        untyped.enableCallbacks()


def _new_model() -> QuietHighs:
    highs = QuietHighs()
    highs.setOptionValue("threads", 1)
    highs.setOptionValue("presolve", "off")
    highs.setOptionValue("solver", "simplex")
    highs.setOptionValue("simplex_strategy", PRIMAL_SIMPLEX)
    return highs


def _add_rows(highs: highspy.Highs, right: NDArray[np.float64]) -> None:
    none = np.zeros(0, dtype=np.int32)
    highs.addRows(
        len(right), right, right, 0, np.zeros(len(right), dtype=np.int32), none, np.zeros(0)
    )


def _add_columns(highs: highspy.Highs, columns: Columns) -> None:
    n = len(columns)
    if n:
        infinite = np.full(n, highspy.kHighsInf)
        zero = np.zeros(n)
        highs.addCols(
            n, zero, zero, infinite, len(columns.rows), columns.starts, columns.rows, columns.values
        )


def _delete_last(highs: highspy.Highs, columns: int, rows: int) -> None:
    first = highs.getNumCol() - columns
    highs.deleteCols(columns, np.arange(first, first + columns, dtype=np.int32))
    first = highs.getNumRow() - rows
    highs.deleteRows(rows, np.arange(first, first + rows, dtype=np.int32))


def _decide(highs: highspy.Highs) -> tuple[bool, int, bool]:
    """Whether it stands, the simplex iterations, and whether the answer had to be had otherwise.

    The primal simplex method may end without an answer.
    """
    if highs.getNumCol() == 0:
        # HiGHS calls a model without columns empty, whatever its rows demand.
        return not np.any(highs.getLp().row_lower_), 0, False
    highs.run()
    stands = _answer(highs)
    pivots = max(int(highs.getInfo().simplex_iteration_count), 0)
    return (_rescued(highs), pivots, True) if stands is None else (stands, pivots, False)


def _rescued(highs: highspy.Highs) -> bool:
    """The answer of the first of `RESCUES` that has one. StaticsError if none does."""
    for options in RESCUES:
        other = _new_model()
        other.passModel(highs.getLp())
        for option, value in options.items():
            other.setOptionValue(option, value)
        other.run()
        stands = _answer(other)
        if stands is not None:
            return stands
    raise StaticsError(
        "HiGHS decided a stability test by none of its methods; the primal simplex method ended "
        f"with {highs.modelStatusToString(highs.getModelStatus())!r}"
    )


def _answer(highs: highspy.Highs) -> bool | None:
    """Feasible, infeasible, or no answer."""
    status = highs.getModelStatus()
    if status == highspy.HighsModelStatus.kOptimal:
        return True
    if status == highspy.HighsModelStatus.kInfeasible:
        return False
    return None
