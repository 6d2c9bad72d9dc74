"""Scenes: rigid bodies in the plane, and the points where they touch."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

from drystone import _core

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Point = Sequence[float]
"""Two numbers (x, y), in metres unless said otherwise: a tuple, a list or an array."""


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A snapshot of one body of a scene."""

    name: str
    """Unique in its scene."""
    fixed: bool
    """A fixed body never moves, whatever pushes it."""
    density: float
    """kg/m^2: the mass of a square metre of the plane figure."""
    friction: float
    """The body's own coefficient of friction."""
    mass: float
    """kg."""
    inertia: float
    """kg m^2, about the centroid."""
    centroid: tuple[float, float]
    """(x, y) in metres."""
    angle: float
    """Radians, counter-clockwise: how far the body is turned from the outline it was given with
    (a box from upright; corners given as such are not turned)."""
    vertices: NDArray[np.float64]
    """(n, 2), metres, world coordinates, counter-clockwise."""


@dataclass(frozen=True, slots=True)
class Contact:
    """One point where body `a` touches body `b`."""

    a: str
    b: str
    feature: str
    """Which corner meets which side: with the two names, the contact's stable identity."""
    point: tuple[float, float]
    """(x, y) in metres."""
    normal: tuple[float, float]
    """Unit vector from `a` into `b`."""
    gap: float
    """Metres between the bodies here; negative where they overlap within tolerance."""
    friction: float
    """Coefficient of friction of this pair."""


class Scene:
    """Rigid convex bodies in the plane under gravity. SI units throughout.

    >>> import drystone as ds
    >>> scene = ds.Scene(friction=0.5)
    >>> scene.add_box((0, -0.5), (4, 1), name="ground", fixed=True)
    'ground'
    >>> scene.add_box((0, 0.5), (1, 1), name="block")
    'block'
    >>> [contact.point for contact in scene.contacts]
    [(-0.5, 0.0), (0.5, 0.0)]
    """

    __slots__ = ("_core",)

    def __init__(
        self,
        dimension: int = 2,
        gravity: Point = (0.0, -9.81),
        friction: float = 0.5,
        *,
        contact_tolerance: float | None = None,
    ) -> None:
        """Begin an empty scene.

        `gravity` is in m/s^2. `friction` is the coefficient of every body added without its own.
        `contact_tolerance` (metres) is how far apart two bodies may be and still touch, and how
        deep they may overlap; by default a small fraction of the bodies' size.

        Raises SceneError if `dimension` is not 2 or a number is not usable.
        """
        if dimension != 2:
            raise _core.SceneError(
                f"dimension must be 2, not {dimension!r}: scenes in space are not supported yet"
            )
        self._core = _core.Scene(_pair(gravity, "gravity"), friction, contact_tolerance)

    @classmethod
    def _of(cls, core: _core.Scene) -> Scene:
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
    ) -> str:
        """Add a box and return its name.

        `center` and `size` (width, height) are in metres, `angle` in radians counter-clockwise,
        `density` in kg/m^2. Without a `name` the body is called "b0", "b1", ... by its place in
        the scene.

        Raises SceneError, naming the body and the fix, for numbers that are not usable, a name
        already taken, or a box that overlaps another body.
        """
        return self._core.add_box(
            _pair(center, "center"), _pair(size, "size"), angle, name, density, friction, fixed
        )

    def add_polygon(
        self,
        vertices: Iterable[Point],
        name: str | None = None,
        density: float = 1.0,
        friction: float | None = None,
        fixed: bool = False,
    ) -> str:
        """Add a convex polygon and return its name.

        `vertices` are at least three (x, y) in metres, in counter-clockwise order. The other
        arguments and the errors are those of `add_box`.
        """
        corners = [_pair(vertex, "a vertex") for vertex in vertices]
        return self._core.add_polygon(corners, name, density, friction, fixed)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Scene:
        """Read a scene file (JSON, see docs/scene.schema.json)."""
        return cls._of(_core.Scene.load(fspath(path)))

    @classmethod
    def from_json(cls, text: str) -> Scene:
        """Read a scene from the text of a scene file."""
        return cls._of(_core.Scene.from_json(text))

    def save(self, path: str | PathLike[str]) -> None:
        """Write the scene as JSON. The file is replaced whole or not at all."""
        self._core.save(fspath(path))

    def to_json(self) -> str:
        """The text `save` writes."""
        return self._core.to_json()

    @property
    def dimension(self) -> int:
        """2: bodies live in the plane."""
        return 2

    @property
    def gravity(self) -> tuple[float, float]:
        """Acceleration of free fall, m/s^2."""
        return self._core.gravity

    @property
    def friction(self) -> float:
        """Coefficient of friction of bodies added without their own."""
        return self._core.friction

    @property
    def names(self) -> list[str]:
        """Names of all bodies, fixed ones included, in the order they were added."""
        return self._core.names()

    @property
    def bodies(self) -> list[Body]:
        """Snapshots of all bodies, in the order they were added."""
        return [_snapshot(body) for body in self._core.bodies()]

    def body(self, name: str) -> Body:
        """The body called `name`; SceneError if there is none."""
        return _snapshot(self._core.body(name))

    @property
    def contacts(self) -> list[Contact]:
        """Every contact point: both ends of a shared face, the corner of a corner on a face."""
        return [
            Contact(c.a, c.b, c.feature, c.point, c.normal, c.gap, c.friction)
            for c in self._core.contacts()
        ]

    def __len__(self) -> int:
        return len(self._core)

    def __repr__(self) -> str:
        fixed = sum(body.fixed for body in self._core.bodies())
        return f"<Scene: {len(self)} bodies, {fixed} of them fixed, friction {self.friction:g}>"

    def draw(self, path: str | PathLike[str]) -> None:
        """Write a picture of the scene; the name ends in .svg or .png."""
        from drystone import pictures

        pictures.save(pictures.scene_figure(self), path)

    def _repr_svg_(self) -> str:
        from drystone import pictures

        return pictures.svg(pictures.scene_figure(self))

    def __reduce__(self) -> tuple[Any, ...]:
        return Scene.from_json, (self.to_json(),)


def _pair(value: Point, what: str) -> tuple[float, float]:
    """`value` as two floats; SceneError naming `what` otherwise."""
    try:
        x, y = value
        return float(x), float(y)
    except (TypeError, ValueError):
        raise _core.SceneError(f"{what} must be two numbers (x, y), not {value!r}") from None


def _snapshot(body: _core.Body) -> Body:
    return Body(
        body.name,
        body.fixed,
        body.density,
        body.friction,
        body.mass,
        body.inertia,
        body.centroid,
        body.angle,
        body.vertices,
    )
