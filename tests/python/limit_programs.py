"""Load factors by HiGHS, on the same cones: max and min of t with G f + F + t F1 = 0, f >= 0."""

from __future__ import annotations

import highspy
import numpy as np
from numpy.typing import NDArray

import drystone as ds
from drystone import _core
from drystone.statics import QuietHighs


def push_of(scene: ds.Scene, gravity: tuple[float, ...]) -> NDArray[np.float64]:
    """F1 of an acceleration of all blocks, in the rows of `_core.Generators`."""
    g = _core.generators(scene._core, None)
    rows = 3 if scene.dimension == 2 else 6
    pull = np.zeros(len(g.applied)).reshape(-1, rows)
    mass = 1.0 / g.inverse_mass.reshape(-1, rows)[:, 0]
    pull[:, : scene.dimension] = mass[:, None] * np.asarray(gravity)
    return pull.ravel()


def factors(
    scene: ds.Scene, push: NDArray[np.float64], cones: tuple[int, str] | None = None
) -> tuple[float, float]:
    """(least, greatest); infinite without a limit, (nan, nan) where no factor stands."""
    g = _core.generators(scene._core, cones)
    unit = np.abs(g.applied).max() or 1.0
    highs = QuietHighs()
    highs.setOptionValue("threads", 1)  # as everywhere: HiGHS has one pool for a process
    for option in ("primal_feasibility_tolerance", "dual_feasibility_tolerance"):
        highs.setOptionValue(option, 1e-9)
    none = np.zeros(0, dtype=np.int32)
    rows = len(g.applied)
    right = -g.applied / unit
    highs.addRows(rows, right, right, 0, np.zeros(rows, dtype=np.int32), none, np.zeros(0))
    columns = len(g.indptr) - 1
    infinite = np.full(columns, highspy.kHighsInf)
    highs.addCols(
        columns,
        np.zeros(columns),
        np.zeros(columns),
        infinite,
        len(g.data),
        g.indptr[:-1].astype(np.int32),
        g.indices.astype(np.int32),
        g.data,
    )
    at = np.flatnonzero(push).astype(np.int32)
    highs.addCol(0.0, -highspy.kHighsInf, highspy.kHighsInf, len(at), at, push[at] / unit)
    found = []
    for sign in (1.0, -1.0):
        highs.changeColCost(columns, sign)
        highs.run()
        status = highs.getModelStatus()
        if status == highspy.HighsModelStatus.kOptimal:
            found.append(highs.getSolution().col_value[columns])
        elif status == highspy.HighsModelStatus.kUnbounded:
            found.append(-sign * np.inf)
        elif status == highspy.HighsModelStatus.kInfeasible:
            return np.nan, np.nan
        else:
            highs.setOptionValue("presolve", "off")
            highs.run()
            status = highs.getModelStatus()
            highs.setOptionValue("presolve", "choose")
            unbounded = status == highspy.HighsModelStatus.kUnbounded
            found.append(-sign * np.inf if unbounded else np.nan)
    return found[0], found[1]
