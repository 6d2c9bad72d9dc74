"""Meshes of several convex shells that may overlap, as V-HACD and CoACD write them.

They are for bodies whose mass is given: where shells overlap, volume counts twice.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from drystone.imports.weight import of_triangles
from drystone.meshes.hull import hull_corners, hull_volume
from drystone.meshes.part import MOST_CORNERS
from drystone.meshes.reading import Triangles

if TYPE_CHECKING:
    from numpy.typing import NDArray

CONVEX = 0.05
"""A shell is taken as its hull if that has no more volume within this share of it. Shells of
published models are up to 3 % from convex, and simulators collide their hulls."""


def convex_shells(read: Triangles) -> list[NDArray[np.float64]] | None:
    """The corners (k, 3) of each shell's hull, in the mesh's unit; None unless there are several,
    each closed and nearly convex."""
    shells = _shells(read)
    if len(shells) < 2:
        return None
    pieces = []
    for triangles in shells:
        points = read.vertices[np.unique(triangles)]
        volume, hull = of_triangles(read.vertices[triangles]).mass, hull_volume(points)
        corners = hull_corners(points)
        if not 0 < hull <= (1 + CONVEX) * volume or volume > (1 + CONVEX) * hull:
            return None
        if len(corners) > MOST_CORNERS:
            return None
        pieces.append(corners)
    return pieces


def _shells(read: Triangles) -> list[NDArray[np.int64]]:
    """The triangles (n, 3) of each connected shell; corners in one place are one."""
    if not np.isfinite(read.vertices).all():
        return []
    triangles = read.triangles
    if read.repeats:
        _, where = np.unique(read.vertices, axis=0, return_inverse=True)
        triangles = where.reshape(-1)[triangles]
    size = int(triangles.max()) + 1
    a, b, c = triangles.T
    ends = (np.concatenate([a, a]), np.concatenate([b, c]))
    graph = coo_array((np.ones(2 * len(a)), ends), shape=(size, size))
    _, labels = connected_components(graph, directed=False)
    of = labels[a]
    return [read.triangles[of == label] for label in np.unique(of)]


def scaled(read: Triangles, scale: tuple[float, float, float]) -> Triangles:
    """The mesh in metres, its faces outwards if they were."""
    triangles = read.triangles[:, ::-1] if np.prod(scale) < 0 else read.triangles
    return replace(read, vertices=read.vertices * scale, triangles=triangles)
