"""What an importer gathers: bodies, what it left out, what it took otherwise than written."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from drystone._core import SceneError
from drystone.common.text import like, shorten
from drystone.imports.pose import Pose
from drystone.imports.weight import Weight
from drystone.meshes.hull import hull_volume
from drystone.meshes.part import made_of
from drystone.meshes.surface import signed_volumes

if TYPE_CHECKING:
    from numpy.typing import NDArray

DENSITY = 1000.0
"""kg/m^3, where a file gives none."""

MANY = 4
"""What was done to this many bodies or more is said in one line."""

GROUND_MARGIN = 0.5
"""Ground reaches this share of the bodies' extent beyond them on every side, and as deep."""


class FormatError(SceneError):
    """A file cannot be imported; the text names it, says why, and what to do."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ImportedBody:
    """One rigid body: convex pieces (k, 3) in the world, metres, or the vertices of its surface."""

    name: str
    pieces: list[NDArray[np.float64]]
    density: float
    """kg/m^3."""
    friction: float | None
    fixed: bool
    density_factor: float = 1.0
    """What makes the pieces weigh as much as the mesh that they were simplified from."""
    weight: Weight | None = None
    """Mass, centre of mass and inertia if the file gives them. Pieces may overlap then, and the
    density is the mass divided by the sum of their volumes."""
    triangles: NDArray[np.int64] | None = None
    """(n, 3), of a body kept as a surface: numbers of its vertices, which are its one piece."""

    def __repr__(self) -> str:
        weight = "fixed" if self.fixed else f"{self.mass:.4g} kg"
        return f"<ImportedBody: {self.name!r}, {made_of(self.pieces, self.triangles)}, {weight}>"

    @property
    def volume(self) -> float:
        """Cubic metres, of the mesh if it was simplified; pieces that overlap count in full."""
        if self.triangles is not None:
            return float(signed_volumes(self.pieces[0][self.triangles]).sum())
        return self.density_factor * sum(hull_volume(piece) for piece in self.pieces)

    @property
    def mass(self) -> float:
        """Kilograms."""
        return self.density * self.volume if self.weight is None else self.weight.mass

    def with_density(self, density: float) -> ImportedBody:
        """The same body with another density, kg/m^3; a `weight` keeps its distribution."""
        weight = self.weight and self.weight.scaled(density / self.density)
        return replace(self, density=density, weight=weight)


@dataclass(frozen=True, slots=True)
class LeftOut:
    """Something in a file that has no place in a scene."""

    what: str
    why: str


@dataclass(frozen=True, slots=True, eq=False)
class _Plane:
    name: str
    pose: Pose
    friction: float | None


@dataclass(slots=True, eq=False)
class Collected:
    """The bodies of a file, in its own units and axes until `placed`."""

    bodies: list[ImportedBody] = field(default_factory=list)
    left_out: list[LeftOut] = field(default_factory=list)
    messages: list[str] = field(default_factory=list)
    gravity: tuple[float, float, float] | None = None
    extent: float = 0.0
    """The diagonal of all bodies, without planes and ground."""
    inexact: float = 0.0
    """The farthest that a vertex may be off, as far as the numbers of meshes show it."""
    mesh_tolerance: float | None = None
    """How far vertices of meshes may be off at least, as the user says."""
    lacking: list[str] = field(default_factory=list)
    """Bodies of the file that the scene is without."""
    _planes: list[_Plane] = field(default_factory=list)

    def add(
        self,
        name: str,
        pieces: list[NDArray[np.float64]],
        *,
        density: float | None = None,
        friction: float | None = None,
        fixed: bool = False,
        density_factor: float = 1.0,
        tolerance: float = 0.0,
        weight: Weight | None = None,
        triangles: NDArray[np.int64] | None = None,
    ) -> None:
        """One rigid body; a name that is taken gets a number. Its vertices are off by no more than
        `tolerance`; a `weight` takes the place of the density. With `triangles` it is within a
        surface, whose vertices are its one piece."""
        self.inexact = max(self.inexact, tolerance)
        density = DENSITY if density is None else density
        if weight is not None:
            density = weight.mass / sum(hull_volume(piece) for piece in pieces)
        name = self._free(name)
        body = ImportedBody(
            name, pieces, density, friction, fixed, density_factor, weight, triangles
        )
        self.bodies.append(body)

    def add_plane(self, name: str, pose: Pose, friction: float | None = None) -> None:
        """A half-space below the xy plane of `pose`: a fixed box as large as the bodies need."""
        self._planes.append(_Plane(name, pose, friction))

    def leave_out(self, what: str, why: str) -> None:
        """Note something that was not taken."""
        self.left_out.append(LeftOut(what, why))

    def lack(self, what: str, why: str) -> None:
        """Note a body that could not be taken, so that the scene is without it."""
        self.lacking.append(what)
        self.leave_out(what, why)

    def say(self, about: str, messages: Iterable[str]) -> None:
        """Note what was done to a body."""
        self.messages += [f"{about}: {message}" for message in messages]

    def grouped(self) -> list[str]:
        """The messages; what was done to many bodies in one line, where the first of them is."""
        about: dict[str, list[str]] = {}
        for message in self.messages:
            name, _, text = message.partition(": ")
            about.setdefault(text or message, []).append(name)
        lines = []
        for message in self.messages:
            name, _, text = message.partition(": ")
            names = about.get(text, [])
            if len(names) < MANY:
                lines.append(message)
            elif name == names[0]:
                lines.append(f"{name} and {len(names) - 1} others: {text}")
        return lines

    def fix(self, names: Iterable[str]) -> None:
        """Fix bodies by name; FormatError for a name that is not there."""
        wanted = set(names)
        self._refuse_unknown(wanted)
        self.bodies = [replace(b, fixed=b.fixed or b.name in wanted) for b in self.bodies]

    def set_densities(self, densities: Mapping[str, float]) -> None:
        """Give bodies densities (kg/m^3) by name; FormatError for a name that is not there."""
        self._refuse_unknown(densities)
        self.bodies = [
            b.with_density(densities[b.name]) if b.name in densities else b for b in self.bodies
        ]

    def set_frictions(self, frictions: Mapping[str, float]) -> None:
        """Give bodies coefficients by name; FormatError for a name that is not there."""
        self._refuse_unknown(frictions)
        self.bodies = [replace(b, friction=frictions.get(b.name, b.friction)) for b in self.bodies]

    def measure(self) -> None:
        """Note the extent of the bodies so far."""
        if self.bodies:
            self.extent = float(np.linalg.norm(np.ptp(self._points(), axis=0)))

    def lay_planes(self) -> None:
        """Turn planes into boxes, now that all bodies are there."""
        if not self.bodies:
            return
        points = self._points()
        for plane in self._planes:
            slab = _slab(plane.pose, points)
            self.add(plane.name, [slab], friction=plane.friction, fixed=True)
            self.messages.append(f"{plane.name}: a plane, taken as a fixed box under the others")

    def lay_ground(self) -> None:
        """A fixed box under the lowest points of all bodies."""
        points = self._points()
        pose = Pose(np.array([0.0, 0.0, points[:, 2].min()]), np.eye(3))
        self.add("ground", [_slab(pose, points)], fixed=True)

    def transform(self, scale: float, rotation: NDArray[np.float64]) -> None:
        """Scale lengths and turn everything; densities (kg/m^3) and masses (kg) stay."""
        self.extent *= scale
        self.inexact *= scale
        if self.gravity is not None:
            x, y, z = (scale * rotation @ np.array(self.gravity)).tolist()
            self.gravity = (x, y, z)
        pose = Pose(np.zeros(3), rotation)
        self.bodies = [
            replace(
                b,
                pieces=[scale * p @ rotation.T for p in b.pieces],
                density=b.density if b.weight is None else b.density / scale**3,
                weight=b.weight and b.weight.placed(pose, scale),
            )
            for b in self.bodies
        ]

    def _refuse_unknown(self, names: Iterable[str]) -> None:
        unknown = set(names) - {body.name for body in self.bodies}
        if unknown:
            known = [body.name for body in self.bodies]
            word = min(unknown)
            raise FormatError(
                f"no body is called {word!r}{like(word, known)}: there are {shorten(known, 20)}"
            )

    def _points(self) -> NDArray[np.float64]:
        return np.concatenate([piece for body in self.bodies for piece in body.pieces])

    def _free(self, name: str) -> str:
        taken = {body.name for body in self.bodies}
        if name not in taken:
            return name
        number = 2
        while f"{name} {number}" in taken:
            number += 1
        self.messages.append(f"{name}: named twice, the second is called {name} {number}")
        return f"{name} {number}"


def _slab(pose: Pose, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Corners of a box below the xy plane of `pose`, under all of `points`."""
    local = (points - pose.position) @ pose.rotation
    low, high = local.min(axis=0), local.max(axis=0)
    margin = GROUND_MARGIN * float((high - low).max())
    low, high = low - margin, high + margin
    low[2], high[2] = -margin, 0.0
    corners = np.array([np.where(c, high, low) for c in np.ndindex(2, 2, 2)])
    return pose.apply(corners)
