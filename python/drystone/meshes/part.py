"""From a mesh to the convex pieces of one rigid body."""

from __future__ import annotations

from dataclasses import dataclass, field
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.meshes.convex import Decomposition, cleaned
from drystone.meshes.errors import MeshError
from drystone.meshes.hull import hull_corners, hull_triangles, hull_volume
from drystone.meshes.objects import Split, read_split
from drystone.meshes.planes import at_least_planes
from drystone.meshes.reading import Triangles, read_triangles
from drystone.meshes.simplify import Simplification, simplified
from drystone.meshes.surface import Surface, repaired

if TYPE_CHECKING:
    from numpy.typing import NDArray

FLAT = 3e-7
"""What is within this share of a mesh's diagonal of a plane is in it: five times the rounding of
single precision, in which STL and glTF keep numbers. The pieces' surface is this close to
the mesh's, and so their volume within this times its area, which is checked."""

CONVEX = 1e-7
"""A mesh is convex if its hull has no more volume within this share of it: so exact is its mass."""

MOST_PIECES = 256
"""Convex pieces of a body, unless said otherwise: contacts are found between pieces."""

MOST_PLANES = 2000
"""Planes of a concave mesh's faces. Cutting takes a time that grows with their square."""

FEW_PLANES = 100
"""A convex piece of no more planes than these is cut out of them, so that its faces are plane to
the last bits even if the file's are not; what has more is smooth, its triangles are its faces."""

MOST_CORNERS = 2000
"""Corners of a convex piece, no more than a scene takes: contacts are found between its faces."""


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """One rigid body, made of convex pieces that touch and do not overlap."""

    name: str
    pieces: list[NDArray[np.float64]]
    """The corners (k, 3) of each, metres, in the mesh's own frame."""
    volume: float
    """Cubic metres, of the mesh; its pieces have the same unless it was simplified."""
    messages: list[str] = field(default_factory=list)
    """What was repaired or taken otherwise than given."""
    simplification: Simplification | None = None
    """What simplifying did; None if that was not asked for."""

    @property
    def density_factor(self) -> float:
        """What makes the pieces weigh as much as the mesh: 1 unless it was simplified."""
        if self.simplification is None:
            return 1.0
        return self.simplification.volume_before / self.simplification.volume_after


def read_part(
    source: str | PathLike[str] | Any,
    *,
    scale: float | tuple[float, float, float] = 1.0,
    name: str | None = None,
    hull: bool = False,
    max_pieces: int = MOST_PIECES,
    simplify: float | None = None,
) -> Part:
    """The convex pieces of a mesh file (OBJ, STL, PLY, OFF, glTF, GLB) or of a trimesh.Trimesh.

    `scale` makes metres of the file's units. `hull` takes the convex hull instead, as simulators do
    with meshes. `simplify` (metres) allows the surface to move by so much, so that scans of many
    triangles become few pieces; by how much it moved and its volume changed is the part's
    `simplification`, and its `volume` is still the mesh's. Raises MeshError, naming the mesh and
    the fix, if it encloses no solid or falls into more than `max_pieces` convex pieces, and OSError
    if the file cannot be opened.
    """
    label = fspath(source) if isinstance(source, (str, PathLike)) else name or "the mesh"
    try:
        read = read_triangles(source)
        return part_from(read, scale, name, hull, max_pieces, simplify)
    except MeshError as error:
        raise MeshError(f"{label}: {error}") from None


def read_parts(
    path: str | PathLike[str],
    *,
    split: str | None = None,
    max_pieces: int = MOST_PIECES,
    simplify: float | None = None,
) -> tuple[list[Part], Split]:
    """A part for each object or group of a mesh file, as `read_part`, and how it was split.

    `split` is as for `read_split`. A MeshError names the object.
    """
    try:
        found = read_split(path, split)
        return [_named(read, found, max_pieces, simplify) for read in found.parts], found
    except MeshError as error:
        raise MeshError(f"{fspath(path)}: {error}") from None


def _named(read: Triangles, found: Split, max_pieces: int, simplify: float | None) -> Part:
    try:
        return part_from(read, max_pieces=max_pieces, simplify=simplify)
    except MeshError as error:
        if len(found.parts) == 1:
            raise
        raise MeshError(f"object {read.name!r}: {error}") from None


def part_from(
    read: Triangles,
    scale: float | tuple[float, float, float] = 1.0,
    name: str | None = None,
    hull: bool = False,
    max_pieces: int = MOST_PIECES,
    simplify: float | None = None,
) -> Part:
    """The convex pieces of what a file holds."""
    factors = _factors(scale)
    name, vertices, triangles = name or read.name, read.vertices * factors, read.triangles
    if hull:
        return _hull(name, vertices[np.unique(triangles)], simplify)
    if np.prod(factors) < 0:
        triangles = triangles[:, ::-1]
    return part_of(name, vertices, triangles, read.repeats, max_pieces, simplify)


def part_of(
    name: str,
    vertices: NDArray[np.float64],
    triangles: NDArray[np.int64],
    quietly: bool = False,
    max_pieces: int = MOST_PIECES,
    simplify: float | None = None,
) -> Part:
    """The convex pieces of a surface given as vertices (k, 3), metres, and triangles (n, 3)."""
    if simplify is not None:
        return _simplified(name, vertices, triangles, quietly, max_pieces, simplify)
    _refuse_too_fine(vertices, triangles)
    surface = repaired(vertices, triangles.copy(), quietly)
    tolerance = FLAT * surface.diagonal
    volume, area = surface.volume, surface.area
    _check_volume(surface)
    hull = hull_volume(surface.vertices)
    convex = hull <= (1 + CONVEX) * volume
    middle = surface.vertices.mean(axis=0)  # where numbers are exact to the last bits
    if convex:
        pieces = [surface.vertices - middle]
    else:
        corners = surface.corners - middle
        pieces = Decomposition(corners, tolerance, MOST_PLANES, max_pieces).pieces()
    pieces = [cleaned(piece, tolerance, FEW_PLANES) + middle for piece in pieces]
    pieces = [piece for piece in pieces if len(piece)]
    missing = sum(hull_volume(piece) for piece in pieces) - volume
    if abs(missing) > max(tolerance * area, CONVEX * volume):
        raise MeshError(
            f"it encloses {volume:.4g} cubic metres but its convex pieces {volume + missing:.4g}: "
            "its surface goes through itself; join its parts to one solid and export it again"
        )
    for piece in pieces:
        _check_corners(piece)
    return Part(name, pieces, volume, surface.messages)


def _simplified(
    name: str,
    vertices: NDArray[np.float64],
    triangles: NDArray[np.int64],
    quietly: bool,
    max_pieces: int,
    simplify: float,
) -> Part:
    """A part whose surface moved by no more than `simplify` (metres).

    What cannot be made simpler may have exact pieces: it is refused only if it has none.
    """
    if not 0 < simplify < np.inf:
        raise MeshError(f"simplify must be a positive length in metres, not {simplify!r}")
    surface = repaired(vertices, triangles.copy(), quietly)
    _check_volume(surface)
    try:
        pieces, note = simplified(surface, simplify, FEW_PLANES, max_pieces, MOST_CORNERS)
    except MeshError as refused:
        try:
            return part_of(name, vertices, triangles, quietly, max_pieces)
        except MeshError:
            raise refused from None
    return Part(name, pieces, surface.volume, [*surface.messages, note.message()], note)


def _check_volume(surface: Surface) -> None:
    if surface.volume <= FLAT * surface.diagonal * surface.area:
        raise MeshError("it has no volume: a rigid body needs a thickness")


def _refuse_too_fine(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> None:
    """Fail at once on a mesh of a million triangles that will not do in the end.

    A convex solid of 2 c faces has more than c corners (Euler), and for a concave one there are too
    many planes to cut along.
    """
    if len(triangles) <= 2 * MOST_CORNERS or not np.isfinite(vertices).all():
        return
    tolerance = FLAT * float(np.linalg.norm(np.ptp(vertices, axis=0)))
    most = 2 * MOST_CORNERS
    if at_least_planes(vertices[triangles], tolerance, most) > most:
        raise MeshError(
            f"its {len(triangles)} triangles lie in more than {most} planes: let them be "
            "simplified with simplify, or take its convex hull"
        )


def _hull(name: str, points: NDArray[np.float64], simplify: float | None) -> Part:
    if not np.isfinite(points).all():
        raise MeshError("some of its vertices are not finite numbers: export it again")
    volume = hull_volume(points)
    if volume <= 0:
        raise MeshError("its convex hull is flat: a rigid body needs a thickness")
    piece = hull_corners(points)
    if simplify is not None:
        return part_of(name, *hull_triangles(piece), True, 1, simplify)
    _check_corners(piece)
    return Part(name, [piece], volume)


def _check_corners(piece: NDArray[np.float64]) -> None:
    if len(piece) > MOST_CORNERS:
        raise MeshError(
            f"a convex piece of it has {len(piece)} corners, more than {MOST_CORNERS}: let it be "
            "simplified with simplify"
        )


def _factors(scale: float | tuple[float, float, float]) -> NDArray[np.float64]:
    factors = np.broadcast_to(np.asarray(scale, dtype=float), 3)
    if not np.isfinite(factors).all() or (factors == 0).any():
        raise MeshError(f"its scale must be finite numbers other than 0, not {scale!r}")
    return factors
