"""Permanent loads in a picture: an arrow from where each acts, a turn and its size for a moment."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from drystone.pictures import style
from drystone.pictures.arrows import draw_arrows
from drystone.pictures.canvas import Canvas

if TYPE_CHECKING:
    from drystone.scene import Scene

Flat = Callable[[NDArray[np.float64]], NDArray[Any]]
"""Points or vectors of the world, (n, 2 or 3), on the picture, (n, 2)."""


def draw_loads(
    canvas: Canvas,
    scene: Scene,
    bodies: Collection[str],
    longest: float,
    flat: Flat = np.asarray,
    key_at: float = 0.75,
) -> None:
    """The loads on these bodies to scale, the longest of `longest` metres, with their key."""
    loads = [load for load in scene.loads if load.body in bodies]
    if not loads:
        return
    points = flat(np.array([load.at for load in loads]))
    vectors = flat(np.array([load.force for load in loads]))
    draw_arrows(canvas, points, vectors, longest, "N load", style.LOAD, key_at=key_at)
    for load, point in zip(loads, points, strict=True):
        size = float(np.linalg.norm(load.moment))
        if size > 0.0:
            clockwise = not isinstance(load.moment, tuple) and load.moment < 0.0
            text = f"{'↻' if clockwise else '↺'} {size:.3g} N m"
            canvas.axes.text(
                point[0], point[1], text, size=8, color=style.LOAD, va="bottom", clip_on=True
            )
