"""What rigid bodies weigh: mass, centre of mass and inertia, and their sums."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drystone.imports.pose import Pose
from drystone.meshes.hull import hull_corners, hull_triangles

if TYPE_CHECKING:
    from numpy.typing import NDArray

ROUNDED = 1e-3
"""The largest principal moment may exceed the sum of the others by this share of it, as the core
allows: files give moments with few digits."""


@dataclass(frozen=True, slots=True, eq=False)
class Weight:
    """Mass (kg), centre of mass (3,) in metres, and inertia about it (3, 3) in kg m^2."""

    mass: float
    center: NDArray[np.float64]
    inertia: NDArray[np.float64]

    def scaled(self, factor: float) -> Weight:
        """The same distribution of another mass."""
        return Weight(factor * self.mass, self.center, factor * self.inertia)

    def placed(self, pose: Pose, scale: float = 1.0) -> Weight:
        """The same where `pose` puts it, lengths `scale` times as long before that."""
        turned = scale**2 * pose.rotation @ self.inertia @ pose.rotation.T
        return Weight(self.mass, pose.apply(scale * self.center[None])[0], turned)

    def is_of_a_body(self) -> bool:
        """Whether a rigid body can have such moments."""
        moments = np.linalg.eigvalsh(self.inertia)
        largest = moments.max(initial=0.0)
        positive = bool(np.isfinite(moments).all() and moments.min() > 0)
        return positive and bool(2 * largest - moments.sum() <= ROUNDED * largest)


def together(weights: Sequence[Weight]) -> Weight:
    """The sum of weights, by the parallel axis theorem."""
    mass = sum(weight.mass for weight in weights)
    if mass <= 0:
        return Weight(0.0, np.zeros(3), np.zeros((3, 3)))
    center = np.sum([w.mass * w.center for w in weights], axis=0) / mass
    inertia = np.sum([w.inertia + _point(w.mass, w.center - center) for w in weights], axis=0)
    return Weight(float(mass), center, inertia)


def of_triangles(corners: NDArray[np.float64]) -> Weight:
    """What a closed surface (n, 3, 3), counter-clockwise from outside, weighs at 1 kg/m^3."""
    origin = corners.mean(axis=(0, 1))
    a, b, c = np.moveaxis(corners - origin, 1, 0)
    parts = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
    volume = float(parts.sum())
    if volume <= 0:
        return Weight(0.0, origin, np.zeros((3, 3)))
    total = a + b + c
    middle = parts @ total / (4 * volume)
    second = sum(np.einsum("i,ij,ik->jk", parts, v, v) for v in (a, b, c, total)) / 20
    second = second - volume * np.outer(middle, middle)
    inertia = np.trace(second) * np.eye(3) - second
    return Weight(volume, origin + middle, inertia)


def of_pieces(pieces: Sequence[NDArray[np.float64]]) -> Weight:
    """What convex pieces weigh at 1 kg/m^3, each counted in full."""
    weights = []
    for piece in pieces:
        points, triangles = hull_triangles(hull_corners(piece))
        weights.append(of_triangles(points[triangles]))
    return together(weights)


def of_ellipsoid(half: Sequence[float]) -> Weight:
    """At 1 kg/m^3, about the origin: half axes in metres, of a sphere all the same."""
    a, b, c = half
    mass = 4 / 3 * np.pi * a * b * c
    moments = [b * b + c * c, a * a + c * c, a * a + b * b]
    return Weight(float(mass), np.zeros(3), mass / 5 * np.diag(moments))


def of_cylinder(radius: float, half: float) -> Weight:
    """At 1 kg/m^3, about the origin, its axis along z."""
    mass = 2 * np.pi * radius**2 * half
    across = radius**2 / 4 + half**2 / 3
    return Weight(float(mass), np.zeros(3), mass * np.diag([across, across, radius**2 / 2]))


def of_capsule(radius: float, half: float) -> Weight:
    """At 1 kg/m^3, about the origin, its axis along z; `half` is that of the straight part."""
    ball = of_ellipsoid([radius] * 3)
    # Half a ball has its middle 3/8 of the radius from its flat side.
    inside = _point(ball.mass, np.array([0.0, 0.0, 3 / 8 * radius]))
    outside = _point(ball.mass, np.array([0.0, 0.0, half + 3 / 8 * radius]))
    ends = Weight(ball.mass, np.zeros(3), ball.inertia - inside + outside)
    return together([of_cylinder(radius, half), ends])


def _point(mass: float, at: NDArray[np.float64]) -> NDArray[np.float64]:
    """Inertia of a point about the origin."""
    inertia: NDArray[np.float64] = mass * (at @ at * np.eye(3) - np.outer(at, at))
    return inertia
