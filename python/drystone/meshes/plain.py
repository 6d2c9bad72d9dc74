"""Meshes of few corners that are convex as they stand: nothing to mend, to make plane or to cut.

They are what assemblies are mostly made of, and what all the steps of `part.py` leave as it is, but
for the order of corners. So they are looked for first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

MOST_CORNERS = 64
"""Heights of all corners above all faces are looked at, which is quick for a few of them."""

PLANE = 1e-13
"""Corners within this share of the diagonal of a face's plane are in it: rounding."""

APART = 0.03
"""Others are below it by at least this share: beyond all that counts as inexact numbers (at most
`COARSEST` of `rounding.py`), and beyond all lengths within which corners or planes are one."""

WIDE = 1e-3
"""Twice the area of every triangle, as a share of the diagonal squared: its normal has digits."""


def plain_volume(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> float | None:
    """The volume of a convex mesh whose vertices (k, 3) are its corners, its faces exactly plane,
    its triangles (n, 3) counter-clockwise from outside; None of any other, or if that is not plain.
    """
    count = len(vertices)
    if not 4 <= count <= MOST_CORNERS or len(triangles) != 2 * count - 4:  # Euler, of a sphere
        return None
    if triangles.min() < 0 or triangles.max() >= count or not np.isfinite(vertices).all():
        return None
    if not _closed(triangles, count):
        return None
    points = vertices - vertices.mean(axis=0)
    span = points.max(axis=0) - points.min(axis=0)
    diagonal = float(np.sqrt(span @ span))
    firsts = points[triangles[:, 0]]
    one, two = points[triangles[:, 1]] - firsts, points[triangles[:, 2]] - firsts
    crosses = one[:, NEXT] * two[:, AFTER] - one[:, AFTER] * two[:, NEXT]
    doubled = np.sqrt((crosses * crosses).sum(axis=1))
    if not doubled.min() > WIDE * diagonal * diagonal:
        return None
    normals = crosses / doubled[:, None]
    heights = normals @ points.T - (normals * firsts).sum(axis=1)[:, None]
    on = heights >= -PLANE * diagonal
    if heights.max() > PLANE * diagonal or heights[~on].max() > -APART * diagonal:
        return None
    # A corner is in three planes at least, and no other corner in the same.
    planes = np.array(list({row.tobytes(): row for row in on}.values()))
    of_corner = {column.tobytes() for column in planes.T}
    if len(of_corner) < count or planes.sum(axis=0).min() < 3:
        return None
    return float((crosses * firsts).sum()) / 6


NEXT, AFTER = [1, 2, 0], [2, 0, 1]
"""Of the axes x, y and z."""


def _closed(triangles: NDArray[np.int64], count: int) -> bool:
    """Whether each edge has two triangles, which run through it in opposite directions."""
    following = triangles[:, NEXT]
    forwards = set((triangles * count + following).ravel().tolist())
    backwards = set((following * count + triangles).ravel().tolist())
    return len(forwards) == triangles.size and forwards == backwards
