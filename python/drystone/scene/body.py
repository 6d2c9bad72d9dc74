"""Snapshots of a scene's bodies, and of the points where they touch."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from drystone import _core
from drystone.common.text import digits, place

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Body:
    """A snapshot of one body of a scene in the plane."""

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
    """kg m^2, about the centre of mass."""
    center_of_mass: tuple[float, float]
    """(x, y) in metres: where the body's frame stands. The centroid, unless another was given."""
    angle: float
    """Radians, counter-clockwise: how far the body is turned from the outline it was given with
    (a box from upright; corners given as such are not turned)."""
    vertices: NDArray[np.float64]
    """(n, 2), metres, world coordinates, counter-clockwise."""
    offset: tuple[float, float]
    """Where the centroid is in the body's frame, metres."""

    def __repr__(self) -> str:
        return _line("Body", self)

    @property
    def centroid(self) -> tuple[float, float]:
        """(x, y) in metres: the middle of the shape."""
        (x, y), (a, b) = self.center_of_mass, self.offset
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        return x + cos * a - sin * b, y + sin * a + cos * b


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Piece:
    """One convex piece of a body in space."""

    vertices: NDArray[np.float64]
    """(k, 3), metres, in the body's frame, whose origin is the centre of mass."""
    faces: tuple[tuple[int, ...], ...]
    """Vertices of each face, counter-clockwise seen from outside."""

    def __repr__(self) -> str:
        return f"<Piece: {len(self.vertices)} corners, {len(self.faces)} faces>"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Surface:
    """The closed surface of a body in space."""

    vertices: NDArray[np.float64]
    """(k, 3), metres, in the body's frame, whose origin is the centre of mass."""
    triangles: NDArray[np.uint32]
    """(n, 3): vertices of each triangle, counter-clockwise seen from outside."""

    def __repr__(self) -> str:
        return f"<Surface: {len(self.vertices)} vertices, {len(self.triangles)} triangles>"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Solid:
    """A snapshot of one body of a scene in space."""

    name: str
    """Unique in its scene."""
    fixed: bool
    """A fixed body never moves, whatever pushes it."""
    density: float
    """kg/m^3."""
    friction: float
    """The body's own coefficient of friction."""
    mass: float
    """kg."""
    inertia: NDArray[np.float64]
    """(3, 3), kg m^2, about the centre of mass along the axes of the world."""
    center_of_mass: tuple[float, float, float]
    """(x, y, z), metres: where the body's frame stands. The centroid, unless another was given."""
    orientation: tuple[float, float, float, float]
    """Unit quaternion (w, x, y, z): how far the body is turned from the shape it was given with."""
    box_size: tuple[float, float, float] | None
    """Sides of a box, metres."""
    pieces: tuple[Piece, ...]
    """Its convex pieces, in the body's frame; none of a body that has a surface."""
    vertices: NDArray[np.float64]
    """(n, 3), metres: every corner of every piece, or of the surface, in world coordinates."""
    offset: tuple[float, float, float]
    """Where the centroid is in the body's frame, metres."""
    surface: Surface | None = None
    """The surface of a body that is not made of convex pieces."""

    def __repr__(self) -> str:
        return _line("Solid", self)

    @property
    def centroid(self) -> tuple[float, float, float]:
        """(x, y, z) in metres: the middle of the shape."""
        (x, y, z), (w, *v), (a, b, c) = self.center_of_mass, self.orientation, self.offset
        i, j, k = v
        # Twice the vector part across the offset, and that again: R x = x + w t + v x t.
        s, t, u = 2 * (j * c - k * b), 2 * (k * a - i * c), 2 * (i * b - j * a)
        return (
            x + a + w * s + j * u - k * t,
            y + b + w * t + k * s - i * u,
            z + c + w * u + i * t - j * s,
        )

    @property
    def position(self) -> tuple[float, float, float]:
        """The centre of mass: where the body's frame stands."""
        return self.center_of_mass


@dataclass(frozen=True, slots=True, repr=False)
class Contact:
    """One point where body `a` touches body `b`."""

    a: str
    b: str
    feature: str
    """Which corner meets which side: with the two names, the contact's stable identity."""
    point: tuple[float, ...]
    """(x, y) in metres; in space (x, y, z)."""
    normal: tuple[float, ...]
    """Unit vector from `a` into `b`."""
    gap: float
    """Metres between the bodies here; negative where they overlap within tolerance."""
    friction: float
    """Coefficient of friction of this pair."""
    at_borders: bool = False
    """Whether only borders meet here: a corner a corner, in space also a corner an edge or an edge
    an edge along it. `normal` is then that of slightly rounded ones."""

    def __repr__(self) -> str:
        where = f"{self.a!r} - {self.b!r} at {place(self.point)}"
        gap = digits(self.gap, max(map(abs, self.point)), 3)
        how = f"normal {place(self.normal)}, gap {gap} m"
        return f"<Contact: {where}, {how}; {self.feature}>"


def _line(kind: str, body: Body | Solid) -> str:
    weight = "fixed" if body.fixed else f"{body.mass:.4g} kg"
    return f"<{kind}: {body.name!r}, {weight}, at {place(body.center_of_mass)}>"


def planar(bodies: Iterable[Body | Solid]) -> list[Body]:
    """Those of the plane: all of a planar scene."""
    return [body for body in bodies if isinstance(body, Body)]


def solids(bodies: Iterable[Body | Solid]) -> list[Solid]:
    """Those in space: all of a scene in space."""
    return [body for body in bodies if isinstance(body, Solid)]


def snapshot(body: _core.Body | _core.Solid) -> Body | Solid:
    """What the core shows of a body."""
    if isinstance(body, _core.Solid):
        return Solid(
            body.name,
            body.fixed,
            body.density,
            body.friction,
            body.mass,
            body.inertia,
            body.center_of_mass,
            body.orientation,
            body.box_size,
            tuple(Piece(v, tuple(tuple(face) for face in faces)) for v, faces in body.pieces),
            body.vertices,
            body.offset,
            None if body.surface is None else Surface(*body.surface),
        )
    return Body(
        body.name,
        body.fixed,
        body.density,
        body.friction,
        body.mass,
        body.inertia,
        body.center_of_mass,
        body.angle,
        body.vertices,
        body.offset,
    )
