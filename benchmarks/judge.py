"""What a simulated motion got wrong, by one measure for everybody, from the places recorded.

A frame has a row of numbers for each box: in the plane x, y, angle and their rates; in space x, y,
z, a unit quaternion (w, x, y, z), and the rates of the centre and of the turning, both along the
axes of the world.
"""

from __future__ import annotations

import json
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import drystone as ds

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Boxes:
    """The boxes of a scene, as arrays of n."""

    size: Floats
    """(n, 2) or (n, 3) metres."""
    mass: Floats
    inertia: Floats
    """(n, 1), in space (n, 3) about the box's axes."""
    fixed: NDArray[np.bool_]
    gravity: Floats

    @classmethod
    def of(cls, scene: ds.Scene) -> Boxes:
        """Everything of a scene that the measures need."""
        bodies = json.loads(scene.to_json())["bodies"]
        size = np.array([body["box"]["size"] for body in bodies])
        mass = size.prod(axis=1) * [body["density"] for body in bodies]
        fixed = np.array([body["fixed"] for body in bodies])
        total = (size**2).sum(axis=1, keepdims=True)
        square = total if scene.dimension == 2 else total - size**2
        return cls(size, mass, mass[:, None] * square / 12, fixed, np.array(scene.gravity))

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self.size.shape[1]


def displacement(frames: Floats, still: NDArray[np.bool_], dimension: int = 2) -> float:
    """How far a body that should stay still was from its place at most, metres; NaN without one."""
    moved = frames[:, still, :dimension] - frames[0, still, :dimension]
    away = np.linalg.norm(moved, axis=-1)
    return float(away.max()) if away.size else float("nan")


def energy_rise(boxes: Boxes, frames: Floats) -> float:
    """How far the energy of all bodies was above an earlier value at most, joules."""
    d, moves = boxes.dimension, ~boxes.fixed
    mass, inertia, moving = boxes.mass[moves], boxes.inertia[moves], frames[:, moves]
    speed, turning = moving[..., -(3 * d - 3) :][..., :d], moving[..., -(2 * d - 3) :]
    if d == 3:
        turning = np.einsum("kiax,kix->kia", axes_of(moving, 3), turning)
    kinetic = 0.5 * (mass * (speed**2).sum(-1) + (inertia * turning**2).sum(-1))
    energy = (kinetic - mass * (moving[..., :d] @ boxes.gravity)).sum(axis=1)
    return float((energy - np.minimum.accumulate(energy)).max())


def penetration(boxes: Boxes, frames: Floats) -> float:
    """The deepest overlap of two boxes, metres."""
    return max(_deepest(boxes, frame) for frame in frames)


def axes_of(frames: Floats, dimension: int) -> Floats:
    """Unit vectors along the sides of every box: (..., side, coordinate)."""
    if dimension == 2:
        cos, sin = np.cos(frames[..., 2]), np.sin(frames[..., 2])
        return np.stack([np.stack([cos, sin], -1), np.stack([-sin, cos], -1)], -2)
    w, x, y, z = np.moveaxis(frames[..., 3:7], -1, 0)
    first = [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)]
    second = [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)]
    third = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]
    return np.stack([np.stack(axis, -1) for axis in (first, second, third)], -2)


def _deepest(boxes: Boxes, frame: Floats) -> float:
    """By separating axes: the sides of either box, in space also what is square to two of them."""
    d, half = boxes.dimension, 0.5 * boxes.size
    axes = axes_of(frame, d)
    offset = frame[None, :, :d] - frame[:, None, :d]
    # Distance of the centres along each axis of the first, less what each of the two takes of it.
    gap = _gap(half, axes, offset, np.broadcast_to(axes[:, None], (len(frame), *axes.shape)))
    gap = np.maximum(gap, gap.T)
    if d == 3:
        across = np.cross(axes[:, None, :, None], axes[None, :, None, :])
        length = np.linalg.norm(across, axis=-1, keepdims=True)
        # Sides that are parallel, or nearly, part nothing that the sides themselves do not.
        unit = np.divide(across, length, out=np.zeros_like(across), where=length > 1e-6)
        between = _gap(half, axes, offset, unit.reshape(*offset.shape[:2], 9, 3))
        gap = np.maximum(gap, between)
    ours = ~(np.eye(len(frame), dtype=bool) | (boxes.fixed & boxes.fixed[:, None]))
    return max(0.0, -float(gap[ours].min()))


def _gap(half: Floats, axes: Floats, offset: Floats, along: Floats) -> Floats:
    """(n, n): the greatest gap of two boxes over directions `along` (n, n, k, d), if not zero."""
    apart = np.abs(np.einsum("ijkx,ijx->ijk", along, offset))
    first = np.einsum("ib,ijkb->ijk", half, np.abs(np.einsum("ijkx,ibx->ijkb", along, axes)))
    second = np.einsum("jb,ijkb->ijk", half, np.abs(np.einsum("ijkx,jbx->ijkb", along, axes)))
    none = ~along.any(axis=-1)
    return np.where(none, -np.inf, apart - first - second).max(axis=-1)
