"""Vectors drawn to scale, with a key that says the scale."""

from __future__ import annotations

import numpy as np
from matplotlib.patches import FancyArrow
from numpy.typing import NDArray

from drystone.common.units import quantity, round_number
from drystone.pictures import style
from drystone.pictures.canvas import Canvas

NEGLIGIBLE = 1e-6
"""Vectors shorter than this fraction of the longest are not drawn."""


def draw_arrows(
    canvas: Canvas,
    tails: NDArray[np.float64],
    vectors: NDArray[np.float64],
    longest: float,
    unit: str,
    colour: str,
    key_at: float = 0.0,
) -> None:
    """Arrows from `tails` (n, 2), the longest of `longest` metres; the key's unit is `unit`.

    `key_at` is where the key is below the drawing, as a fraction of its width.
    """
    lengths = np.hypot(*vectors.T) if len(vectors) else np.zeros(0)
    peak = float(np.max(lengths, initial=0.0))
    if peak == 0.0:
        return
    metres = longest / peak
    for tail, vector, length in zip(tails, vectors * metres, lengths, strict=True):
        if length > NEGLIGIBLE * peak:
            _arrow(canvas, tail, vector, colour)
    _draw_key(canvas, metres, round_number(peak), unit, colour, key_at)


def draw_directions(
    canvas: Canvas,
    tails: NDArray[np.float64],
    directions: NDArray[np.float64],
    lengths: NDArray[np.float64],
    colour: str,
) -> None:
    """Arrows that say whereto, not how much: unit vectors (n, 2), each of its length (n,)."""
    for tail, vector in zip(tails, directions * lengths[:, None], strict=True):
        _arrow(canvas, tail, vector, colour)


def _arrow(
    canvas: Canvas, tail: NDArray[np.float64], vector: NDArray[np.float64], colour: str
) -> None:
    length = float(np.hypot(*vector))
    # Line widths in metres, so that heads and shafts scale together; never thinner than 0.5 pt.
    shaft = max(0.008 * canvas.diagonal * min(1.0, length / (0.05 * canvas.diagonal)), 0.0)
    shaft = float(np.clip(shaft, 0.5 / canvas.points_per_metre, 2.0 / canvas.points_per_metre))
    head = min(4.0 * shaft, 0.5 * length)
    canvas.axes.add_patch(
        FancyArrow(
            tail[0],
            tail[1],
            vector[0],
            vector[1],
            width=shaft,
            head_width=max(3.2 * shaft, 0.75 * head),
            head_length=head,
            length_includes_head=True,
            facecolor=colour,
            edgecolor="white",
            linewidth=0.3,
            zorder=5,
        )
    )


def _draw_key(
    canvas: Canvas, metres: float, value: float, unit: str, colour: str, key_at: float
) -> None:
    """An arrow of a round value below the drawing, with its value."""
    left, bottom, right, _ = canvas.box
    drop = 16 / canvas.points_per_metre
    start = np.array([left + key_at * (right - left), bottom - drop])
    before = len(canvas.axes.patches)
    _arrow(canvas, start, np.array([value * metres, 0.0]), colour)
    for patch in list(canvas.axes.patches)[before:]:
        patch.set_clip_on(False)
    canvas.axes.text(
        start[0] + value * metres + 4 / canvas.points_per_metre,
        start[1],
        quantity(value, unit) if unit == "N" else f"{value:g} {unit}",
        size=8,
        color=style.INK,
        va="center",
        clip_on=False,
    )
