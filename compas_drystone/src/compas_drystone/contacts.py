"""Contact forces of drystone as contacts of compas_dem, one for each two blocks."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import compas.geometry as cg
import numpy as np
from compas_dem.interactions import EdgeContact, FrictionContact, VertexContact

if TYPE_CHECKING:
    from numpy.typing import NDArray

    import drystone as ds

STRAIGHT = 1e-6
"""Points are on a line if they are within this share of their extent of it: ten times the rounding
of single precision."""


@dataclass(frozen=True, slots=True, eq=False)
class Between:
    """What block u does to block v."""

    edge: tuple[int, int]
    points: NDArray[np.float64]
    """(n, 3), around the contact; metres."""
    vectors: NDArray[np.float64]
    """(n, 3): the forces of u on v there, N, world axes."""
    frame: cg.Frame
    """Its z axis is the normal, from u into v."""

    @property
    def locals(self) -> NDArray[np.float64]:
        """(n, 3): the forces along the frame's x, y and z axes."""
        axes = np.array([list(self.frame.xaxis), list(self.frame.yaxis), list(self.frame.zaxis)])
        return self.vectors @ axes.T

    def data(self) -> FrictionContact | EdgeContact | VertexContact:
        """As compas_dem has it: by how many points there are."""
        points = [cg.Point(*point) for point in self.points.tolist()]
        forces = [
            {"c_np": max(n, 0.0), "c_nn": max(-n, 0.0), "c_u": u, "c_v": v}
            for u, v, n in self.locals.tolist()
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
    names = [int(body.name) for body in scene.bodies]
    of: dict[tuple[int, int], list[int]] = {}
    for k, (a, b) in enumerate(forces.bodies.tolist()):
        of.setdefault((names[a], names[b]), []).append(k)
    for (a, b), rows in of.items():
        edge = edge_of(a, b)
        sign = 1.0 if edge == (a, b) else -1.0
        points, vectors = forces.points[rows], sign * forces.vectors[rows]
        normal = _normal(sign * forces.normals[rows], forces.normal_forces[rows])
        points, vectors = _merged(points, vectors, scene.contact_tolerance)
        yield _contact(edge, points, vectors, normal)


def _normal(normals: NDArray[np.float64], pressures: NDArray[np.float64]) -> NDArray[np.float64]:
    """That of the plane that bears most; of one of the largest if none bears."""
    heads, place = np.unique(normals.round(9), axis=0, return_inverse=True)
    place = place.reshape(-1)
    bears = np.bincount(place, pressures, minlength=len(heads))
    best = bears.argmax() if bears.any() else np.bincount(place).argmax()
    return normals[place == best][0]


def _merged(
    points: NDArray[np.float64], vectors: NDArray[np.float64], tolerance: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Forces at one place are one force."""
    places: list[Any] = []
    sums: list[Any] = []
    for point, vector in zip(points, vectors, strict=True):
        apart = [np.abs(point - place).max() for place in places]
        if apart and min(apart) <= tolerance:
            sums[int(np.argmin(apart))] += vector
        else:
            places.append(point)
            sums.append(vector.copy())
    return np.array(places), np.array(sums)


def _contact(
    edge: tuple[int, int],
    points: NDArray[np.float64],
    vectors: NDArray[np.float64],
    normal: NDArray[np.float64],
) -> Between:
    middle = points.mean(axis=0)
    arms = points - middle
    along = np.linalg.svd(arms)[2][0]
    if len(points) > 2 and _on_a_line(arms, along):
        points, vectors = _at_ends(points, vectors, arms @ along)
    across = np.cross([0.0, 0.0, 1.0], normal)
    if np.linalg.norm(across) < 1e-6:  # a level joint
        across = np.array([1.0, 0.0, 0.0])
    x = across - (across @ normal) * normal
    x /= np.linalg.norm(x)
    y = np.cross(normal, x)
    if len(points) > 2:
        turn = np.argsort(np.arctan2(arms @ y, arms @ x), kind="stable")
        points, vectors = points[turn], vectors[turn]
    frame = cg.Frame(middle.tolist(), x.tolist(), y.tolist())
    return Between(edge, points, vectors, frame)


def _on_a_line(arms: NDArray[np.float64], along: NDArray[np.float64]) -> bool:
    off = arms - np.outer(arms @ along, along)
    return bool(np.abs(off).max() <= STRAIGHT * np.ptp(arms @ along))


def _at_ends(
    points: NDArray[np.float64], vectors: NDArray[np.float64], at: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Forces along a line as two at its ends: the same sum and the same moment, by the lever."""
    low, high = at.argmin(), at.argmax()
    share = (at - at[low]) / (at[high] - at[low])
    return points[[low, high]], np.array([(1 - share) @ vectors, share @ vectors])
