"""What bodies of the plane share where they overlap: red, with the depth written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.collections import PolyCollection

from drystone.pictures import style
from drystone.report.overlaps import MOST_LISTED
from drystone.scene import Overlap

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from drystone.pictures.canvas import Canvas
    from drystone.scene import Body


def draw_overlaps(canvas: Canvas, bodies: Sequence[Body], overlaps: Sequence[Overlap]) -> None:
    """What two bodies of the plane share, filled; beside the deepest their depth."""
    overlaps = sorted(overlaps, key=lambda pair: -pair.depth)
    corners: Mapping[str, NDArray[np.float64]] = {body.name: body.vertices for body in bodies}
    shared = [_common(corners[pair.a], corners[pair.b]) for pair in overlaps]
    canvas.axes.add_collection(
        PolyCollection(
            [polygon for polygon in shared if len(polygon) > 2],
            facecolors=style.FALL,
            edgecolors=style.FALL,
            linewidths=1.2,
            zorder=3,
        ),
        autolim=False,
    )
    for pair, polygon in zip(overlaps[:MOST_LISTED], shared, strict=False):
        if len(polygon) > 2:
            canvas.axes.annotate(
                f"{pair.depth:.3g} m",
                polygon.mean(axis=0),
                xytext=(6, 6),
                textcoords="offset points",
                size=8,
                weight="bold",
                color=style.FALL,
                bbox={"boxstyle": "round,pad=0.2", "fc": "white", "ec": style.FALL, "lw": 0.6},
                zorder=4,
            )


def _common(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """The polygon that two convex ones share (Sutherland and Hodgman): a, cut at each side of b."""
    rest = a
    for start, end in zip(b, np.roll(b, -1, axis=0), strict=True):
        side = end - start
        inside = side[0] * (rest[:, 1] - start[1]) - side[1] * (rest[:, 0] - start[0])
        kept: list[NDArray[np.float64]] = []
        for k in range(len(rest)):
            here, before = inside[k], inside[k - 1]
            if (here >= 0) != (before >= 0):
                kept.append(rest[k - 1] + before / (before - here) * (rest[k] - rest[k - 1]))
            if here >= 0:
                kept.append(rest[k])
        rest = np.array(kept).reshape(-1, 2)
    return rest
