"""Convex hulls of points, and convex pieces put together again."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull, QhullError

if TYPE_CHECKING:
    from numpy.typing import NDArray

CONVEX = 1e-9
"""Two pieces are one if their hull has no more volume than they, within this share of it."""

AT_ONCE = 10_000_000
"""Heights of points above planes computed at a time, for memory."""


def hull_volume(points: NDArray[np.float64]) -> float:
    """Volume of the convex hull of points (k, 3), cubic metres; 0 if it is flat."""
    try:
        return float(ConvexHull(points).volume)
    except (QhullError, ValueError):
        return 0.0


def hull_area(points: NDArray[np.float64]) -> float:
    """Surface of the convex hull of points (k, 3), square metres, that is not flat."""
    return float(ConvexHull(points).area)


def hull_corners(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Those of the points (k, 3) that are corners of their hull; all of them if it is flat."""
    try:
        corners: NDArray[np.float64] = points[np.sort(ConvexHull(points).vertices)]
    except (QhullError, ValueError):
        return points
    return corners


def deepest(points: NDArray[np.float64], corners: NDArray[np.float64]) -> float:
    """How deep the middles of triangles (n, 3, 3) are at most inside the hull of points (k, 3).

    Depth is concave over a triangle and not negative, so that nothing of it is more than three
    times as deep as its middle.
    """
    equations = ConvexHull(points).equations
    middles = corners.mean(axis=1)
    groups = len(middles) * len(equations) // AT_ONCE + 1
    depths = [
        -(middles[first::groups] @ equations[:, :3].T + equations[:, 3]).max(axis=1)
        for first in range(groups)
    ]
    return float(np.concatenate(depths).max())


def hull_triangles(
    points: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The hull of corners (k, 3) as vertices and triangles, counter-clockwise from outside."""
    hull = ConvexHull(points)
    triangles = hull.simplices.astype(np.int64)
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    inwards = (np.cross(b - a, c - a) * hull.equations[:, :3]).sum(axis=1) < 0
    triangles[inwards] = triangles[inwards][:, ::-1]
    return points, triangles


def merged(pieces: list[NDArray[np.float64]]) -> list[NDArray[np.float64]]:
    """The same solid in fewer pieces: two with a convex union become one."""
    pieces = list(pieces)
    volumes = [hull_volume(piece) for piece in pieces]
    before = len(pieces) + 1
    while len(pieces) < before:
        before = len(pieces)
        i = 0
        while i < len(pieces):
            j = _partner(pieces, volumes, i)
            if j is None:
                i += 1
                continue
            both = np.concatenate([pieces[i], pieces[j]])
            pieces[i] = hull_corners(both)
            volumes[i] += volumes[j]
            del pieces[j], volumes[j]
    return pieces


def _partner(pieces: list[NDArray[np.float64]], volumes: list[float], i: int) -> int | None:
    """The first piece after `i` with which it makes a convex one."""
    later = pieces[i + 1 :]
    if not later:
        return None
    low = np.array([piece.min(axis=0) for piece in later])
    high = np.array([piece.max(axis=0) for piece in later])
    reach = 1e-6 * np.ptp(pieces[i], axis=0).max()
    own_low, own_high = pieces[i].min(axis=0) - reach, pieces[i].max(axis=0) + reach
    near = ((low <= own_high) & (high >= own_low)).all(axis=1)
    for j in np.flatnonzero(near) + i + 1:
        both = volumes[i] + volumes[j]
        if hull_volume(np.concatenate([pieces[i], pieces[j]])) <= (1 + CONVEX) * both:
            return int(j)
    return None
