"""Total time and memory by size, on logarithmic axes with fitted exponents."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from measure import Measured
from results import Case
from scenes import FAMILIES, FRICTIONS

MARKERS = "osD^v<>P"


def draw(cases: list[Case], path: Path) -> list[Path]:
    """One picture for each workload and quantity, as SVG and PNG; returns what was written.

    Without two sizes of any family there is nothing to draw.
    """
    measured = {case.row.scene for case in cases}
    if all(len(measured.intersection(scenes)) < 2 for scenes in FAMILIES.values()):
        return []
    quantities: dict[str, tuple[str, Callable[[Measured], float]]] = {
        "time": ("total time of the solver (s)", lambda r: r.seconds),
        "memory": ("peak memory (MB)", lambda r: r.memory),
    }
    written = []
    mpl.rcParams["svg.hashsalt"] = "drystone"
    for workload in dict.fromkeys(case.workload for case in cases):
        some = [case for case in cases if case.workload == workload]
        for quantity, (label, value) in quantities.items():
            if all(math.isnan(value(r)) for case in some for r in case.results.values()):
                continue
            figure = _figure(some, label, value)
            for ending, metadata in ((".svg", {"Date": None}), (".png", {})):
                target = path.with_name(f"{path.name}-{workload}-{quantity}{ending}")
                figure.savefig(target, metadata=metadata, dpi=120)
                written.append(target)
    return written


def _figure(cases: list[Case], label: str, value: Callable[[Measured], float]) -> Figure:
    figure = Figure(figsize=(5 * len(FAMILIES), 4.2 * len(FRICTIONS)), layout="constrained")
    axes = figure.subplots(len(FRICTIONS), len(FAMILIES), squeeze=False)
    for i, friction in enumerate(FRICTIONS):
        for j, (family, scenes) in enumerate(FAMILIES.items()):
            shown = [c for c in cases if c.row.scene in scenes and c.row.friction == friction]
            _panel(axes[i, j], shown, value)
            axes[i, j].set(title=f"{family}, friction {friction:g}", xlabel="blocks", ylabel=label)
    return figure


def _panel(axes: Axes, cases: list[Case], value: Callable[[Measured], float]) -> None:
    peers = list(dict.fromkeys(key for case in cases for key in case.results))
    for k, key in enumerate(peers):
        points = [(c.blocks, value(c.results[key]), c.results[key]) for c in cases]
        # A peer that was cut off or did not answer everything has no total to compare.
        points = [p for p in points if p[2].right and math.isfinite(p[1]) and p[1] > 0]
        if not points:
            continue
        x, y, results = zip(*points, strict=True)
        name = results[0].peer
        slope = exponent(x, y)
        if not math.isnan(slope):
            name += f" ~ n^{slope:.2f}"
        axes.plot(x, y, marker=MARKERS[k % len(MARKERS)], label=name)
    axes.set(xscale="log", yscale="log")
    if axes.lines:
        axes.legend(fontsize="small")


def exponent(x: tuple[float, ...], y: tuple[float, ...]) -> float:
    """Least squares slope of log y over log x, NaN for a single size."""
    if len(set(x)) < 2:
        return math.nan
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])
