"""Convex cells of space, cut by planes.

A cell is its corners, and for each corner the planes that it lies on. Two corners are joined by an
edge where they share two planes; a cut finds its new corners along these edges, so that no faces
need to be kept. A corner within the tolerance of the cutting plane is on it and belongs to both
sides: no cut makes a sliver thinner than that.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

INSIDE, ACROSS, OUTSIDE, ON = -1, 0, 1, 2
"""Where points are as seen from a plane: on the side its normal leaves, on both sides, on the side
it points to, or in it."""


@dataclass(frozen=True, slots=True, eq=False)
class Plane:
    """The points x with normal . x = offset (metres)."""

    number: int
    """Unique among the planes of a mesh."""
    normal: NDArray[np.float64]
    offset: float

    def heights(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Signed distances of points from the plane, metres."""
        return points @ self.normal - self.offset


@dataclass(frozen=True, slots=True, eq=False)
class Cell:
    """A convex cell: its corners (k, 3), and for each the numbers of the planes through it."""

    corners: NDArray[np.float64]
    planes: tuple[frozenset[int], ...]

    @classmethod
    def box(cls, low: NDArray[np.float64], high: NDArray[np.float64]) -> Cell:
        """The box between two corners. Its planes have the numbers -6 to -1."""
        corners, planes = [], []
        for choice in np.ndindex(2, 2, 2):
            corners.append(np.where(choice, high, low))
            planes.append(frozenset(-1 - axis - 3 * upper for axis, upper in enumerate(choice)))
        return cls(np.array(corners), tuple(planes))

    def side(self, plane: Plane, tolerance: float) -> int:
        """On which side of `plane` the cell is."""
        return side(plane.heights(self.corners), tolerance)

    def cut(self, plane: Plane, tolerance: float) -> tuple[Cell, Cell]:
        """The parts inside and outside of a plane that goes across."""
        heights = plane.heights(self.corners)
        where = np.where(abs(heights) <= tolerance, 0, np.sign(heights)).astype(int)
        shared = [
            (corner, on | {plane.number})
            for corner, on, place in zip(self.corners, self.planes, where, strict=True)
            if place == 0
        ]
        for i, j in combinations(range(len(where)), 2):
            common = self.planes[i] & self.planes[j]
            if where[i] * where[j] < 0 and len(common) >= 2:
                share = heights[i] / (heights[i] - heights[j])
                point = (1 - share) * self.corners[i] + share * self.corners[j]
                shared.append((point, common | {plane.number}))
        return self._part(where < 0, shared), self._part(where > 0, shared)

    def _part(
        self, kept: NDArray[np.bool_], shared: list[tuple[NDArray[np.float64], frozenset[int]]]
    ) -> Cell:
        indices = np.flatnonzero(kept)
        corners = [self.corners[i] for i in indices] + [corner for corner, _ in shared]
        planes = [self.planes[i] for i in indices] + [on for _, on in shared]
        return Cell(np.array(corners), tuple(planes))


def side(heights: NDArray[np.float64], tolerance: float) -> int:
    """On which side of a plane points of these heights above it are."""
    above, below = heights.max() > tolerance, heights.min() < -tolerance
    if above and below:
        return ACROSS
    return OUTSIDE if above else INSIDE if below else ON


def clipped(
    polygon: NDArray[np.float64], heights: NDArray[np.float64], tolerance: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The parts of a convex polygon (k, 3) inside and outside of a plane that goes across it.

    `heights` are those of its corners above the plane (Sutherland and Hodgman, 1974).
    """
    inside, outside = [], []
    last, last_height = polygon[-1], heights[-1]
    for point, height in zip(polygon, heights, strict=True):
        if min(height, last_height) < -tolerance and max(height, last_height) > tolerance:
            share = last_height / (last_height - height)
            crossing = (1 - share) * last + share * point
            inside.append(crossing)
            outside.append(crossing)
        if height <= tolerance:
            inside.append(point)
        if height >= -tolerance:
            outside.append(point)
        last, last_height = point, height
    return np.array(inside), np.array(outside)
