"""Triangles of a polygon in space: a fan where that does not fold, else ears."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

Triangle = tuple[int, int, int]


def triangulated(points: NDArray[np.float64]) -> list[Triangle]:
    """Triangles of a polygon of corners (k, 3), k >= 3, by the numbers of these.

    The polygon need not be convex, nor quite plane. A fan from the first corner is kept if all of
    it faces the way that the polygon does; else ears are cut off (G. Meisters, *Polygons have
    ears*, Amer. Math. Monthly 82, 1975), seen along the polygon's normal. One that goes through
    itself has a fan.
    """
    fan = [(0, a, b) for a, b in pairwise(range(1, len(points)))]
    flat = _in_plane(points)
    if flat is None or all(_turn(*flat[list(triangle)]) >= 0 for triangle in fan):
        return fan
    return _ears(flat) or fan


def _in_plane(points: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """The corners (k, 2) as seen from the side that the polygon runs round; None without area."""
    near = points - points.mean(axis=0)
    normal = np.cross(near, np.roll(near, -1, axis=0)).sum(axis=0)
    size = np.linalg.norm(normal)
    if not 0 < size < np.inf:
        return None
    normal = normal / size
    first = np.cross(normal, np.eye(3)[abs(normal).argmin()])
    first /= np.linalg.norm(first)
    flat: NDArray[np.float64] = near @ np.stack([first, np.cross(normal, first)], axis=1)
    return flat


def _turn(a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]) -> float:
    """Twice the area of a triangle, positive if it is counter-clockwise."""
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _ears(flat: NDArray[np.float64]) -> list[Triangle]:
    """Triangles of a simple polygon, counter-clockwise; none if no ear is found."""
    left = list(range(len(flat)))
    triangles: list[Triangle] = []
    while len(left) > 3:
        ear = next((k for k in range(len(left)) if _is_ear(flat, left, k)), None)
        if ear is None:
            return []
        triangles.append((left[ear - 1], left[ear], left[(ear + 1) % len(left)]))
        del left[ear]
    return [*triangles, (left[0], left[1], left[2])]


def _is_ear(flat: NDArray[np.float64], left: list[int], k: int) -> bool:
    """Whether a corner of what is left turns outwards, and no other is in its triangle."""
    corners = [left[k - 1], left[k], left[(k + 1) % len(left)]]
    a, b, c = flat[corners]
    if _turn(a, b, c) <= 0:
        return False
    others = flat[[i for i in left if i not in corners]]
    within = np.ones(len(others), dtype=bool)
    for start, end in ((a, b), (b, c), (c, a)):
        (dx, dy), rest = end - start, others - start
        within &= dx * rest[:, 1] - dy * rest[:, 0] >= 0
    return not within.any()
