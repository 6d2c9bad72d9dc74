"""Triangles sorted by the planes that they lie in."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from drystone.meshes.cells import Plane
from drystone.meshes.errors import MeshError

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class Face:
    """A convex part of the surface."""

    polygon: NDArray[np.float64]
    """(k, 3), metres."""
    plane: int
    """The number of its plane."""
    outwards: bool
    """Whether that plane's normal leaves the solid here."""

    def on(self, polygon: NDArray[np.float64]) -> Face:
        """Another part of the same surface."""
        return replace(self, polygon=polygon)


@dataclass(frozen=True, slots=True, eq=False)
class Faces:
    """Faces, and the same in arrays."""

    listed: list[Face]
    points: NDArray[np.float64]
    """The corners of all faces, one face after another."""
    starts: NDArray[np.int64]
    """Where the corners of each begin."""
    planes: NDArray[np.int64]
    outwards: NDArray[np.bool_]

    @classmethod
    def of(cls, listed: list[Face]) -> Faces:
        """The faces in a list, which may be empty."""
        sizes = [len(face.polygon) for face in listed]
        return cls(
            listed,
            np.concatenate([np.empty((0, 3)), *(face.polygon for face in listed)]),
            np.cumsum([0, *sizes[:-1]], dtype=np.int64),
            np.array([face.plane for face in listed], dtype=np.int64),
            np.array([face.outwards for face in listed], dtype=bool),
        )

    def __len__(self) -> int:
        return len(self.listed)

    def __iter__(self) -> Iterator[Face]:
        return iter(self.listed)

    def extents(
        self, normals: NDArray[np.float64], offsets: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Greatest and least height of each face (row) above each plane (column)."""
        heights = self.points @ normals.T - offsets
        return (
            np.maximum.reduceat(heights, self.starts, axis=0),
            np.minimum.reduceat(heights, self.starts, axis=0),
        )


def faces_by_plane(
    corners: NDArray[np.float64], tolerance: float, most: int
) -> tuple[Sequence[Plane], Faces]:
    """The planes of triangles (n, 3, 3), from the largest triangle's on, and the faces in them.

    Triangles with all corners within `tolerance` (metres) of one plane share it. MeshError if
    there are more than `most` planes.
    """
    planes: list[Plane] = []
    faces: list[Face] = []
    for plane, corners_in_it, outwards in _by_plane(corners, tolerance):
        if len(planes) == most:
            raise MeshError(
                f"it has more than {most} plane faces: let it be simplified with "
                "simplify, cut it into convex pieces yourself, or take its convex hull"
            )
        planes.append(plane)
        faces += [
            Face(corner, plane.number, bool(out))
            for corner, out in zip(corners_in_it, outwards, strict=True)
        ]
    return planes, Faces.of(faces)


def at_least_planes(corners: NDArray[np.float64], tolerance: float, most: int) -> int:
    """In how many planes a sample of the triangles lies, counted up to `most` + 1."""
    sample = corners[:: max(1, len(corners) // (4 * most))]
    return sum(1 for _ in islice(_by_plane(sample, tolerance), most + 1))


def _by_plane(
    corners: NDArray[np.float64], tolerance: float
) -> Iterator[tuple[Plane, NDArray[np.float64], NDArray[np.bool_]]]:
    """Planes, the triangles in each, and whether these face the way of its normal."""
    crosses = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(crosses, axis=1)
    # What is narrower than the tolerance has no direction, and no part in the surface.
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    left = np.flatnonzero(doubled > tolerance * longest)
    left = left[np.argsort(-doubled[left], kind="stable")]
    number = 0
    while len(left):
        normal = crosses[left[0]] / doubled[left[0]]
        plane = Plane(number, normal, float(corners[left[0]].mean(axis=0) @ normal))
        # Its own triangle too, whatever rounding says of a very large one.
        flat = (abs(plane.heights(corners[left])) <= tolerance).all(axis=1)
        here = np.logical_or(flat, np.arange(len(left)) == 0)
        yield plane, corners[left[here]], crosses[left[here]] @ normal > 0
        left = left[~here]
        number += 1
