"""Faces that would be plane but for rounding, made plane: docs/theory/convex-decomposition.md.

Triangles are sorted by planes that are fitted to them, and each vertex moves to where the planes of
its faces meet. What comes out is a mesh that the exact methods take.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

REACH = 1.75
"""So many tolerances a corner may be off a plane that is fitted to others: the plane through the
first triangle is off by a few times as much as its own corners."""

ALIKE = 0.3
"""Neighbours that differ by a smaller angle than this (radians) may be one face."""

STEEP = 0.02
"""Planes of a vertex that differ by a smaller angle than about this do not fix it across."""

MOST_FITS = 20
"""A fitted plane takes triangles in and lets others go so many times at most."""

MOST_ROUNDS = 30
"""Where more than three planes meet, they are fitted again to the moved vertices so many times."""


@dataclass(frozen=True, slots=True, eq=False)
class Flattened:
    """A mesh with plane faces."""

    vertices: NDArray[np.float64]
    uneven: float
    """The farthest that one is still from a plane of its faces."""


def is_nearly_flat(
    vertices: NDArray[np.float64], triangles: NDArray[np.int64], tight: float, loose: float
) -> bool:
    """Whether two neighbours lie in one plane within `loose`, but not within `tight` (metres)."""
    corners = vertices[triangles]
    one, two = _neighbours(triangles).T
    normals = _normals(corners)[0]
    alike = (normals[one] * normals[two]).sum(axis=1) > np.cos(ALIKE)
    one, two = one[alike], two[alike]
    off = np.minimum(_off(corners, normals, one, two), _off(corners, normals, two, one))
    return bool(((off > tight) & (off <= loose)).any())


def flattened(
    vertices: NDArray[np.float64],
    triangles: NDArray[np.int64],
    tolerance: float,
    most_planes: int,
) -> Flattened | None:
    """The same mesh with vertices moved so that faces plane within `tolerance` (metres) are plane.

    None if there are more than `most_planes`, or vertices would have to move by more than that.
    """
    members = _faces(vertices, triangles, REACH * tolerance, most_planes)
    if members is None:
        return None
    moved, last = vertices, np.inf
    for _ in range(MOST_ROUNDS):
        planes = [_fitted(moved[face]) for face in members]
        moved, uneven = _moved(moved, members, planes)
        if uneven <= 1e-3 * tolerance or uneven > 0.9 * last:
            break
        last = uneven
    distance = float(np.linalg.norm(moved - vertices, axis=1).max())
    return Flattened(moved, uneven) if distance <= tolerance else None


def _faces(
    vertices: NDArray[np.float64], triangles: NDArray[np.int64], reach: float, most: int
) -> list[NDArray[np.int64]] | None:
    """The vertices of each plane face, from the one of the largest triangle on; None if many."""
    corners = vertices[triangles]
    normals, doubled = _normals(corners)
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    # What is narrower than rounding has no direction; its corners belong to other faces too.
    left = np.flatnonzero(doubled > reach * longest)
    left = left[np.argsort(-doubled[left], kind="stable")]
    members: list[NDArray[np.int64]] = []
    while len(left):
        if len(members) == most:
            return None
        normal, middle = normals[left[0]], corners[left[0]].mean(axis=0)
        here = np.arange(len(left)) == 0
        for _ in range(MOST_FITS):
            inside = (abs((corners[left] - middle) @ normal) <= reach).all(axis=1)
            inside[0] = True
            if (inside == here).all():
                break
            here = inside
            normal, middle = _fitted(vertices[np.unique(triangles[left[here]])])
        members.append(np.unique(triangles[left[here]]))
        left = left[~here]
    return members


def _fitted(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The normal of the plane nearest to points (k, 3), and their middle, which is in it."""
    middle = points.mean(axis=0)
    normal = np.linalg.svd(points - middle, full_matrices=False)[2][2]
    return normal, middle


def _moved(
    vertices: NDArray[np.float64],
    members: list[NDArray[np.int64]],
    planes: list[tuple[NDArray[np.float64], NDArray[np.float64]]],
) -> tuple[NDArray[np.float64], float]:
    """Vertices moved the least that brings them into their planes, and how far one is still off."""
    most = int(np.bincount(np.concatenate(members)).max())
    normals, offsets = np.zeros((len(vertices), most, 3)), np.zeros((len(vertices), most))
    count = np.zeros(len(vertices), dtype=np.int64)
    for face, (normal, middle) in zip(members, planes, strict=True):
        normals[face, count[face]] = normal
        offsets[face, count[face]] = (middle - vertices[face]) @ normal
        count[face] += 1
    steps = (np.linalg.pinv(normals, rcond=STEEP) @ offsets[:, :, None])[:, :, 0]
    off = abs((normals @ steps[:, :, None])[:, :, 0] - offsets)
    return vertices + steps, float(off.max())


def _normals(
    corners: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Unit normals of triangles (n, 3, 3), zero for those without area, and twice the areas."""
    crosses = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(crosses, axis=1)
    return crosses / np.where(doubled > 0, doubled, 1.0)[:, None], doubled


def _off(
    corners: NDArray[np.float64],
    normals: NDArray[np.float64],
    one: NDArray[np.int64],
    two: NDArray[np.int64],
) -> NDArray[np.float64]:
    """How far the corners of some triangles are at most off the planes of others."""
    across = corners[two] - corners[one][:, :1]
    heights: NDArray[np.float64] = abs(np.einsum("nij,nj->ni", across, normals[one])).max(axis=1)
    return heights


def _neighbours(triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    """Pairs (k, 2) of triangles with an edge in common."""
    halves = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    halves = np.sort(halves, axis=1)
    order = np.lexsort((halves[:, 1], halves[:, 0]))
    same = (halves[order[1:]] == halves[order[:-1]]).all(axis=1)
    return np.stack([order[:-1][same], order[1:][same]], axis=1) % len(triangles)
