"""From a mesh to the convex pieces, or the surface, of one rigid body."""

from __future__ import annotations

from dataclasses import dataclass, field
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.common.arrays import floats
from drystone.common.numbers import optional_number, optional_whole
from drystone.common.text import counted
from drystone.meshes.convex import Decomposition, cleaned
from drystone.meshes.errors import MeshError
from drystone.meshes.hull import deepest, hull_corners, hull_triangles, hull_volume
from drystone.meshes.objects import Split, read_split
from drystone.meshes.plain import plain_volume
from drystone.meshes.planes import at_least_planes
from drystone.meshes.reading import Triangles, read_triangles
from drystone.meshes.rounding import Exactness, assumed, check_tolerance, evened, shown
from drystone.meshes.simplify import Simplification, simplified
from drystone.meshes.surface import Surface, repaired

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from trimesh import Trimesh

FLAT = 3e-7
"""What is within this share of a mesh's diagonal of a plane is in it: five times the rounding of
single precision, in which STL and glTF keep numbers. The pieces' surface is this close to
the mesh's, and so their volume within this times its area, which is checked."""

CONVEX = 1e-7
"""A mesh is convex if its hull has no more volume within this share of it: so exact is its mass."""

MOST_PIECES = 256
"""Convex pieces of a body, unless said otherwise: contacts are found between pieces."""

CUT_PLANES = 100
"""A concave mesh with faces in more planes is a surface unless pieces are asked for: cutting would
take longer than all that is asked of it later, and mostly end with too many pieces."""

SHALLOW = 0.2
"""Radians. Faces that make a hollow edge by turning less are those of a curved or warped surface:
cutting along each makes slivers."""

MOST_PLANES = 2000
"""Planes of a concave mesh's faces. Cutting takes a time that grows with their square."""

FEW_PLANES = 100
"""A convex piece of no more planes than these is cut out of them, so that its faces are plane to
the last bits even if the file's are not; what has more is smooth, its triangles are its faces."""

MOST_CORNERS = 2000
"""Corners of a convex piece, no more than a scene takes: contacts are found between its faces."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Part:
    """One rigid body, made of convex pieces that touch and do not overlap, or within a surface."""

    name: str
    pieces: list[NDArray[np.float64]]
    """The corners (k, 3) of each, metres, in the mesh's own frame. Of a body within a surface one
    array, of the surface's vertices."""
    volume: float
    """Cubic metres, of the mesh; its pieces have the same unless it was simplified."""
    messages: list[str] = field(default_factory=list)
    """What was repaired or taken otherwise than given."""
    simplification: Simplification | None = None
    """What simplifying did; None if that was not asked for."""
    tolerance: float = 0.0
    """Metres that its vertices may be off where they should be, if its faces show that."""
    triangles: NDArray[np.int64] | None = None
    """(n, 3), counter-clockwise from outside, of a body within a surface."""

    def __repr__(self) -> str:
        made = made_of(self.pieces, self.triangles)
        return f"<Part: {self.name!r}, {made}, {self.volume:.4g} m^3>"

    @property
    def density_factor(self) -> float:
        """What makes the pieces weigh as much as the mesh: 1 unless it was simplified."""
        if self.simplification is None:
            return 1.0
        return self.simplification.volume_before / self.simplification.volume_after


def made_of(pieces: list[NDArray[np.float64]], triangles: NDArray[np.int64] | None) -> str:
    """A body's shape in words."""
    if triangles is None:
        return counted(len(pieces), "convex piece")
    return f"a surface of {counted(len(triangles), 'triangle')}"


BEYOND_USE = (ArithmeticError, LookupError, MemoryError, ValueError)
"""What the numbers of a damaged file run a reader into."""


def read_part(
    source: str | PathLike[str] | Trimesh,
    *,
    scale: float | tuple[float, float, float] | None = None,
    name: str | None = None,
    hull: bool = False,
    max_pieces: int | None = None,
    simplify: float | None = None,
    tolerance: float | None = None,
    surface: bool | None = None,
) -> Part:
    """The convex pieces of a file (OBJ, STL, PLY, OFF, glTF, 3MF, STEP) or of a trimesh.Trimesh.

    A mesh that is curved, or would fall into many pieces, is kept as a surface instead, and the
    part's messages say so. `surface=True` keeps any mesh as a surface. With `surface=False`, or
    with `max_pieces`, there are convex pieces or an error.

    - `scale` makes metres of the file's lengths. By default it is the unit that a 3MF or STEP file
      states, else 1.
    - `hull=True` takes the convex hull instead, as most simulators do.
    - `simplify` (metres) is for scans of many triangles: the surface may move by that much, so that
      few pieces remain. The part's `simplification` says how far it moved and how its volume
      changed; `volume` is still that of the mesh.
    - `tolerance` (metres) is how far vertices may be from where they should be: faces that are
      plane within it are made plane. By default, and at least, twice the last decimal place of the
      numbers; 0 takes them as exact.

    Raises MeshError, naming the mesh and the fix, if it encloses no solid or is to have convex
    pieces and falls into more than `max_pieces` (256), and OSError if the file cannot be opened.
    """
    label = fspath(source) if isinstance(source, (str, PathLike)) else name or "the mesh"
    try:
        read = read_triangles(source)
        return part_from(read, scale, name, hull, max_pieces, simplify, tolerance, surface)
    except MeshError as error:
        raise MeshError(f"{label}: {error}") from None
    except BEYOND_USE as error:
        raise MeshError(f"{label}: {_reason(error)}") from error


def read_parts(
    path: str | PathLike[str],
    *,
    split: str | None = None,
    hull: bool = False,
    max_pieces: int | None = None,
    simplify: float | None = None,
    tolerance: float | None = None,
    surface: bool | None = None,
    scale: float | None = None,
) -> tuple[list[Part], Split]:
    """A part for each object or group of a mesh file, as `read_part`, and how it was split.

    `split` is as for `read_split`. A MeshError names the object.
    """
    try:
        found = read_split(path, split)
        options = {
            "hull": hull,
            "max_pieces": max_pieces,
            "simplify": simplify,
            "tolerance": tolerance,
            "surface": surface,
            "scale": scale,
        }
        return [_named(read, found, options) for read in found.parts], found
    except MeshError as error:
        raise MeshError(f"{fspath(path)}: {error}") from None
    except BEYOND_USE as error:
        raise MeshError(f"{fspath(path)}: {_reason(error)}") from error


def _reason(error: Exception) -> str:
    reason = " ".join(str(error).split())[:200]
    return (
        "damaged, or with numbers too large or too small to compute with "
        f"({type(error).__name__}: {reason})"
    )


def _named(read: Triangles, found: Split, options: dict[str, Any]) -> Part:
    try:
        return part_from(read, **options)
    except MeshError as error:
        if len(found.parts) == 1:
            raise
        raise MeshError(f"object {read.name!r}: {error}") from None


def part_from(
    read: Triangles,
    scale: float | tuple[float, float, float] | None = None,
    name: str | None = None,
    hull: bool = False,
    max_pieces: int | None = None,
    simplify: float | None = None,
    tolerance: float | None = None,
    surface: bool | None = None,
) -> Part:
    """The convex pieces of what a file holds; the rest is as for `read_part`."""
    said = None
    max_pieces = optional_whole(max_pieces, "max_pieces")
    simplify = optional_number(simplify, "simplify", MeshError)
    tolerance = optional_number(tolerance, "tolerance", MeshError)
    if scale is None:
        scale = 1.0 if read.unit is None else read.unit
        if scale != 1.0:
            said = f"its file says that a unit of length is {scale:g} m"
    factors = _factors(scale)
    name, vertices, triangles = name or read.name, read.vertices * factors, read.triangles
    if hull:
        part = _hull(name, vertices[np.unique(triangles)], simplify)
    else:
        if np.prod(factors) < 0:
            triangles = triangles[:, ::-1]
        check_tolerance(tolerance)
        plain = None if surface or simplify is not None else plain_volume(vertices, triangles)
        if plain is not None:
            part = Part(name, [vertices], plain)
        else:
            # Numbers are as exact as they were before they were scaled.
            exact = assumed(read.vertices, float(abs(factors).max()), tolerance)
            part = part_of(
                name, vertices, triangles, read.repeats, max_pieces, simplify, exact, surface
            )
    if said is not None:
        part.messages.append(said)
    return part


def part_of(
    name: str,
    vertices: NDArray[np.float64],
    triangles: NDArray[np.int64],
    quietly: bool = False,
    max_pieces: int | None = None,
    simplify: float | None = None,
    exact: Exactness | None = None,
    surface: bool | None = None,
) -> Part:
    """The convex pieces of a surface given as vertices (k, 3), metres, and triangles (n, 3), or the
    surface; see `read_part`.

    `exact` says how far vertices may be from where they should be; by default what the numbers
    show. Faces that are plane within that become plane.
    """
    if simplify is not None:
        most = MOST_PIECES if max_pieces is None else max_pieces
        return _simplified(name, vertices, triangles, quietly, most, simplify)
    pieces_only = max_pieces is not None if surface is None else not surface
    if pieces_only:
        _refuse_too_fine(vertices, triangles)
    mesh = repaired(vertices, triangles.copy(), quietly)
    _check_volume(mesh)
    volume = mesh.volume
    tight = FLAT * mesh.diagonal
    exact = shown(mesh, exact or assumed(mesh.vertices), tight)
    given, before = mesh.vertices, len(mesh.messages)
    if not surface:
        most = MOST_PIECES if max_pieces is None else max_pieces
        try:
            tolerance = evened(mesh, exact, tight, MOST_PLANES)
            pieces = _pieces(mesh, exact, tolerance, volume, most, pieces_only)
            return Part(name, pieces, volume, mesh.messages, tolerance=exact.tolerance)
        except MeshError as reason:
            if pieces_only:
                raise
            del mesh.messages[before:]
            mesh.vertices = given
            mesh.messages.append(f"{_first(reason)}: taken as the surface that it is")
    return Part(
        name,
        [mesh.vertices],
        mesh.volume,
        mesh.messages,
        tolerance=exact.tolerance,
        triangles=mesh.triangles,
    )


def _first(reason: MeshError) -> str:
    """What is wrong, without what to do about it."""
    return str(reason).partition(": ")[0]


def _pieces(
    mesh: Surface,
    exact: Exactness,
    tolerance: float,
    volume: float,
    most: int,
    whatever_it_takes: bool,
) -> list[NDArray[np.float64]]:
    """The convex pieces of a mesh; MeshError if there are more than `most`, or would be."""
    middle = mesh.vertices.mean(axis=0)  # where numbers are exact to the last bits
    if _is_convex(mesh, exact):
        pieces = [mesh.vertices - middle]
    else:
        corners = mesh.corners - middle
        if not whatever_it_takes:
            _refuse_curved(mesh, tolerance)
        pieces = Decomposition(corners, tolerance, MOST_PLANES, most).pieces()
    pieces = _solid(mesh, pieces, tolerance, middle)
    missing = sum(hull_volume(piece) for piece in pieces) - volume
    if abs(missing) > max(max(tolerance, exact.tolerance) * mesh.area, CONVEX * volume):
        raise MeshError(
            f"it encloses {volume:.4g} cubic metres but its convex pieces {volume + missing:.4g}: "
            "its surface goes through itself; join its parts to one solid and export it again"
        )
    for piece in pieces:
        _check_corners(piece)
    return pieces


def _is_convex(surface: Surface, exact: Exactness) -> bool:
    """Whether the convex hull is the solid, but for what its numbers are off."""
    hull = hull_volume(surface.vertices)
    if hull <= (1 + CONVEX) * surface.volume:
        return True
    near = hull <= surface.volume + exact.tolerance * surface.area
    if (
        exact.tolerance == 0
        or not near
        or deepest(surface.vertices, surface.corners) > exact.tolerance
    ):
        return False
    surface.messages.append(f"{exact.reason}: within that it is convex, and taken as its hull")
    return True


def _refuse_curved(mesh: Surface, tolerance: float) -> None:
    """Fail at once on a concave mesh of many planes, or with edges that are hardly hollow."""
    if at_least_planes(mesh.corners, tolerance, CUT_PLANES) > CUT_PLANES:
        raise MeshError(f"it is concave, with faces in more than {CUT_PLANES} planes")
    turns, heights = mesh.hollows()
    shallow = (turns < SHALLOW)[heights > tolerance]
    if 2 * shallow.sum() > len(shallow):
        raise MeshError("it is hollow mostly where its faces turn by little")


def _solid(
    surface: Surface,
    pieces: list[NDArray[np.float64]],
    tolerance: float,
    middle: NDArray[np.float64],
) -> list[NDArray[np.float64]]:
    """Pieces with plane faces, without those that are as thin as the tolerance (metres)."""
    clean = [cleaned(piece, tolerance, FEW_PLANES) for piece in pieces]
    thick = [piece + middle for piece in clean if hull_volume(piece) > 0]
    thin = len(clean) - len(thick)
    if thin:
        surface.messages.append(f"left out {thin} convex pieces that are thinner than rounding")
    return thick


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
    factors = floats(scale, "its scale", MeshError, "be one number or three")
    if factors.shape not in ((), (1,), (3,)):
        raise MeshError(f"its scale must be one number or three, not {scale!r:.80}")
    if not np.isfinite(factors).all() or (factors == 0).any():
        raise MeshError(f"its scale must be finite numbers other than 0, not {scale!r:.80}")
    return np.broadcast_to(factors, 3)
