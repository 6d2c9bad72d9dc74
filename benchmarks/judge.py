"""What a simulated motion got wrong, by one measure for everybody, from the places recorded."""

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
    """(n, 2) metres."""
    mass: Floats
    inertia: Floats
    fixed: NDArray[np.bool_]
    gravity: Floats

    @classmethod
    def of(cls, scene: ds.Scene) -> Boxes:
        """Everything of a scene that the measures need."""
        bodies = json.loads(scene.to_json())["bodies"]
        size = np.array([body["box"]["size"] for body in bodies])
        mass = size.prod(axis=1) * [body["density"] for body in bodies]
        fixed = np.array([body["fixed"] for body in bodies])
        inertia = mass * (size**2).sum(axis=1) / 12
        return cls(size, mass, inertia, fixed, np.array(scene.gravity))


def displacement(frames: Floats, still: NDArray[np.bool_]) -> float:
    """How far a body that should stay still was from its place at most, metres; NaN without one."""
    away = np.hypot(*np.moveaxis(frames[:, still, :2] - frames[0, still, :2], 2, 0))
    return float(away.max()) if away.size else float("nan")


def energy_rise(boxes: Boxes, frames: Floats) -> float:
    """How far the energy of all bodies was above an earlier value at most, joules."""
    moves = ~boxes.fixed
    mass, inertia = boxes.mass[moves], boxes.inertia[moves]
    places, rates = frames[:, moves, :3], frames[:, moves, 3:]
    kinetic = 0.5 * (mass * (rates[..., :2] ** 2).sum(-1) + inertia * rates[..., 2] ** 2)
    energy = (kinetic - mass * (places[..., :2] @ boxes.gravity)).sum(axis=1)
    return float((energy - np.minimum.accumulate(energy)).max())


def penetration(boxes: Boxes, frames: Floats) -> float:
    """The deepest overlap of two boxes, metres."""
    return max(_deepest(boxes, frame) for frame in frames)


def _deepest(boxes: Boxes, frame: Floats) -> float:
    """By separating axes: the way out of two boxes is along a side of one of them."""
    half = 0.5 * boxes.size
    cos, sin = np.cos(frame[:, 2]), np.sin(frame[:, 2])
    axes = np.stack([np.stack([cos, sin], -1), np.stack([-sin, cos], -1)], 1)
    offset = frame[None, :, :2] - frame[:, None, :2]
    # Distance of the centres along each axis of the first, less what each of the two takes of it.
    along = np.abs(np.einsum("iax,ijx->ija", axes, offset))
    reach = np.einsum("jb,ijab->ija", half, np.abs(np.einsum("iax,jbx->ijab", axes, axes)))
    gap = (along - half[:, None] - reach).max(axis=2)
    gap = np.maximum(gap, gap.T)
    ours = ~(np.eye(len(frame), dtype=bool) | (boxes.fixed & boxes.fixed[:, None]))
    return max(0.0, -float(gap[ours].min()))
