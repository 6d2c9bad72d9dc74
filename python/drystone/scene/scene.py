"""Scenes: rigid bodies in the plane or in space, and the points where they touch."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drystone import _core
from drystone.common import later
from drystone.common.drawn import Paged
from drystone.common.files import write_whole
from drystone.common.numbers import (
    Floats,
    name_of,
    number,
    optional_name,
    optional_number,
    vector,
    whole,
)
from drystone.common.text import counted
from drystone.scene.adding import Adding, Point
from drystone.scene.body import Body, Contact, Solid, snapshot
from drystone.scene.loads import Load, listed, turning
from drystone.scene.near_miss import NearMiss
from drystone.scene.overlaps import Overlap
from drystone.scene.settlements import Settlement, require_small
from drystone.scene.settlements import listed as listed_settlements

if TYPE_CHECKING:
    from typing_extensions import Self

    from drystone.common.later import Page


class Scene(Adding, Paged):
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
        if whole(dimension, "dimension") not in (2, 3):
            raise _core.SceneError(
                f"dimension must be 2 (the plane) or 3 (space), not {dimension!r}"
            )
        if gravity is None:
            gravity = (0.0, -9.81) if dimension == 2 else (0.0, 0.0, -9.81)
        self._core = _core.Scene(
            vector(gravity, dimension, "gravity"),
            number(friction, "friction"),
            optional_number(contact_tolerance, "contact_tolerance"),
        )

    @classmethod
    def _of(cls, core: _core.Scene) -> Self:
        """Wrap a scene of the compiled core."""
        scene = cls.__new__(cls)
        scene._core = core
        return scene

    def _put(self, put: Callable[[_core.Scene], str]) -> str:
        return put(self._core)

    def add_load(
        self,
        body: str,
        force: Point | None = None,
        at: Point | None = None,
        moment: float | Floats | None = None,
        name: str | None = None,
    ) -> str:
        """Put a permanent load on a body and return the load's name.

        - `force` (N, along the axes of the world) acts at the point `at` (metres, world
          coordinates), by default at the centroid of the body.
        - `moment` (N m) acts beside it, counter-clockwise; in space it is three numbers, about the
          axes of the world.

        Every question takes the load into account. In motion the point goes with the body, while
        force and moment keep their direction.

        Raises SceneError for an unknown body, a name that another load has, or wrong numbers.

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
            name_of(body),
            [0.0] * n if force is None else vector(force, n, "force"),
            None if at is None else vector(at, n, "at"),
            turning(moment, n),
            optional_name(name),
        )

    def add_pressure(self, body: str, face: Point, pressure: float, name: str | None = None) -> str:
        """Put a pressure on one face of a body and return the load's name.

        `face` is the direction in which the face looks, a vector of any length: (0, 1) is the top.
        The face whose normal is nearest to it is taken, within 45 degrees; of several the outermost
        one, with all pieces of the body that lie in its plane. `pressure` pushes against the face:
        N/m^2, in the plane N/m. What acts on the body is the resultant, a load like those of
        `add_load`.

        Raises SceneError if no face looks there, or two do equally, and for what `add_load` does.
        """
        direction = vector(face, self.dimension, "face (a direction)")
        force = number(pressure, "pressure")
        return _core.add_pressure(self._core, name_of(body), direction, force, optional_name(name))

    def set_friction(self, a: str, b: str, friction: float) -> None:
        """Give two bodies a coefficient of friction for where they touch one another.

        It takes the place of the smaller one of their own coefficients.

        Raises SceneError for an unknown name, one body twice, or a coefficient that is not usable.
        """
        value = number(friction, "friction")
        _core.set_friction(self._core, name_of(a), name_of(b), value)

    def add_settlement(
        self,
        body: str,
        displacement: Point | None = None,
        rotation: float | Floats | None = None,
        at: Point | None = None,
    ) -> None:
        """Prescribe a small displacement of a support, which `check` answers.

        - `displacement` is in metres, along the axes of the world.
        - `rotation` is in radians, counter-clockwise; in space it is three numbers, about the axes
          of the world. It is at most 0.1.
        - `at` (metres, world coordinates) is the point about which the support turns, and whose
          displacement is given: by default the centroid of the body.

        Several settlements of one support add up. `check` says how the blocks follow
        (`Verdict.settled`). Whether a structure stands does not depend on it: for rigid blocks the
        equilibrium is that of the shape before, so `plan`, `limit`, `margin` and `Structure` take
        no notice. `simulate` and `World` refuse a scene with settlements.

        Raises SceneError for an unknown body, one that is not fixed, or wrong numbers, and warns of
        a displacement of more than a tenth of the scene's size.

        >>> import drystone as ds
        >>> scene = ds.Scene(friction=0.5)
        >>> for name, x in (("left", -2), ("right", 2)):
        ...     _ = scene.add_box((x, -0.5), (1, 1), name=name, fixed=True)
        >>> _ = scene.add_box((0, 0.2), (4, 0.4), name="beam")
        >>> scene.add_settlement("right", (0, -0.01))
        >>> settled = ds.check(scene).settled
        >>> [(hinge.b, hinge.at) for hinge in settled.hinges]
        [('beam', (-1.5, 0.0)), ('beam', (2.0, 0.0))]
        """
        n = self.dimension
        moved = (0.0,) * n if displacement is None else vector(displacement, n, "displacement")
        _core.add_settlement(
            self._core,
            name_of(body),
            moved,
            turning(rotation, n, "rotation"),
            None if at is None else vector(at, n, "at"),
        )
        require_small(moved, self.bodies)

    def without_settlements(self) -> Scene:
        """The same scene with all supports where they are."""
        return Scene._of(_core.without_settlements(self._core))

    def with_gravity(self, gravity: Point) -> Scene:
        """The same scene, loads included, under another gravity (m/s^2)."""
        found = vector(gravity, self.dimension, "gravity")
        return Scene._of(_core.with_gravity(self._core, found))

    def extruded(self, depth: float = 1.0) -> Scene:
        """This planar scene in space: (x, y) becomes (x, 0, y), and every block gets a thickness.

        Blocks reach from -`depth` / 2 to `depth` / 2 along y; masses stay what they are.
        """
        return Scene._of(self._core.extruded(number(depth, "depth")))

    def parted(self) -> Scene:
        """The same scene with overlaps taken back, for what was drawn or measured with them.

        Blocks that overlap move apart by the least motion, weighed by their masses, a turn with
        their moments of inertia: to first order in each of several rounds, as a step of `simulate`
        does. Fixed blocks stay. Without overlaps the scene is what it was, to the bit.

        Raises SceneError for blocks that cannot part, such as one jammed between fixed ones, and
        SimulationError where a body that overlaps another is a surface.

        >>> import drystone as ds
        >>> scene = ds.Scene(dimension=2)
        >>> for name, x in (("left", 0), ("right", 0.75)):
        ...     _ = scene.add_box((x, 0.5), (1, 1), name=name)
        >>> [round(float(body.center_of_mass[0]), 6) for body in scene.parted().bodies]
        [-0.125, 0.875]
        """
        return Scene._of(self._core.parted())

    @classmethod
    def from_compas(cls, assembly: object, **options: object) -> Scene:
        """The scene of a COMPAS assembly, model or mesh: a file, or the object itself.

        `options` are those of `drystone.imports.load`, which also says what was left out or taken
        in another way than it was written. compas need not be installed.
        """
        scene: Scene = later.imported(assembly, **options).scene
        return scene

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Self:
        """Read a scene file (JSON, see docs/scene.schema.json).

        Raises FileNotFoundError, or another OSError, if it cannot be opened, and SceneError for
        what is in it. Files of other tools are for `drystone.imports.load`; the SceneError says so.
        """
        try:
            return cls._of(_core.Scene.load(fspath(path)))
        except _core.SceneError:
            said = later.advice(Path(path)) if fspath(path) else None
            if said is not None:
                raise _core.SceneError(said) from None
            with open(path, "rb"):  # the OSError, if there is nothing to read
                raise

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Read a scene from the text of a scene file."""
        return cls._of(_core.Scene.from_json(text))

    def save(self, path: str | PathLike[str]) -> None:
        """Write the scene as JSON. The file is replaced whole or not at all.

        SceneError for a name that says something else, such as one in .stl; OSError if it cannot
        be written.
        """
        if later.lies(Path(path)):
            raise _core.SceneError(
                f"{fspath(path)}: a scene is saved as JSON: let its name end in .json "
                "(draw makes pictures and pages)"
            )
        write_whole(Path(path), self.to_json().encode())

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
        """How far apart bodies may be, or how deep they may overlap, and still touch, metres. None:
        a small fraction of their size."""
        return self._core.contact_tolerance

    @property
    def names(self) -> list[str]:
        """Names of all bodies, fixed ones included, in the order they were added."""
        return self._core.names()

    @property
    def bodies(self) -> list[Body | Solid]:
        """Snapshots of all bodies, in the order they were added.

        Each is a `Body` in the plane, a `Solid` in space.
        """
        return [snapshot(body) for body in self._core.bodies()]

    def body(self, name: str) -> Body | Solid:
        """The body called `name`, a `Body` or a `Solid`; SceneError if there is none."""
        return snapshot(self._core.body(name_of(name)))

    @property
    def loads(self) -> tuple[Load, ...]:
        """The permanent loads, body by body; see `add_load`."""
        return listed(self._core)

    @property
    def settlements(self) -> tuple[Settlement, ...]:
        """The settlements of supports, body by body; see `add_settlement`."""
        return listed_settlements(self._core)

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
        """Every pair of bodies that overlap by more than the contact tolerance. As long as there is
        one, the scene has no contacts and no verdict. Two fixed bodies may overlap."""
        return [Overlap(*pair) for pair in self._core.overlaps()]

    @property
    def near_misses(self) -> list[NearMiss]:
        """Every pair of bodies that do not touch, but would if the contact tolerance were ten times
        larger. Often they were meant to touch."""
        return [NearMiss(*pair) for pair in self._core.near_misses()]

    def __len__(self) -> int:
        return len(self._core)

    def __repr__(self) -> str:
        fixed = sum(body.fixed for body in self._core.bodies())
        where = "" if self.dimension == 2 else " in space"
        count = f"{counted(len(self), 'body', 'bodies')}{where}, {fixed} of them fixed"
        loads = f", {counted(len(self.loads), 'load')}" if self.loads else ""
        if self.settlements:
            loads += f", {counted(len(self.settlements), 'settlement')}"
        return f"<Scene: {count}{loads}, friction {self.friction:g}>"

    def view(self) -> Page:
        """A page with the bodies, to turn and look into; those that overlap are red."""
        return later.page(self)

    def __copy__(self) -> Self:
        return self._of(self._core.copy())

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self.__copy__()

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self).from_json, (self.to_json(),)


def scene_of(scene: Scene) -> Scene:
    """The scene itself; TypeError for what is none."""
    if isinstance(scene, Scene):
        return scene
    hint = ": Scene.load reads a file" if isinstance(scene, str | PathLike) else ""
    raise TypeError(f"a drystone.Scene is wanted, not {scene!r:.80}{hint}")
