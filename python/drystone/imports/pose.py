"""Positions and orientations, as the formats write them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """A frame: position (3,) in metres, and a rotation matrix (3, 3)."""

    position: NDArray[np.float64]
    rotation: NDArray[np.float64]

    @classmethod
    def identity(cls) -> Pose:
        """The world's frame."""
        return cls(np.zeros(3), np.eye(3))

    def apply(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points (k, 3) of this frame in the frame that it is given in."""
        moved: NDArray[np.float64] = points @ self.rotation.T + self.position
        return moved

    def then(self, inner: Pose) -> Pose:
        """The pose of a frame that is given in this one."""
        return Pose(self.apply(inner.position[None])[0], self.rotation @ inner.rotation)


def from_quaternion(w_x_y_z: Sequence[float]) -> NDArray[np.float64]:
    """Rotation matrix of a quaternion (w, x, y, z) of any length but zero; ValueError for that."""
    w, x, y, z = w_x_y_z
    return _matrix(Rotation.from_quat([x, y, z, w]))


def from_euler(sequence: str, angles: Sequence[float]) -> NDArray[np.float64]:
    """Rotation matrix of three angles, radians: axes in lower case stay, upper case turn along."""
    return _matrix(Rotation.from_euler(sequence, angles))


def from_axis_angle(axis: Sequence[float], angle: float) -> NDArray[np.float64]:
    """Rotation matrix of a turn by `angle` radians about an axis of any length."""
    direction = np.asarray(axis, dtype=float)
    return _matrix(Rotation.from_rotvec(angle * direction / np.linalg.norm(direction)))


def box_corners(half_sizes: Sequence[float]) -> NDArray[np.float64]:
    """The eight corners (8, 3) of a box about the origin."""
    half = np.asarray(half_sizes, dtype=float)
    return np.array([np.where(corner, half, -half) for corner in np.ndindex(2, 2, 2)])


def _matrix(rotation: Rotation) -> NDArray[np.float64]:
    return np.asarray(rotation.as_matrix(), dtype=np.float64)


UP = {
    "z": np.eye(3),
    "y": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
}
"""Turns a file in which this axis points up so that z does."""
