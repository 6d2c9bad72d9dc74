"""The disassembly graph of a small scene: every sub-assembly, drawn where its size puts it."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

from drystone.common.text import shown
from drystone.pictures import style
from drystone.pictures.canvas import bounds
from drystone.scene import Body, Scene
from drystone.scene.body import planar

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

CELL = 1.0
"""A node's width and height; all else below is in this unit."""
GAP = (0.28, 0.75)
"""Space between nodes of a row, and between rows."""
INCHES = 0.8
"""A cell on paper."""

SubAssembly = tuple[Sequence[str], bool]
"""Names of the movable bodies present, and whether they stand."""


def graph_figure(scene: Scene, nodes: Sequence[SubAssembly], order: Sequence[str] = ()) -> Figure:
    """Nodes as pictures, framed green where they stand and red where they fall.

    An edge takes one block away; it is dark where both ends stand, and thick along `order`, the
    names of the blocks in the order of their removal.
    """
    rows = _rows(nodes)
    places = _places(rows)
    width = max(x for x, _ in places.values()) - min(x for x, _ in places.values()) + CELL
    margin = 0.2
    top = 1.5 * CELL - 0.3
    bottom = -(CELL + GAP[1]) * (len(rows) - 1) - CELL / 2 - margin
    figure = Figure(
        figsize=(INCHES * (width + 2 * margin), INCHES * (top - bottom)), facecolor="white"
    )
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_xlim(-width / 2 - margin, width / 2 + margin)
    axes.set_ylim(bottom, top)
    axes.set_axis_off()
    stands = {frozenset(names): stable for names, stable in nodes}
    _draw_edges(axes, places, stands, _path(order))
    shrink = _Shrink(planar(scene.bodies))
    for names, place in places.items():
        _draw_node(axes, shrink, names, stands[names], place)
    stable = sum(stands.values())
    axes.text(
        -width / 2,
        top - 0.3,
        f"{len(nodes)} sub-assemblies: {stable} stand, {len(nodes) - stable} fall",
        size=10,
        weight="bold",
        color=style.INK,
        va="center",
    )
    return figure


class _Shrink:
    """Maps the scene into a node's cell."""

    def __init__(self, bodies: Sequence[Body]) -> None:
        self.bodies = bodies
        movable = [body.vertices for body in bodies if not body.fixed]
        low, high = bounds(movable or [body.vertices for body in bodies])
        low = low - 0.08 * (high - low)  # a strip of ground
        self.low, self.high = low, high
        self.scale = 0.84 * CELL / float(np.max(high - low))

    def __call__(self, body: Body, place: tuple[float, float]) -> NDArray[np.float64]:
        corners = np.clip(body.vertices, self.low, self.high) if body.fixed else body.vertices
        middle = (self.low + self.high) / 2
        placed: NDArray[np.float64] = (corners - middle) * self.scale + np.asarray(place)
        return placed


def _rows(nodes: Sequence[SubAssembly]) -> list[list[frozenset[str]]]:
    """Sub-assemblies by size, the largest first, each row in the order given."""
    sizes = sorted({len(names) for names, _ in nodes}, reverse=True)
    return [[frozenset(names) for names, _ in nodes if len(names) == size] for size in sizes]


def _places(rows: Sequence[Sequence[frozenset[str]]]) -> dict[frozenset[str], tuple[float, float]]:
    """The middle of every node's cell, each row centred on x = 0."""
    return {
        names: (
            (column - (len(row) - 1) / 2) * (CELL + GAP[0]),
            -level * (CELL + GAP[1]),
        )
        for level, row in enumerate(rows)
        for column, names in enumerate(row)
    }


def _path(order: Sequence[str]) -> list[frozenset[str]]:
    """The sub-assemblies that removing blocks in this order leaves, the whole one included."""
    return [frozenset(order[taken:]) for taken in range(len(order) + 1)] if order else []


def _draw_edges(
    axes: Axes,
    places: dict[frozenset[str], tuple[float, float]],
    stands: dict[frozenset[str], bool],
    path: Sequence[frozenset[str]],
) -> None:
    on_path = set(itertools.pairwise(path))
    lines, colours, widths = [], [], []
    for upper, (x, y) in places.items():
        for name in sorted(upper):
            lower = upper - {name}
            if lower not in places:
                continue
            end_x, end_y = places[lower]
            lines.append([(x, y - CELL / 2), (end_x, end_y + CELL / 2)])
            both = stands[upper] and stands[lower]
            colours.append(style.STANDS if both else "#d5d8dc")
            widths.append(2.4 if (upper, lower) in on_path else 0.9 if both else 0.5)
    axes.add_collection(LineCollection(lines, colors=colours, linewidths=widths), autolim=False)


def _draw_node(
    axes: Axes,
    shrink: _Shrink,
    names: frozenset[str],
    stable: bool,
    place: tuple[float, float],
) -> None:
    colour = style.STANDS if stable else style.FALL
    axes.add_patch(
        FancyBboxPatch(
            (place[0] - CELL / 2, place[1] - CELL / 2),
            CELL,
            CELL,
            boxstyle="round,pad=0,rounding_size=0.06",
            facecolor="#f4faf6" if stable else "#fdf3f0",
            edgecolor=colour,
            linewidth=1.1,
            linestyle="solid" if stable else (0, (3, 2)),
            zorder=2,
        )
    )
    for group, fill, edge in (
        ([b for b in shrink.bodies if b.fixed], style.GROUND, style.HATCH),
        (
            [b for b in shrink.bodies if b.name in names],
            style.STONE if stable else style.FALLING,
            style.INK,
        ),
    ):
        axes.add_collection(
            PolyCollection(
                [shrink(body, place) for body in group],
                facecolors=fill,
                edgecolors=edge,
                linewidths=0.6,
                zorder=3,
            ),
            autolim=False,
        )
    for body in shrink.bodies:
        if body.name in names:
            x, y = shrink(body, place).mean(axis=0)
            axes.text(
                x,
                y,
                shown(body.name),
                size=5,
                parse_math=False,
                ha="center",
                va="center_baseline",
                color=style.INK,
                zorder=4,
            )
