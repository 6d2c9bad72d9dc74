"""How bodies are added, to a scene at rest or to a world in motion."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from os import PathLike
from typing import TYPE_CHECKING, TypeAlias, TypedDict, TypeVar
from warnings import warn

from drystone import _core
from drystone.common.numbers import (
    Floats,
    flag,
    number,
    optional_name,
    optional_number,
    pair,
    quaternion,
    triple,
)
from drystone.scene import weight
from drystone.scene.weight import Inertia

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray
    from trimesh import Trimesh

_T = TypeVar("_T")

Point: TypeAlias = Floats
"""Two numbers (x, y), in space three (x, y, z), in metres unless said otherwise: a tuple, a list or
an array."""

ORIGIN = (0.0, 0.0, 0.0)
UPRIGHT = (1.0, 0.0, 0.0, 0.0)
"""The quaternion (w, x, y, z) that turns nothing."""


class Adding:
    """The methods that add a body; what they take and refuse is the same everywhere."""

    __slots__ = ()

    @property
    def dimension(self) -> int:
        """2: bodies live in the plane. 3: in space."""
        raise NotImplementedError

    def _put(self, put: Callable[[_core.Scene], str]) -> str:
        """Let `put` add a body to a scene of the core, and return its name."""
        raise NotImplementedError

    def add_box(
        self,
        center: Point,
        size: Point,
        angle: float = 0.0,
        name: str | None = None,
        density: float = 1.0,
        friction: float | None = None,
        fixed: bool = False,
        *,
        orientation: Floats = UPRIGHT,
        mass: float | None = None,
        center_of_mass: Point | None = None,
        inertia: Inertia | None = None,
    ) -> str:
        """Add a box and return its name.

        `center` and `size` (width, height; in space along x, y and z) are in metres, `density` in
        kg/m^2 (in space kg/m^3; stone has some 2400). Without it all bodies are of the same light
        stuff, 1 kg/m^2: then verdicts, margins and orders are right, but loads and pushes in
        newtons mean little beside it. In the plane the box is turned by `angle`, in radians
        counter-clockwise; in space by `orientation`, a quaternion (w, x, y, z). Without a `name`
        the body is called "b0", "b1", ... by its place in the scene.

        `mass` (kg) takes the place of the density. `center_of_mass` (metres) is given from the
        box's middle along its sides, `inertia` (kg m^2; in space (3, 3)) about the centre of mass
        along these sides. Without them they are those of the shape, evenly filled with the mass.

        Raises SceneError, naming the body and the fix, for numbers that are not usable or a name
        already taken. Bodies that overlap are an error of the first question asked of the scene.
        """
        if self.dimension == 2:
            if orientation is not UPRIGHT and quaternion(orientation) != UPRIGHT:
                raise _core.SceneError("a box in the plane is turned by angle=, not orientation=")
            turn = number(angle, "angle")
            _require_radians(turn)
            corner, sides = pair(center, "center"), pair(size, "size")
            own = weight.in_plane(mass, center_of_mass, inertia)
            return self._put(
                lambda core: core.add_box(
                    corner, sides, turn, optional_name(name), *_stuff(density, friction, fixed), own
                )
            )
        if number(angle, "angle") != 0.0:
            raise _core.SceneError("a box in space is turned by orientation=, not angle=")
        return self._put(
            lambda core: core.add_cuboid(
                triple(center, "center"),
                triple(size, "size"),
                quaternion(orientation),
                optional_name(name),
                *_stuff(density, friction, fixed),
                weight.in_space(mass, center_of_mass, inertia),
            )
        )

    def add_polygon(
        self,
        vertices: Iterable[Point],
        name: str | None = None,
        density: float = 1.0,
        friction: float | None = None,
        fixed: bool = False,
        *,
        mass: float | None = None,
        center_of_mass: Point | None = None,
        inertia: Inertia | None = None,
    ) -> str:
        """Add a convex polygon and return its name.

        `vertices` are at least three (x, y) in metres, in order round it; the first may be given
        again at the end. `center_of_mass` is a point like them. The other arguments and the errors
        are those of `add_box`.
        """
        if self.dimension == 3:
            raise _core.SceneError(
                "this scene is in space, where bodies are solids: add_polyhedron takes their "
                "corners, add_box their size"
            )
        corners = [pair(vertex, "a vertex") for vertex in _each(vertices, "vertices")]
        own = weight.in_plane(mass, center_of_mass, inertia)
        return self._put(
            lambda core: core.add_polygon(
                corners, optional_name(name), *_stuff(density, friction, fixed), own
            )
        )

    def add_polyhedron(
        self,
        vertices: Iterable[Point],
        name: str | None = None,
        density: float = 1.0,
        friction: float | None = None,
        fixed: bool = False,
        *,
        position: Point = ORIGIN,
        orientation: Floats = UPRIGHT,
        mass: float | None = None,
        center_of_mass: Point | None = None,
        inertia: Inertia | None = None,
    ) -> str:
        """Add the convex hull of points in space and return its name.

        `vertices` are at least four (x, y, z) in metres, in any order, in a frame that stands at
        `position`, turned by `orientation`: the world's own by default. `center_of_mass` and
        `inertia` are given in that frame. The other arguments and the errors are those of
        `add_box`.
        """
        return self.add_solid(
            [vertices],
            name,
            density,
            friction,
            fixed,
            position=position,
            orientation=orientation,
            mass=mass,
            center_of_mass=center_of_mass,
            inertia=inertia,
        )

    def add_solid(
        self,
        pieces: Iterable[Iterable[Point]],
        name: str | None = None,
        density: float = 1.0,
        friction: float | None = None,
        fixed: bool = False,
        *,
        position: Point = ORIGIN,
        orientation: Floats = UPRIGHT,
        mass: float | None = None,
        center_of_mass: Point | None = None,
        inertia: Inertia | None = None,
    ) -> str:
        """Add one rigid body made of convex pieces and return its name.

        Each piece is the convex hull of its points, as `add_polyhedron` takes them. Pieces may
        touch. They may overlap only if the body is fixed or its `mass` is given: otherwise the
        overlap would be weighed twice. Where pieces overlap, a centre of mass and an inertia that
        are not given are computed as if each piece were whole.
        """
        hulls = [
            [triple(vertex, "a vertex") for vertex in _each(piece, "a piece")]
            for piece in _each(pieces, "pieces")
        ]
        return self._put(
            lambda core: core.add_solid(
                hulls,
                triple(position, "position"),
                quaternion(orientation),
                optional_name(name),
                *_stuff(density, friction, fixed),
                weight.in_space(mass, center_of_mass, inertia),
            )
        )

    def add_surface(
        self,
        vertices: ArrayLike,
        triangles: ArrayLike,
        name: str | None = None,
        density: float = 1.0,
        friction: float | None = None,
        fixed: bool = False,
        *,
        position: Point = ORIGIN,
        orientation: Floats = UPRIGHT,
        mass: float | None = None,
        center_of_mass: Point | None = None,
        inertia: Inertia | None = None,
    ) -> str:
        """Add one rigid body within a closed surface and return its name.

        `vertices` (k, 3) are in metres, in a frame that stands at `position`, turned by
        `orientation`; `triangles` (n, 3) are numbers of vertices, counter-clockwise seen from
        outside. The body may be concave and curved and have hollows. Its contacts are found on the
        surface itself (docs/theory/contacts-of-surfaces.md). `check` and `plan` take such bodies,
        `simulate` does not. `add_mesh` does the same, and mends small faults of a mesh first.

        The other arguments and the errors are those of `add_box`; SceneError too for a surface
        that is not closed.
        """
        points, numbers = _surface(vertices, triangles)
        return self._put(
            lambda core: core.add_surface(
                points,
                numbers,
                triple(position, "position"),
                quaternion(orientation),
                optional_name(name),
                *_stuff(density, friction, fixed),
                weight.in_space(mass, center_of_mass, inertia),
            )
        )

    def add_mesh(
        self,
        mesh: str | PathLike[str] | Trimesh,
        position: Point = ORIGIN,
        orientation: Floats = UPRIGHT,
        scale: float | tuple[float, float, float] | None = None,
        name: str | None = None,
        density: float = 1.0,
        friction: float | None = None,
        fixed: bool = False,
        *,
        hull: bool = False,
        max_pieces: int | None = None,
        simplify: float | None = None,
        tolerance: float | None = None,
        surface: bool | None = None,
        mass: float | None = None,
        center_of_mass: Point | None = None,
        inertia: Inertia | None = None,
    ) -> str:
        """Add a mesh as one rigid body and return its name.

        `mesh` is a file (OBJ, STL, PLY, OFF, glTF, 3MF, STEP) or a trimesh.Trimesh: a closed
        surface, in a frame that stands at `position`, turned by `orientation`. `scale` makes metres
        of its lengths; by default it is the unit that a 3MF or STEP file states, else 1. A file of
        several objects becomes one body, too; `imports.load` makes one of each.

        A mesh of few faces is cut into convex pieces, exactly. A curved one, or one that would fall
        into many pieces, is kept as a surface, as by `add_surface`, and a MeshWarning says so.
        `surface=True` keeps any mesh as a surface. With `surface=False`, or with `max_pieces`,
        there are convex pieces or an error.

        - `hull=True` takes the convex hull instead.
        - `simplify` (metres) is for scans of many triangles: the surface may move by that much, so
          that few pieces remain. The body weighs what the mesh does; its density is adapted.
        - `tolerance` (metres) is how far vertices may be from where they should be: faces that are
          plane within it are made plane. By default it is twice the last decimal place of the
          numbers; 0 takes them as exact.

        What is mended, made plane or simplified is said in a MeshWarning.

        Raises MeshError, naming the mesh and the fix, if it encloses no solid, or is to have convex
        pieces and falls into more than `max_pieces` (256), and the errors of `add_solid`.
        """
        from drystone import meshes

        part = meshes.read_part(
            mesh,
            scale=scale,
            name=name,
            hull=hull,
            max_pieces=max_pieces,
            simplify=simplify,
            tolerance=tolerance,
            surface=surface,
        )
        for message in part.messages:
            warn(f"{part.name}: {message}", meshes.MeshWarning, stacklevel=2)
        options: _Options = {
            "density": number(density, "density") * part.density_factor,
            "friction": friction,
            "fixed": fixed,
            "position": position,
            "orientation": orientation,
            "mass": mass,
            "center_of_mass": center_of_mass,
            "inertia": inertia,
        }
        if part.triangles is None:
            return self.add_solid(part.pieces, name, **options)
        return self.add_surface(part.pieces[0], part.triangles, name, **options)


class _Options(TypedDict):
    """What `add_solid` and `add_surface` take alike."""

    density: float
    friction: float | None
    fixed: bool
    position: Point
    orientation: Floats
    mass: float | None
    center_of_mass: Point | None
    inertia: Inertia | None


def _stuff(density: float, friction: float | None, fixed: bool) -> tuple[float, float | None, bool]:
    """What a body is of, as the core takes it."""
    return (
        number(density, "density"),
        optional_number(friction, "friction"),
        flag(fixed, "fixed"),
    )


def _require_radians(angle: float) -> None:
    """A hint where an angle looks like one in degrees."""
    if math.tau < abs(angle) < math.inf:
        warn(
            f"angle is {angle:g} radians, more than a full turn: if these are degrees, "
            "give math.radians of them",
            UserWarning,
            stacklevel=3,
        )


def _each(values: Iterable[_T], what: str) -> Iterable[_T]:
    try:
        return iter(values)
    except TypeError:
        raise TypeError(f"{what} must be a list of points, not {values!r:.80}") from None


def _surface(
    vertices: ArrayLike, triangles: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.uint32]]:
    """Arrays (k, 3) and (n, 3); TypeError or SceneError for what is none."""
    import numpy as np

    from drystone.common.arrays import floats

    points = floats(vertices, "vertices", _core.SceneError, "be an array of three coordinates each")
    corners = floats(triangles, "triangles", _core.SceneError, "be numbers of vertices")
    if points.ndim != 2 or points.shape[1] != 3:
        raise _core.SceneError(f"vertices must be (k, 3), not {points.shape}")
    fits = corners.ndim == 2 and corners.shape[1] == 3 and (corners == np.floor(corners)).all()
    if not fits or ((corners < 0) | (corners >= len(points))).any():
        raise _core.SceneError(
            f"triangles must be (n, 3) numbers of vertices, each from 0 to {len(points) - 1}"
        )
    return points, corners.astype(np.uint32)
