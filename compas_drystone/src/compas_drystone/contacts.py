"""Contact forces of drystone as contacts of compas_dem, one for each two blocks.

Each has a few points: numbers of a handful are added sooner one by one than as arrays.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import atan2, hypot, sqrt
from typing import TYPE_CHECKING, TypeAlias

import compas.geometry as cg
from compas_dem.interactions import EdgeContact, FrictionContact, VertexContact

if TYPE_CHECKING:
    import drystone as ds

Vector: TypeAlias = Sequence[float]
"""x, y, z."""

STRAIGHT = 1e-6
"""Points are on a line if they are within this share of their extent of it: ten times the rounding
of single precision."""

LEVEL = 1e-6
"""A joint whose normal leans by less, in radians, is level: its x axis is the world's then."""


@dataclass(frozen=True, slots=True, eq=False)
class Between:
    """What block u does to block v."""

    edge: tuple[int, int]
    points: list[Vector]
    """Around the contact; metres."""
    vectors: list[Vector]
    """The forces of u on v there, N, world axes."""
    locals: list[Vector]
    """The same along the frame's x, y and z axes."""
    frame: cg.Frame
    """Its z axis is the normal, from u into v."""

    def data(self) -> FrictionContact | EdgeContact | VertexContact:
        """As compas_dem has it: by how many points there are."""
        points = [cg.Point(*point) for point in self.points]
        forces = [
            {"c_np": max(n, 0.0), "c_nn": max(-n, 0.0), "c_u": u, "c_v": v}
            for u, v, n in self.locals
        ]
        if len(points) == 1:
            return VertexContact(points[0], frame=self.frame, forces=forces)
        if len(points) == 2:
            return EdgeContact(points, self.frame, forces=forces)
        return FrictionContact(points=points, frame=self.frame, forces=forces)


def between(
    scene: ds.Scene, forces: ds.ContactForces, edge_of: Callable[[int, int], tuple[int, int]]
) -> Iterator[Between]:
    """The contacts of all pairs, in the order in which they touch. `edge_of` says which of two
    blocks comes first."""
    names = [int(name) for name in scene.names]
    points, normals = forces.points.tolist(), forces.normals.tolist()
    vectors, pressures = forces.vectors.tolist(), forces.normal_forces.tolist()
    of: dict[tuple[int, int], list[int]] = {}
    for k, (a, b) in enumerate(forces.bodies.tolist()):
        of.setdefault((names[a], names[b]), []).append(k)
    for pair, rows in of.items():
        edge = edge_of(*pair)
        sign = 1.0 if edge == pair else -1.0
        normal = _normal([normals[k] for k in rows], [pressures[k] for k in rows])
        places, sums = _merged(
            [points[k] for k in rows], [vectors[k] for k in rows], scene.contact_tolerance
        )
        yield _contact(edge, places, [_times(sign, one) for one in sums], _times(sign, normal))


def _normal(normals: list[Vector], pressures: list[float]) -> Vector:
    """That of the plane that bears most; of one of the largest if none bears."""
    planes: dict[Vector, list[int]] = {}
    for k, normal in enumerate(normals):
        planes.setdefault(tuple(round(x, 9) for x in normal), []).append(k)
    if len(planes) == 1:
        return normals[0]

    def bears(plane: Vector) -> tuple[float, int]:
        return sum(pressures[k] for k in planes[plane]), len(planes[plane])

    return normals[planes[max(sorted(planes), key=bears)][0]]


def _merged(
    points: list[Vector], vectors: list[Vector], tolerance: float
) -> tuple[list[Vector], list[Vector]]:
    """Forces at one place are one force."""
    places: list[Vector] = []
    sums: list[Vector] = []
    for point, vector in zip(points, vectors, strict=True):
        apart = [max(map(abs, _minus(point, place))) for place in places]
        nearest = min(range(len(apart)), key=apart.__getitem__, default=None)
        if nearest is not None and apart[nearest] <= tolerance:
            sums[nearest] = [a + b for a, b in zip(sums[nearest], vector, strict=True)]
        else:
            places.append(point)
            sums.append(vector)
    return places, sums


def _contact(
    edge: tuple[int, int], points: list[Vector], vectors: list[Vector], normal: Vector
) -> Between:
    middle = [sum(along) / len(points) for along in zip(*points, strict=True)]
    arms = [_minus(point, middle) for point in points]
    at = _along_a_line(arms) if len(points) > 2 else None
    if at is not None:
        points, vectors = _at_ends(points, vectors, at)
    x, y = _axes(normal)
    if len(points) > 2:
        angles = [atan2(_dot(arm, y), _dot(arm, x)) for arm in arms]
        around = sorted(range(len(points)), key=angles.__getitem__)
        points, vectors = [points[k] for k in around], [vectors[k] for k in around]
    locals_ = [[_dot(vector, x), _dot(vector, y), _dot(vector, normal)] for vector in vectors]
    return Between(edge, points, vectors, locals_, cg.Frame(middle, x, y))


def _axes(normal: Vector) -> tuple[Vector, Vector]:
    """x is level, y square to it and to the normal."""
    a, b, c = normal
    x = [-b, a, 0.0]  # z of the world times the normal
    if hypot(a, b) < LEVEL:
        x = _minus([1.0, 0.0, 0.0], _times(a, normal))
    x = _times(1 / sqrt(_dot(x, x)), x)
    return x, [b * x[2] - c * x[1], c * x[0] - a * x[2], a * x[1] - b * x[0]]


def _along_a_line(arms: list[Vector]) -> list[float] | None:
    """Where points are along the line on which all of them are; None if they are on none."""
    longest = max(arms, key=lambda arm: _dot(arm, arm))
    size = sqrt(_dot(longest, longest))
    if size == 0:
        return None
    along = _times(1 / size, longest)
    at = [_dot(arm, along) for arm in arms]
    off = max(
        abs(x - t * u)
        for arm, t in zip(arms, at, strict=True)
        for x, u in zip(arm, along, strict=True)
    )
    return at if off <= STRAIGHT * (max(at) - min(at)) else None


def _at_ends(
    points: list[Vector], vectors: list[Vector], at: list[float]
) -> tuple[list[Vector], list[Vector]]:
    """Forces along a line as two at its ends: the same sum and the same moment, by the lever."""
    low, high = at.index(min(at)), at.index(max(at))
    shares = [(t - at[low]) / (at[high] - at[low]) for t in at]

    def total(factors: list[float]) -> Vector:
        pushes = [_times(factor, vector) for factor, vector in zip(factors, vectors, strict=True)]
        return [sum(along) for along in zip(*pushes, strict=True)]

    return [points[low], points[high]], [total([1 - share for share in shares]), total(shares)]


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _minus(a: Vector, b: Vector) -> list[float]:
    return [a[0] - b[0], a[1] - b[1], a[2] - b[2]]


def _times(factor: float, a: Vector) -> list[float]:
    return [factor * a[0], factor * a[1], factor * a[2]]
