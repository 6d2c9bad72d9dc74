"""Bodies on a canvas: filled polygons, labels that fit, hatched ground."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb

from drystone.common.text import shown
from drystone.pictures import style
from drystone.pictures.canvas import Canvas, Outlined


def draw_fixed(canvas: Canvas, bodies: Sequence[Outlined]) -> None:
    """The fixed bodies, hatched grey."""
    fixed = [body.vertices for body in bodies if body.fixed]
    canvas.axes.add_collection(
        PolyCollection(
            fixed, facecolors=style.GROUND, edgecolors=style.HATCH, hatch="////", linewidths=0.6
        ),
        autolim=False,
    )


def draw_blocks(
    canvas: Canvas,
    bodies: Sequence[Outlined],
    fills: Mapping[str, str],
    edges: Mapping[str, str] | None = None,
) -> None:
    """The bodies that `fills` names, in its colours, outlined in ink or in those of `edges`."""
    drawn = [body for body in bodies if body.name in fills]
    canvas.axes.add_collection(
        PolyCollection(
            [body.vertices for body in drawn],
            facecolors=[fills[body.name] for body in drawn],
            edgecolors=[(edges or {}).get(body.name, style.INK) for body in drawn],
            linewidths=line_width(canvas, drawn),
            joinstyle="round",
        ),
        autolim=False,
    )


def draw_held(canvas: Canvas, bodies: Sequence[Outlined]) -> None:
    """A hatch over blocks that are held."""
    canvas.axes.add_collection(
        PolyCollection(
            [body.vertices for body in bodies],
            facecolors="none",
            edgecolors=style.HELD,
            hatch="\\\\\\\\",
            linewidths=0.9,
        ),
        autolim=False,
    )


def draw_absent(canvas: Canvas, bodies: Sequence[Outlined]) -> None:
    """The dotted outlines of bodies that are not there."""
    canvas.axes.add_collection(
        PolyCollection(
            [body.vertices for body in bodies],
            facecolors="none",
            edgecolors=style.FAINT,
            linestyles="dotted",
            linewidths=0.6,
        ),
        autolim=False,
    )


def draw_labels(
    canvas: Canvas, bodies: Sequence[Outlined], labels: Mapping[str, str], fills: Mapping[str, str]
) -> None:
    """A label on every body that `labels` names, in one size; none if they would be too small."""
    drawn = [body for body in bodies if body.name in labels]
    if not drawn:
        return
    labels = {name: shown(label) for name, label in labels.items()}
    # One small block should not cost all others their label: the size suits nine tenths of them.
    fits = [_fitting_size(canvas, body, labels[body.name]) for body in drawn]
    size = min(float(np.quantile(fits, 0.1)), 10.0)
    if size < style.SMALLEST_TEXT:
        return
    for body, fit in zip(drawn, fits, strict=True):
        if fit >= style.SMALLEST_TEXT:
            canvas.axes.text(
                *body.centroid,
                labels[body.name],
                size=min(size, fit),
                color=_contrasting(fills[body.name]),
                ha="center",
                va="center_baseline",
                clip_on=True,
                parse_math=False,
            )


def typical_size(bodies: Sequence[Outlined]) -> float:
    """The median over bodies of the square root of the area of the bounding box, metres."""
    sides = [np.ptp(body.vertices, axis=0) for body in bodies]
    return float(np.median([np.sqrt(side[0] * side[1]) for side in sides])) if sides else 1.0


def line_width(canvas: Canvas, bodies: Sequence[Outlined]) -> float:
    """Points: thinner where bodies are small."""
    return float(np.clip(0.04 * typical_size(bodies) * canvas.points_per_metre, 0.15, 1.0))


def _fitting_size(canvas: Canvas, body: Outlined, label: str) -> float:
    """Points of text that fill about half of the body."""
    width, height = np.ptp(body.vertices, axis=0) * canvas.points_per_metre
    return float(min(0.6 * height, 0.8 * width / (0.6 * max(len(label), 1))))


def _contrasting(colour: str) -> str:
    """Dark or white text, whichever reads better on `colour`."""
    red, green, blue = to_rgb(colour)
    return style.INK if 0.3 * red + 0.59 * green + 0.11 * blue > 0.5 else "white"
