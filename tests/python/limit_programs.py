"""Load factors by HiGHS, on the same cones: max and min of t with G f + F + t F1 = 0, f >= 0."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import Any

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


def balance(g: _core.Generators, right: NDArray[np.float64]) -> QuietHighs:
    """The program of forces along the generators, none below 0, whose wrenches are `right`; no
    cost. To 1e-9."""
    highs = QuietHighs()
    highs.setOptionValue("threads", 1)  # as everywhere: HiGHS has one pool for a process
    for option in ("primal_feasibility_tolerance", "dual_feasibility_tolerance"):
        highs.setOptionValue(option, 1e-9)
    rows, columns = len(right), len(g.indptr) - 1
    none, starts = np.zeros(0, dtype=np.int32), np.zeros(rows, dtype=np.int32)
    highs.addRows(rows, right, right, 0, starts, none, np.zeros(0))
    zero, infinite = np.zeros(columns), np.full(columns, highspy.kHighsInf)
    where = (g.indptr[:-1].astype(np.int32), g.indices.astype(np.int32))
    highs.addCols(columns, zero, zero, infinite, len(g.data), *where, g.data)
    return highs


def case_of(scene: ds.Scene, loads: Sequence[Any], factors: Sequence[float]) -> ds.Scene:
    """The scene with some loads of `load_cases`, each times a factor."""
    case = copy.copy(scene)
    for load, factor in zip(loads, factors, strict=True):
        if isinstance(load, dict):
            for name, force in load.items():
                case.add_load(name, tuple(factor * np.asarray(force)))
        else:
            for body in scene.bodies:
                force = factor * body.mass * np.asarray(load)
                case.add_load(body.name, tuple(force), at=body.center_of_mass)
    return case


class Standing:
    """Whether a planar structure stands under gravity in some direction: phase one of HiGHS on the
    same cones, kept from one direction to the next."""

    def __init__(self, scene: ds.Scene) -> None:
        g = _core.generators(scene._core, None)
        self._mass = 1.0 / g.inverse_mass.reshape(-1, 3)[:, 0]
        self._rows = np.arange(len(g.applied), dtype=np.int32)
        self._highs = balance(g, np.zeros(len(g.applied)))

    def stands(self, gravity: tuple[float, float]) -> bool:
        """Under gravity alone, m/s^2."""
        load = np.zeros((len(self._mass), 3))
        load[:, :2] = self._mass[:, None] * np.asarray(gravity)
        right = -load.ravel() / np.abs(load).max()
        self._highs.changeRowsBounds(len(right), self._rows, right, right)
        known = (highspy.HighsModelStatus.kOptimal, highspy.HighsModelStatus.kInfeasible)
        for presolve in ("choose", "off", "on"):  # it does not always come to an end
            self._highs.setOptionValue("presolve", presolve)
            self._highs.run()
            status = self._highs.getModelStatus()
            if status in known:
                break
            self._highs.clearSolver()
        self._highs.setOptionValue("presolve", "choose")
        assert status in known, status
        return bool(status == known[0])


def factors(
    scene: ds.Scene, push: NDArray[np.float64], cones: tuple[int, str] | None = None
) -> tuple[float, float]:
    """(least, greatest); infinite without a limit, (nan, nan) where no factor stands."""
    g = _core.generators(scene._core, cones)
    unit = np.abs(g.applied).max() or 1.0
    columns = len(g.indptr) - 1
    highs = balance(g, -g.applied / unit)
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
