"""Scenes: rigid bodies in the plane or in space, and the points where they touch."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any
from warnings import warn

from drystone import _core
from drystone.common import later
from drystone.common.numbers import number, vector
from drystone.scene import weight
from drystone.scene.body import Contact, snapshot
from drystone.scene.loads import Load, listed, turning
from drystone.scene.near_miss import NearMiss
from drystone.scene.overlaps import Overlap
from drystone.scene.weight import Inertia

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray
    from typing_extensions import Self

    from drystone.common.later import Page

Point = Sequence[float]
"""Two numbers (x, y), in space three (x, y, z), in metres unless said otherwise: a tuple, a list or
an array."""


ORIGIN = (0.0, 0.0, 0.0)
UPRIGHT = (1.0, 0.0, 0.0, 0.0)
"""The quaternion (w, x, y, z) that turns nothing."""


class Scene:
    """Rigid bodies under gravity, in the plane or in space. SI units throughout.

    >>> import drystone as ds
    >>> scene = ds.Scene(friction=0.5)
    >>> scene.add_box((0, -0.5), (4, 1), name="ground", fixed=True)
    'ground'
    >>> scene.add_box((0, 0.5), (1, 1), name="block")
    'block'
    >>> [contact.point for contact in scene.contacts]
    [(-0.5, 0.0), (0.5, 0.0)]

    In space z is up, and boxes have three sides:

    >>> space = ds.Scene(dimension=3)
    >>> space.add_box((0, 0, -0.5), (4, 4, 1), name="ground", fixed=True)
    'ground'
    >>> space.add_box((0, 0, 0.5), (1, 1, 1), name="cube")
    'cube'
    >>> len(space.contacts)
    4
    """

    __slots__ = ("_core",)

    def __init__(
        self,
        dimension: int = 2,
        gravity: Point | None = None,
        friction: float = 0.5,
        *,
        contact_tolerance: float | None = None,
    ) -> None:
        """Begin an empty scene.

        `dimension` is 2 for the plane or 3 for space. `gravity` is in m/s^2, by default 9.81
        downwards: along -y in the plane, along -z in space. `friction` is the coefficient of every
        body added without its own. `contact_tolerance` (metres) is how far apart two bodies may be
        and still touch, and how deep they may overlap; by default a small fraction of the bodies'
        size.

        Raises SceneError if `dimension` is neither 2 nor 3 or a number is not usable.
        """
        if dimension not in (2, 3):
            raise _core.SceneError(
                f"dimension must be 2 (the plane) or 3 (space), not {dimension!r}"
            )
        if gravity is None:
            gravity = (0.0, -9.81) if dimension == 2 else (0.0, 0.0, -9.81)
        take = _pair if dimension == 2 else _triple
        self._core = _core.Scene(take(gravity, "gravity"), friction, contact_tolerance)

    @classmethod
    def _of(cls, core: _core.Scene) -> Self:
        """Wrap a scene of the compiled core."""
        scene = cls.__new__(cls)
        scene._core = core
        return scene

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
        orientation: Sequence[float] = UPRIGHT,
        mass: float | None = None,
        center_of_mass: Point | None = None,
        inertia: Inertia | None = None,
    ) -> str:
        """Add a box and return its name.

        `center` and `size` (width, height; in space along x, y and z) are in metres, `density` in
        kg/m^2 (in space kg/m^3). In the plane the box is turned by `angle`, in radians
        counter-clockwise; in space by `orientation`, a quaternion (w, x, y, z). Without a `name`
        the body is called "b0", "b1", ... by its place in the scene.

        `mass` (kg) takes the place of the density. `center_of_mass` (metres) is given from the
        box's middle along its sides, `inertia` (kg m^2; in space (3, 3)) about the centre of mass
        along these sides. Without them they are those of the shape, evenly filled with the mass.

        Raises SceneError, naming the body and the fix, for numbers that are not usable or a name
        already taken. Bodies that overlap are an error of the first question asked of the scene.
        """
        if self.dimension == 2:
            if tuple(orientation) != UPRIGHT:
                raise _core.SceneError("a box in the plane is turned by angle=, not orientation=")
            corner, sides = _pair(center, "center"), _pair(size, "size")
            own = weight.in_plane(mass, center_of_mass, inertia)
            return self._core.add_box(
                corner, sides, angle, _name(name), density, friction, fixed, own
            )
        if angle != 0.0:
            raise _core.SceneError("a box in space is turned by orientation=, not angle=")
        return self._core.add_cuboid(
            _triple(center, "center"),
            _triple(size, "size"),
            _quaternion(orientation),
            _name(name),
            density,
            friction,
            fixed,
            weight.in_space(mass, center_of_mass, inertia),
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

        `vertices` are at least three (x, y) in metres, in counter-clockwise order;
        `center_of_mass` is a point like them. The other arguments and the errors are those of
        `add_box`.
        """
        if self.dimension == 3:
            raise _core.SceneError(
                "this scene is in space, where bodies are solids: add_polyhedron takes their "
                "corners, add_box their size"
            )
        corners = [_pair(vertex, "a vertex") for vertex in vertices]
        own = weight.in_plane(mass, center_of_mass, inertia)
        return self._core.add_polygon(corners, _name(name), density, friction, fixed, own)

    def add_polyhedron(
        self,
        vertices: Iterable[Point],
        name: str | None = None,
        density: float = 1.0,
        friction: float | None = None,
        fixed: bool = False,
        *,
        position: Point = ORIGIN,
        orientation: Sequence[float] = UPRIGHT,
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
        orientation: Sequence[float] = UPRIGHT,
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
        return self._core.add_solid(
            [[_triple(vertex, "a vertex") for vertex in piece] for piece in pieces],
            _triple(position, "position"),
            _quaternion(orientation),
            _name(name),
            density,
            friction,
            fixed,
            weight.in_space(mass, center_of_mass, inertia),
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
        orientation: Sequence[float] = UPRIGHT,
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
        return self._core.add_surface(
            *_surface(vertices, triangles),
            _triple(position, "position"),
            _quaternion(orientation),
            _name(name),
            density,
            friction,
            fixed,
            weight.in_space(mass, center_of_mass, inertia),
        )

    def add_mesh(
        self,
        mesh: str | PathLike[str] | Any,
        position: Point = ORIGIN,
        orientation: Sequence[float] = UPRIGHT,
        scale: float | tuple[float, float, float] = 1.0,
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

        `mesh` is a file (OBJ, STL, PLY, OFF, glTF, GLB) or a trimesh.Trimesh: a closed surface, in
        a frame that stands at `position`, turned by `orientation`. `scale` makes metres of its
        lengths. A file of several objects becomes one body, too; `imports.load` makes one of each.

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
        options: dict[str, Any] = {
            "density": density * part.density_factor,
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

    def add_load(
        self,
        body: str,
        force: Point | None = None,
        at: Point | None = None,
        moment: float | Sequence[float] | None = None,
        name: str | None = None,
    ) -> str:
        """Put a permanent load on a body and return the load's name.

        `force` (N, world axes) acts at the point `at` (metres, world coordinates), by default at
        the centroid of the body; `moment` (N m) beside it, counter-clockwise, in space three
        numbers about the axes of the world. Every question takes it into account. In motion the
        point goes with the body, and force and moment keep their direction.

        Raises SceneError for an unknown body, a name that another load has, wrong numbers.

        >>> import drystone as ds
        >>> scene = ds.scenes.slope(20, friction=0.5)
        >>> scene.add_load("1", force=(-2.0, 0.0), name="wind")
        'wind'
        >>> scene.loads[0].force
        (-2.0, 0.0)
        """
        n = self.dimension
        return _core.add_load(
            self._core,
            _name(body) or "",
            [0.0] * n if force is None else vector(force, n, "force"),
            None if at is None else vector(at, n, "at"),
            turning(moment, n),
            _name(name),
        )

    def add_pressure(self, body: str, face: Point, pressure: float, name: str | None = None) -> str:
        """Load the face of a body that looks in the direction `face` and return the load's name.

        `pressure` in N/m^2 pushes against the face; in the plane in N/m, for each metre of its
        length. `face` need not be a unit vector. Of the faces whose normals are nearest to it,
        within 45 degrees, the outermost is taken: for a body of several pieces all that lie in that
        plane. What acts on the body is the resultant, a load like those of `add_load`.

        Raises SceneError if no face looks there, or two alike, and for what `add_load` does.
        """
        direction = vector(face, self.dimension, "face (a direction)")
        force = number(pressure, "pressure")
        return _core.add_pressure(self._core, _name(body) or "", direction, force, _name(name))

    def set_friction(self, a: str, b: str, friction: float) -> None:
        """Give the contacts of two bodies a coefficient of their own, whatever those of the two.

        Raises SceneError for an unknown name, one body twice, or a coefficient that is not usable.
        """
        value = number(friction, "friction")
        _core.set_friction(self._core, _name(a) or "", _name(b) or "", value)

    def with_gravity(self, gravity: Point) -> Scene:
        """The same scene, loads included, under another gravity (m/s^2)."""
        found = vector(gravity, self.dimension, "gravity")
        return Scene._of(_core.with_gravity(self._core, found))

    def extruded(self, depth: float = 1.0) -> Scene:
        """This planar scene in space: (x, y) becomes (x, 0, y), and every block gets a thickness.

        Blocks reach from -`depth` / 2 to `depth` / 2 along y; masses stay what they are.
        """
        return Scene._of(self._core.extruded(depth))

    @classmethod
    def from_compas(cls, assembly: Any, **options: Any) -> Scene:
        """The scene of a COMPAS assembly, model or mesh: a file, or the object itself.

        `options` are those of `drystone.imports.load`, whose `Imported` also says what was left
        out or taken otherwise than given. compas need not be installed.
        """
        scene: Scene = later.imported(assembly, **options).scene
        return scene

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Self:
        """Read a scene file (JSON, see docs/scene.schema.json).

        Files of other tools are for `drystone.imports.load`; the SceneError says so.
        """
        try:
            return cls._of(_core.Scene.load(fspath(path)))
        except _core.SceneError:
            said = later.advice(Path(path))
            if said is None:
                raise
            raise _core.SceneError(said) from None

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Read a scene from the text of a scene file."""
        return cls._of(_core.Scene.from_json(text))

    def save(self, path: str | PathLike[str]) -> None:
        """Write the scene as JSON. The file is replaced whole or not at all.

        SceneError for a name that says something else, such as one in .stl.
        """
        if later.lies(Path(path)):
            raise _core.SceneError(f"{fspath(path)}: a scene is JSON: let its name end in .json")
        self._core.save(fspath(path))

    def to_json(self) -> str:
        """The text `save` writes."""
        return self._core.to_json()

    @property
    def dimension(self) -> int:
        """2: bodies live in the plane. 3: in space."""
        return self._core.dimension

    @property
    def gravity(self) -> tuple[float, ...]:
        """Acceleration of free fall, m/s^2."""
        return self._core.gravity

    @property
    def friction(self) -> float:
        """Coefficient of friction of bodies added without their own."""
        return self._core.friction

    @property
    def contact_tolerance(self) -> float | None:
        """Gap or overlap up to which two bodies touch, metres; None for a share of their size."""
        return self._core.contact_tolerance

    @property
    def names(self) -> list[str]:
        """Names of all bodies, fixed ones included, in the order they were added."""
        return self._core.names()

    @property
    def bodies(self) -> list[Any]:
        """Snapshots of all bodies, in the order they were added.

        Each is a `Body` in the plane, a `Solid` in space.
        """
        return [snapshot(body) for body in self._core.bodies()]

    def body(self, name: str) -> Any:
        """The body called `name`, a `Body` or a `Solid`; SceneError if there is none."""
        return snapshot(self._core.body(_name(name) or ""))

    @property
    def loads(self) -> tuple[Load, ...]:
        """The permanent loads, body by body; see `add_load`."""
        return listed(self._core)

    @property
    def pair_friction(self) -> dict[tuple[str, str], float]:
        """Pairs of bodies with a coefficient of friction of their own; see `set_friction`."""
        return {(a, b): friction for a, b, friction in _core.pair_frictions(self._core)}

    @property
    def contacts(self) -> list[Contact]:
        """Every contact point: both ends of a shared face, the corner of a corner on a face.

        In space every corner of the polygon that two faces share, both ends of an edge on a face,
        and where an edge crosses an edge. Where only borders meet, such as a corner on a corner,
        there is a contact too unless another body parts the two there; see `Contact.at_borders`.
        """
        return [
            Contact(c.a, c.b, c.feature, c.point, c.normal, c.gap, c.friction, c.at_borders)
            for c in self._core.contacts()
        ]

    @property
    def overlaps(self) -> list[Overlap]:
        """Every pair of bodies that overlap by more than the contact tolerance; a scene with one
        has no contacts and no verdict. Two fixed bodies may overlap."""
        return [Overlap(*pair) for pair in self._core.overlaps()]

    @property
    def near_misses(self) -> list[NearMiss]:
        """Every pair of bodies that do not touch, but would with a contact tolerance ten times
        larger: gaps that nothing was meant to have, or to be without."""
        return [NearMiss(*pair) for pair in self._core.near_misses()]

    def __len__(self) -> int:
        return len(self._core)

    def __repr__(self) -> str:
        fixed = sum(body.fixed for body in self._core.bodies())
        where = "" if self.dimension == 2 else " in space"
        count = f"{len(self)} bodies{where}, {fixed} of them fixed"
        loads = f", {len(self.loads)} loads" if self.loads else ""
        return f"<Scene: {count}{loads}, friction {self.friction:g}>"

    def draw(self, path: str | PathLike[str]) -> None:
        """Write a picture of the scene (.svg or .png), or a page to look at it (.html).

        Bodies that overlap are red; the picture says how deep.
        """
        if fspath(path).lower().endswith(".html"):
            self.view().save(path)
            return
        later.save_figure(later.figure(self), path)

    def view(self) -> Page:
        """A page with the bodies, to turn and look into; save it, or let a notebook show it."""
        return later.page(self)

    def _repr_svg_(self) -> str | None:
        return later.svg_if_possible(self)

    def __copy__(self) -> Self:
        return self._of(self._core.copy())

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self.__copy__()

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self).from_json, (self.to_json(),)


def _name(name: str | None) -> str | None:
    """A name as the core takes it; SceneError for what is no text."""
    if name is None:
        return None
    try:
        name.encode()
    except (AttributeError, UnicodeEncodeError):
        raise _core.SceneError(f"a name must be text, not {name!r:.60}") from None
    return name


def _pair(value: Point, what: str) -> tuple[float, float]:
    """`value` as two floats; SceneError naming `what` otherwise."""
    try:
        x, y = value
        return float(x), float(y)
    except (TypeError, ValueError):
        raise _core.SceneError(f"{what} must be two numbers (x, y), not {value!r}") from None


def _triple(value: Point, what: str) -> tuple[float, float, float]:
    """`value` as three floats; SceneError naming `what` otherwise."""
    try:
        x, y, z = value
        return float(x), float(y), float(z)
    except (TypeError, ValueError):
        raise _core.SceneError(f"{what} must be three numbers (x, y, z), not {value!r}") from None


def _surface(
    vertices: ArrayLike, triangles: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.uint32]]:
    """Arrays (k, 3) and (n, 3); SceneError for what is none."""
    import numpy as np

    try:
        points, numbers = np.asarray(vertices, dtype=np.float64), np.asarray(triangles)
    except (TypeError, ValueError):
        raise _core.SceneError("vertices must be an array of three coordinates each") from None
    if points.ndim != 2 or points.shape[1] != 3:
        raise _core.SceneError(f"vertices must be (k, 3), not {points.shape}")
    whole = numbers.ndim == 2 and numbers.shape[1] == 3 and np.issubdtype(numbers.dtype, np.integer)
    if not whole or ((numbers < 0) | (numbers >= len(points))).any():
        raise _core.SceneError(
            f"triangles must be (n, 3) numbers of vertices, each from 0 to {len(points) - 1}"
        )
    return points, numbers.astype(np.uint32)


def _quaternion(value: Sequence[float]) -> tuple[float, float, float, float]:
    try:
        w, x, y, z = value
        return float(w), float(x), float(y), float(z)
    except (TypeError, ValueError):
        raise _core.SceneError(
            f"orientation must be a quaternion (w, x, y, z), not {value!r}"
        ) from None
