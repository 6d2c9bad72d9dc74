"""Exact convex pieces of a solid bounded by triangles: docs/theory/convex-decomposition.md.

Cuts along planes of faces at reflex edges until every part is convex, the naive decomposition of
B. Chazelle, *Convex partitions of polyhedra: a lower bound and worst-case optimal algorithm*,
SIAM J. Comput. 13 (1984), 488-507, on the cells of a binary space partition.

The part of a solid in a convex cell is the cell cut off by the planes of the faces in it, and so
convex, if and only if no face in the cell reaches beyond the plane of another. So nothing but faces
is kept: no cut is closed by a cap, and no edge of the mesh is looked for.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from drystone.meshes.cells import ACROSS, INSIDE, ON, OUTSIDE, Cell, Plane, clipped, side
from drystone.meshes.errors import MeshError
from drystone.meshes.hull import hull_corners, hull_volume, merged
from drystone.meshes.planes import Faces, at_least_planes, faces_by_plane

if TYPE_CHECKING:
    from numpy.typing import NDArray

SLACK = 4
"""So many times the allowed pieces may be found before they are merged."""


@dataclass(frozen=True, slots=True, eq=False)
class _Region:
    """A convex cell, and the surface inside it."""

    cell: Cell
    faces: Faces


class Decomposition:
    """The convex pieces of one solid.

    `corners` (n, 3, 3) are its triangles, counter-clockwise from outside. What is within
    `tolerance` (metres) of a plane is in it.
    """

    def __init__(
        self, corners: NDArray[np.float64], tolerance: float, most_planes: int, most_pieces: int
    ) -> None:
        self._corners = corners
        self._tolerance = tolerance
        self._most_pieces = most_pieces
        self._planes, self._faces = faces_by_plane(corners, tolerance, most_planes)
        self._normals = np.array([plane.normal for plane in self._planes])
        self._offsets = np.array([plane.offset for plane in self._planes])

    def pieces(self) -> list[NDArray[np.float64]]:
        """Corners (k, 3) of every piece; MeshError if there are too many."""
        found: list[NDArray[np.float64]] = []
        regions = [self._everything()]
        while regions:
            region = regions.pop()
            plane = self._cutting_plane(region.faces)
            if plane is not None:
                regions += self._cut(region, plane)
            else:
                found += self._convex_part(region)
            if len(found) > SLACK * self._most_pieces:
                raise too_many_pieces(self._most_pieces)
        pieces = merged([piece for piece in found if hull_volume(piece) > 0])
        if len(pieces) > self._most_pieces:
            raise too_many_pieces(self._most_pieces)
        return pieces

    def cell_of_all(self) -> Cell | None:
        """What the planes of all faces leave: the solid, if it is convex."""
        walls = {(face.plane, face.outwards) for face in self._faces}
        return self._cut_off(self._everything().cell, walls)

    def _everything(self) -> _Region:
        points = self._corners.reshape(-1, 3)
        margin = np.ptp(points, axis=0).max()
        cell = Cell.box(points.min(axis=0) - margin, points.max(axis=0) + margin)
        return _Region(cell, self._faces)

    def _cutting_plane(self, faces: Faces) -> Plane | None:
        """The plane of a face beyond which others reach; of several that which cuts the fewest."""
        if not len(faces):
            return None
        numbers = np.unique(faces.planes)
        highest, lowest = faces.extents(self._normals[numbers], self._offsets[numbers])
        above, below = highest > self._tolerance, lowest < -self._tolerance
        column = np.searchsorted(numbers, faces.planes)
        outwards, inwards = np.zeros((2, len(numbers)), dtype=bool)
        outwards[column[faces.outwards]] = True
        inwards[column[~faces.outwards]] = True
        reflex = outwards & inwards | outwards & above.any(axis=0) | inwards & below.any(axis=0)
        if not reflex.any():
            return None
        across = (above & below).sum(axis=0)
        area_rank = numbers / len(self._planes)  # numbered from the largest
        best = int(numbers[np.argmin(np.where(reflex, across + area_rank, np.inf))])
        return self._planes[best]

    def _cut(self, region: _Region, plane: Plane) -> list[_Region]:
        if self._side(region.cell, plane.number) != ACROSS:
            # Its faces are in the wall of the cell: not inside.
            kept = [face for face in region.faces if face.plane != plane.number]
            return [_Region(region.cell, Faces.of(kept))]
        inside, outside = [], []
        for face in region.faces:
            heights = plane.heights(face.polygon)
            where = ON if face.plane == plane.number else side(heights, self._tolerance)
            if where == ACROSS:
                low, high = clipped(face.polygon, heights, self._tolerance)
                inside.append(face.on(low))
                outside.append(face.on(high))
            elif where == INSIDE:
                inside.append(face)
            elif where == OUTSIDE:
                outside.append(face)
        below, above = region.cell.cut(plane, self._tolerance)
        return [_Region(below, Faces.of(inside)), _Region(above, Faces.of(outside))]

    def _convex_part(self, region: _Region) -> list[NDArray[np.float64]]:
        """The cell cut off by the planes of the faces in it; nothing if that is empty."""
        # The faces of a plane that does not go across are in the cell's wall: not inside.
        walls = {(face.plane, face.outwards) for face in region.faces}
        walls = {wall for wall in walls if self._side(region.cell, wall[0]) == ACROSS}
        if not walls:
            return [region.cell.corners] if self._is_solid(region.cell) else []
        cell = self._cut_off(region.cell, walls)
        return [] if cell is None else [cell.corners]

    def _cut_off(self, cell: Cell, walls: set[tuple[int, bool]]) -> Cell | None:
        """What is inside of planes, given by number and whether their normals leave the solid."""
        for number, outwards in sorted(walls):
            where = self._side(cell, number)
            if where == ACROSS:
                below, above = cell.cut(self._planes[number], self._tolerance)
                cell = below if outwards else above
            elif where != (INSIDE if outwards else OUTSIDE):
                return None
        return cell

    def _side(self, cell: Cell, plane: int) -> int:
        return cell.side(self._planes[plane], self._tolerance)

    def _is_solid(self, cell: Cell) -> bool:
        """Whether a cell without surface is inside the solid."""
        return winding_number(self._corners, cell.corners.mean(axis=0)) > 0.5


def cleaned(points: NDArray[np.float64], tolerance: float, most: int) -> NDArray[np.float64]:
    """The corners of a convex piece with plane faces and straight edges; none if it is thin.

    It is cut out of the planes of its hull again, of which those within `tolerance` (metres) of a
    larger triangle's are the same. A piece of more than `most` planes is smooth: it stays as it is.
    """
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return np.empty((0, 3))
    if hull.volume <= tolerance * hull.area:
        return np.empty((0, 3))
    corners = points[hull.simplices]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inwards = (normals * hull.equations[:, :3]).sum(axis=1) < 0
    corners[inwards] = corners[inwards][:, ::-1]
    if at_least_planes(corners, tolerance, most) > most:
        return hull_corners(points)
    cell = Decomposition(corners, tolerance, most, 1).cell_of_all()
    clean = points if cell is None else cell.clean_corners(2 * tolerance)
    # Nearly parallel planes may meet far from where its corners are.
    same = cell is not None and abs(hull_volume(clean) - hull.volume) <= tolerance * hull.area
    return clean if same else hull_corners(points)


def winding_number(corners: NDArray[np.float64], point: NDArray[np.float64]) -> float:
    """How often triangles (n, 3, 3) go around a point: 1 inside of a solid, 0 outside.

    The sum of their solid angles over 4 pi (A. van Oosterom and J. Strackee, 1983).
    """
    a, b, c = np.moveaxis(corners - point, 1, 0)
    la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
    ab, bc, ca = ((x * y).sum(axis=1) for x, y in ((a, b), (b, c), (c, a)))
    triple = (a * np.cross(b, c)).sum(axis=1)
    half = np.arctan2(triple, la * lb * lc + ab * lc + bc * la + ca * lb)
    return float(half.sum() / (2 * np.pi))


def too_many_pieces(most: int) -> MeshError:
    """The error for a solid that falls into too many convex pieces."""
    return MeshError(
        f"it falls into more than {most} convex pieces: let it be simplified with simplify, "
        "cut it into convex pieces yourself, allow more with max_pieces, or take its convex hull"
    )
