"""Convex cells of space, cut by planes.

A cell is its corners and its walls. Two corners are joined by an edge where they have two walls in
common; a cut finds its new corners along these edges, so that no faces need to be kept. A corner
within the tolerance of a plane is on it. One on the cutting plane belongs to both sides: no cut
makes a sliver thinner than that.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drystone.meshes.hull import hull_corners

if TYPE_CHECKING:
    from numpy.typing import NDArray

INSIDE, ACROSS, OUTSIDE, ON = -1, 0, 1, 2
"""Where points are as seen from a plane: on the side its normal leaves, on both sides, on the side
it points to, or in it."""


STRAIGHT = 1e-5
"""Walls that differ by a smaller angle than about this (radians) have no edge between them."""


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
    """A convex cell: its corners (k, 3) and the planes of its walls."""

    corners: NDArray[np.float64]
    walls: tuple[Plane, ...]

    @classmethod
    def box(cls, low: NDArray[np.float64], high: NDArray[np.float64]) -> Cell:
        """The box between two corners. Its walls have the numbers -6 to -1."""
        corners = np.array([np.where(choice, high, low) for choice in np.ndindex(2, 2, 2)])
        walls = [Plane(axis - 6, np.eye(3)[axis], float(low[axis])) for axis in range(3)]
        walls += [Plane(axis - 3, np.eye(3)[axis], float(high[axis])) for axis in range(3)]
        return cls(corners, tuple(walls))

    def side(self, plane: Plane, tolerance: float) -> int:
        """On which side of `plane` the cell is."""
        return side(plane.heights(self.corners), tolerance)

    def cut(self, plane: Plane, tolerance: float) -> tuple[Cell, Cell]:
        """The parts inside and outside of a plane that goes across."""
        heights = plane.heights(self.corners)
        low, high = self._edges(heights < -tolerance, heights > tolerance, tolerance)
        share = (heights[low] / (heights[low] - heights[high]))[:, None]
        crossings = (1 - share) * self.corners[low] + share * self.corners[high]
        on = self.corners[abs(heights) <= tolerance]
        below, above = self.corners[heights < -tolerance], self.corners[heights > tolerance]
        return (
            self._part(np.concatenate([below, on, crossings]), plane, tolerance),
            self._part(np.concatenate([above, on, crossings]), plane, tolerance),
        )

    def clean_corners(self, tolerance: float) -> NDArray[np.float64]:
        """The corners where three walls meet at an angle, those within `tolerance` taken as one."""
        kept: list[NDArray[np.float64]] = []
        for corner in self.corners:
            near = any(np.linalg.norm(corner - other) <= tolerance for other in kept)
            through = [w.normal for w in self.walls if abs(w.heights(corner)) <= tolerance]
            if not near and _in_space(through):
                kept.append(corner)
        return np.array(kept).reshape(-1, 3)

    def _edges(
        self, low: NDArray[np.bool_], high: NDArray[np.bool_], tolerance: float
    ) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """The ends of the edges from some corners to others, and perhaps diagonals of a wall.

        Ends have two walls in common. What is no edge does no harm: it stays inside.
        """
        heights = np.stack([abs(wall.heights(self.corners)) for wall in self.walls], axis=1)
        on = (heights <= tolerance).astype(np.int64)
        common = on[low] @ on[high].T
        i, j = np.nonzero(common >= 2)
        return np.flatnonzero(low)[i], np.flatnonzero(high)[j]

    def _part(self, corners: NDArray[np.float64], plane: Plane, tolerance: float) -> Cell:
        """The cell of these corners, with those of the walls that are still its own."""
        walls = [
            wall
            for wall in (*self.walls, plane)
            if (abs(wall.heights(corners)) <= tolerance).sum() >= 3
        ]
        # No convex polyhedron has more corners than this; then some are inside of a wall.
        if len(corners) > 2 * len(walls) - 4:
            corners = hull_corners(corners)
        return Cell(corners, tuple(walls))


def _in_space(normals: list[NDArray[np.float64]]) -> bool:
    """Whether planes of these normals meet in a point, and not along a line."""
    if len(normals) < 3:
        return False
    return bool(np.linalg.svd(np.array(normals), compute_uv=False)[2] > STRAIGHT)


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
