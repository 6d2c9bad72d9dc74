"""How far two surfaces are from each other, measured at many points of both."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull, cKDTree

from drystone.common.extras import extra

if TYPE_CHECKING:
    from numpy.typing import NDArray

FINENESS = 50_000
"""A surface is divided into no fewer triangles than this, and measured at their corners. On one of
area S they are about sqrt(4 S / FINENESS) across, and a point between two corners is farther off
than both by no more than half of that."""

NEAREST = 4
"""Triangles whose distance from a point is computed, for each: those with the nearest middles. Were
a nearer one missed, the distance would come out too large, never too small."""

AT_ONCE = 20_000
"""Points measured at a time, for memory, and to stop soon where surfaces are far apart."""


class Divided:
    """A surface, divided into at least `FINENESS` triangles of about one size.

    They are `parts` (n, 3, 3), and `points` (k, 3) all their corners.
    """

    def __init__(self, parts: NDArray[np.float64], points: NDArray[np.float64]) -> None:
        self._parts = parts
        self._points = points
        self._tree = cKDTree(parts.mean(axis=1))

    @classmethod
    def of(cls, vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> Divided:
        """The surface of `triangles` (n, 3) over `vertices` (k, 3)."""
        parts, _ = _divided(vertices[triangles])
        return cls(parts, vertices if len(parts) == len(triangles) else _corners(parts))

    @classmethod
    def outside(cls, pieces: list[NDArray[np.float64]], skin: float) -> Divided:
        """The outer surface of convex pieces (k, 3): without what is between two of them.

        A triangle is between if its middle, pushed out by `skin` (metres), is in another piece.
        """
        hulls = [ConvexHull(piece) for piece in pieces]
        walls = [piece[hull.simplices] for piece, hull in zip(pieces, hulls, strict=True)]
        parts, walls_of = _divided(np.concatenate(walls))
        normals = np.concatenate([hull.equations[:, :3] for hull in hulls])[walls_of]
        owners = np.repeat(np.arange(len(pieces)), [len(wall) for wall in walls])[walls_of]
        pushed = parts.mean(axis=1) + skin * normals
        between = np.zeros(len(parts), dtype=bool)
        for number, (piece, hull) in enumerate(zip(pieces, hulls, strict=True)):
            in_box = (pushed >= piece.min(axis=0)) & (pushed <= piece.max(axis=0))
            near = np.flatnonzero(in_box.all(axis=1) & (owners != number))
            heights = pushed[near] @ hull.equations[:, :3].T + hull.equations[:, 3]
            between[near] |= (heights <= 0).all(axis=1)
        return cls(parts[~between], _corners(parts[~between]))

    def deviation(self, other: Divided, bound: float = np.inf) -> float:
        """The greatest distance from one of the two surfaces to the other, metres.

        Only beyond `bound` is what is returned less than the greatest.
        """
        there = self._farthest(other._points, bound)
        return there if there > bound else max(there, other._farthest(self._points, bound))

    def _farthest(self, points: NDArray[np.float64], bound: float) -> float:
        """The greatest distance of points (k, 3) from this surface, metres."""
        with extra("meshes", "simplified meshes"):
            from trimesh.triangles import closest_point

        farthest, groups = 0.0, len(points) // AT_ONCE + 1
        for first in range(groups):
            some = points[first::groups]
            _, near = self._tree.query(some, k=NEAREST)
            repeated = np.repeat(some, NEAREST, axis=0)
            gaps = closest_point(self._parts[near.reshape(-1)], repeated) - repeated
            distances = np.linalg.norm(gaps, axis=1).reshape(-1, NEAREST)
            farthest = max(farthest, float(distances.min(axis=1).max()))
            if farthest > bound:
                break
        return farthest


def _divided(triangles: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """At least `FINENESS` parts of triangles, and of which triangle each is."""
    owners = np.arange(len(triangles))
    while len(triangles) < FINENESS:
        lengths = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)
        long = lengths > lengths.max() / 2
        triangles = np.concatenate([triangles[~long], _in_four(triangles[long])])
        owners = np.concatenate([owners[~long], np.tile(owners[long], 4)])
    return triangles, owners


def _corners(triangles: NDArray[np.float64]) -> NDArray[np.float64]:
    """The corners of triangles (n, 3, 3), each once."""
    corners: NDArray[np.float64] = np.unique(triangles.reshape(-1, 3), axis=0)
    return corners


def _in_four(triangles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Four triangles for each (n, 3, 3), through the middles of its sides."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    four = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.concatenate([np.stack(corners, axis=1) for corners in four])
