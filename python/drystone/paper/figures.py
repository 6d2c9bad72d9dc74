"""Figs. 5, 6 and 7 of the paper."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from drystone import _core, pictures, scenes
from drystone.paper.table import COLUMNS, Row
from drystone.pictures import style
from drystone.planning.search import plan

MARKS = {
    "lp": ("o", "#8a6d3b", "LP, cold (HiGHS)"),
    "lp-warm": ("s", "none", "LP, warm (HiGHS)"),
    "lcp": ("^", "#1f6fb2", "LCP"),
    "reuse-dantzig": ("v", "#7a4fa3", "LCP + reuse (the paper)"),
    "reuse": ("D", "#2c8a57", "reuse"),
}


def write_figures(rows: list[Row], folder: Path) -> list[Path]:
    """Write the three figures as SVG and PNG; the paths written, SVG only."""
    random = next(row for row in rows if row.example.name == "Random 84")
    figures = {
        "fig5_disassembly_graph": graph_of_five(),
        "fig6_pivots_by_size": pivots_by_size(random),
        "fig7_disassembly_order": pictures.plan_figure(random.plans["reuse"]),
    }
    written = []
    for name, figure in figures.items():
        for suffix in (".svg", ".png"):
            pictures.save(figure, folder / f"{name}{suffix}")
        written.append(folder / f"{name}.svg")
    return written


def graph_of_five() -> Figure:
    """Fig. 5: the disassembly graph of the five-block structure, with the order found."""
    scene = scenes.five_blocks()
    return pictures.graph_figure(
        scene, _core.disassembly_graph(scene._core), plan(scene, "reuse").order
    )


def pivots_by_size(row: Row) -> Figure:
    """Fig. 6: pivots of a single stability test, by the size of the sub-assembly tested."""
    figure = Figure(figsize=(6.4, 4.2), facecolor="white", layout="constrained")
    axes = figure.add_subplot()
    for test in COLUMNS:
        mark, colour, label = MARKS[test]
        records = row.plans[test].records
        # A test without pivots has no place on a logarithmic axis: it is drawn on its lower edge.
        axes.plot(
            [record.size for record in records],
            [max(record.pivots, 0.5) for record in records],
            mark,
            markersize=3.5 if colour != "none" else 6,
            markerfacecolor=colour,
            markeredgecolor="white" if colour != "none" else "#c99a2e",
            markeredgewidth=0.3 if colour != "none" else 0.9,
            label=label,
        )
    axes.set_yscale("log")
    axes.set_xlabel("blocks in the sub-assembly", color=style.INK)
    axes.set_ylabel("pivots of one stability test", color=style.INK)
    axes.set_title(
        f"{row.example.name}: pivots by size of the sub-assembly",
        loc="left",
        size=11,
        weight="bold",
        color=style.INK,
    )
    axes.grid(True, which="major", color="#e6e8ea", linewidth=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=8, loc="upper left", ncols=2)
    return figure
