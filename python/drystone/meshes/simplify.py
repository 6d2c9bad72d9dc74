"""Few convex pieces whose surface is near a mesh's: docs/theory/convex-decomposition.md.

A scan's triangles all lie in planes of their own. So the surface is decimated by manifold, what is
nearly flat becomes flat, and what is nearly convex becomes its hull. None of these steps keeps a
bound that could be relied on. So several tolerances are tried, the distance of what comes out from
the mesh is measured, and the simplest that is near enough is taken.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import QhullError

from drystone.common.extras import extra
from drystone.meshes.convex import Decomposition, cleaned
from drystone.meshes.deviation import Divided
from drystone.meshes.errors import MeshError
from drystone.meshes.hull import hull_area, hull_corners, hull_volume
from drystone.meshes.planes import at_least_planes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from drystone.meshes.surface import Surface

Mesh = tuple["NDArray[np.float64]", "NDArray[np.int64]"]
"""Vertices (k, 3) and triangles (n, 3)."""

SHARES = (1 / 2, 1 / 4, 1 / 8, 1 / 16)
"""Tolerances that are tried, as shares of the bound: of decimation, and of what counts as flat."""

MOST_PLANES = 60
MOST_TRIANGLES = 2000
MOST_ATTEMPTED = 64
"""A decimated concave mesh of more planes or triangles, or that falls into more pieces, is not cut:
cuts of what is still rough make many pieces and take long."""

SKIN = 1e-6
"""Pieces closer than this share of the diagonal touch: several times what cuts are exact to."""


@dataclass(frozen=True, slots=True)
class Simplification:
    """What was made of a mesh of too many triangles."""

    triangles: int
    """How many the mesh had."""
    pieces: int
    corners: int
    """How many all pieces have together."""
    bound: float
    """How far the surface was allowed to move, metres."""
    deviation: float
    """How far it moved, as measured, metres."""
    volume_before: float
    """Cubic metres, of the mesh. Its mass is by this volume."""
    volume_after: float
    """Cubic metres, of the pieces."""

    def message(self) -> str:
        """One sentence, without lengths, whose unit is not always metres."""
        pieces = "1 convex piece" if self.pieces == 1 else f"{self.pieces} convex pieces"
        change = 100 * (self.volume_after / self.volume_before - 1)
        return (
            f"simplified from {self.triangles} triangles to {pieces} with {self.corners} corners: "
            f"its surface moved by up to {100 * self.deviation / self.bound:.0f} % of what was "
            f"allowed and its volume by {change:+.2g} %; its mass is that of the volume before"
        )


def simplified(
    surface: Surface, bound: float, most_planes: int, most_pieces: int, most_corners: int
) -> tuple[list[NDArray[np.float64]], Simplification]:
    """Convex pieces whose outer surface is within `bound` (metres) of a closed surface.

    Pieces of up to `most_planes` planes get plane faces. MeshError if none are found, or only more
    than `most_pieces`, or larger than `most_corners`.
    """
    middle = surface.vertices.mean(axis=0)
    mesh, volume = Divided.of(surface.vertices - middle, surface.triangles), surface.volume
    decimated = _decimated(surface, middle, bound)
    skin = SKIN * surface.diagonal
    for attempts in (_hulls(decimated, bound, most_planes), _cuts(decimated, bound, most_planes)):
        found = [
            pieces
            for pieces in attempts
            if 0 < len(pieces) <= most_pieces
            and max(map(len, pieces)) <= most_corners
            and _may_be_near(pieces, volume, bound)
        ]
        for pieces in sorted(found, key=lambda pieces: (len(pieces), sum(map(len, pieces)))):
            moved = mesh.deviation(Divided.outside(pieces, skin), bound)
            if moved <= bound:
                after, corners = sum(map(hull_volume, pieces)), sum(map(len, pieces))
                note = Simplification(
                    len(surface.triangles), len(pieces), corners, bound, moved, volume, after
                )
                return [piece + middle for piece in pieces], note
    raise MeshError(
        f"no simplification of it into {min(most_pieces, MOST_ATTEMPTED)} convex pieces or fewer "
        f"was found that moves its surface by less than {bound:g}: allow more with simplify, or "
        "take its convex hull"
    )


def _hulls(
    decimated: list[Mesh], bound: float, most_planes: int
) -> Iterator[list[NDArray[np.float64]]]:
    """Single pieces, for what is nearly convex."""
    for vertices, _ in decimated:
        hull = hull_corners(vertices)
        yield [hull]
        for share in SHARES:
            yield _plane([hull], bound * share, most_planes)


def _cuts(
    decimated: list[Mesh], bound: float, most_planes: int
) -> Iterator[list[NDArray[np.float64]]]:
    """Pieces of what is not."""
    for vertices, triangles in decimated:
        for share in SHARES:
            yield _plane(_cut(vertices[triangles], bound * share), bound * share, most_planes)


def _cut(corners: NDArray[np.float64], flat: float) -> list[NDArray[np.float64]]:
    """Pieces of a concave mesh (n, 3, 3); none if it has too many planes or they are too many."""
    try:
        if (
            len(corners) > MOST_TRIANGLES
            or at_least_planes(corners, flat, MOST_PLANES) > MOST_PLANES
        ):
            return []
        return Decomposition(corners, flat, MOST_PLANES, MOST_ATTEMPTED).pieces()
    except MeshError:
        return []


def _plane(
    pieces: list[NDArray[np.float64]], flat: float, most_planes: int
) -> list[NDArray[np.float64]]:
    """Pieces with plane faces; none if one of them cannot be given such."""
    try:
        made = [cleaned(piece, flat, most_planes) for piece in pieces]
    except (MeshError, QhullError):
        return []
    return [piece for piece in made if hull_volume(piece) > 0]


def _may_be_near(pieces: list[NDArray[np.float64]], volume: float, bound: float) -> bool:
    """Whether volumes allow it: between two near surfaces is a skin of that thickness.

    Without this, what is far off would be measured only to be refused.
    """
    change = sum(hull_volume(piece) for piece in pieces) - volume
    return abs(change) <= bound * sum(hull_area(piece) for piece in pieces)


def _decimated(surface: Surface, middle: NDArray[np.float64], bound: float) -> list[Mesh]:
    """The surface about its middle in fewer and fewer triangles, from the fewest on."""
    with extra("meshes", "simplified meshes"):
        import manifold3d
    vertices = np.ascontiguousarray(surface.vertices - middle)
    mesh = manifold3d.Mesh64(vertices, np.ascontiguousarray(surface.triangles, dtype=np.uint64))
    manifold = manifold3d.Manifold(mesh)
    if manifold.status() != manifold3d.Error.NoError:
        raise MeshError(
            "it cannot be simplified, since its surface touches itself along edges: give each "
            "part a mesh of its own, or take its convex hull"
        )
    decimated = [manifold.simplify(bound * share).to_mesh64() for share in SHARES]
    return [
        (np.asarray(m.vert_properties)[:, :3], np.asarray(m.tri_verts, dtype=np.int64))
        for m in decimated
        if len(m.tri_verts)
    ]
