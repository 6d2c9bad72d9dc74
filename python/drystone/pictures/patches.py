"""Surfaces in patches of few triangles that lie together, so that a picture can be painted."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

SMALL = 40
"""Triangles of a patch, at most, unless there would be too many patches."""
MOST = 200
"""Patches of a body: each is compared with every other of the picture."""
SHARP = 0.35
"""Radians by which a surface turns at an edge that is drawn."""

Points = NDArray[np.float64]
Patch = tuple[Points, list[tuple[int, ...]], Points, NDArray[np.bool_]]
"""Corners (k, 3), triangles, their unit normals (n, 3), and which sides are edges (n, 3)."""


def patches(vertices: Points, triangles: NDArray[np.uint32]) -> list[Patch]:
    """A surface cut by halves across its longest side."""
    corners = vertices[triangles]
    normals = _normals(corners)
    sharp = _sharp(triangles.astype(np.int64), normals)
    middles = corners.mean(axis=1)
    small = max(SMALL, -(-len(triangles) // MOST))
    waiting, found = [np.arange(len(triangles))], []
    while waiting:
        chosen = waiting.pop()
        if len(chosen) > small:
            axis = int(np.argmax(np.ptp(middles[chosen], axis=0)))
            order = chosen[np.argsort(middles[chosen, axis], kind="stable")]
            waiting += [order[: len(order) // 2], order[len(order) // 2 :]]
            continue
        used, places = np.unique(triangles[chosen], return_inverse=True)
        faces = [tuple(face) for face in places.reshape(-1, 3).tolist()]
        found.append((vertices[used], faces, normals[chosen], sharp[chosen]))
    return found


def _normals(corners: Points) -> Points:
    a, b, c = np.moveaxis(corners, 1, 0)
    across = np.cross(b - a, c - a)
    lengths = np.linalg.norm(across, axis=1)[:, None]
    normals: Points = across / np.where(lengths > 0, lengths, 1.0)
    return normals


def _sharp(triangles: NDArray[np.int64], normals: Points) -> NDArray[np.bool_]:
    """Which sides of each triangle turn by more than `SHARP`."""
    count = len(triangles)
    halves = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    order = np.lexsort((halves.max(axis=1), halves.min(axis=1)))
    ends = np.sort(halves[order], axis=1)
    same = (ends[1:] == ends[:-1]).all(axis=1)
    one, two = order[:-1][same], order[1:][same]
    turns = np.einsum("ij,ij->i", normals[one % count], normals[two % count]) < np.cos(SHARP)
    sharp = np.zeros(3 * count, dtype=bool)
    sharp[one[turns]] = sharp[two[turns]] = True
    by_triangle: NDArray[np.bool_] = sharp.reshape(3, count).T
    return by_triangle
