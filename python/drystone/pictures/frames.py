"""What the pictures of a recording's frames have in common, in the plane and in space."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from drystone.pictures import style
from drystone.recording.contract import ABSENT, FALLING, MOTIONLESS, NEXT, PRESENT
from drystone.recording.recording import FrameForces, Recording
from drystone.scene import Body, Solid

FILLS = {
    PRESENT: style.STONE,
    MOTIONLESS: style.STILL,
    NEXT: style.NEXT,
    FALLING: style.FALLING,
}
SAMPLES = 50
"""Frames looked at for the view."""
REACH = 0.5
"""How far bodies that move away may widen the view, in the size of the first frame."""
FEW = 0.99
"""The share of forces that are no longer than a block: an impact may be far beyond."""


Box: TypeAlias = "tuple[NDArray[np.float64], NDArray[np.float64]]"
"""The lower and the upper corner."""


def box_around(
    recording: Recording,
    moved: Callable[[int], Sequence[Body | Solid]],
    frames: Sequence[int] | None,
) -> Box:
    """Around the movable bodies in these frames, or in all of them, but not far from where they
    begin except down; `moved` puts the bodies where a frame has them."""
    first = moved(0)
    movable = [body.vertices for body in first if not body.fixed]
    start = np.concatenate(movable or [body.vertices for body in first] or [np.zeros((1, 3))])
    if recording.poses is None:
        return start.min(axis=0), start.max(axis=0)
    points = [start] if frames is None else []
    for frame in sampled(recording) if frames is None else frames:
        states = recording.states[frame].tolist()
        points += [
            body.vertices
            for body, state in zip(moved(frame), states, strict=True)
            if not body.fixed and state != ABSENT
        ]
    every = np.concatenate(points or [start])
    low, high = every.min(axis=0), every.max(axis=0)
    floor = np.concatenate([body.vertices for body in first])
    size = np.ptp(start, axis=0)
    for _ in range(2):  # first how far it falls, then as far beside it
        least, most = _limit(start, floor, np.asarray(recording.gravity), REACH * np.max(size))
        corners = np.clip(low, least, most), np.clip(high, least, most)
        size = corners[1] - corners[0]
    return corners


def _limit(
    start: NDArray[np.float64],
    floor: NDArray[np.float64],
    pull: NDArray[np.float64],
    reach: np.float64,
) -> Box:
    """The box around the start and so far beyond it, and down to where anything is: what falls on
    fixed bodies is seen to land."""
    least, most = start.min(axis=0) - reach, start.max(axis=0) + reach
    least = np.where(pull < 0, np.minimum(least, floor.min(axis=0)), least)
    most = np.where(pull > 0, np.maximum(most, floor.max(axis=0)), most)
    return least, most


def fills_in(recording: Recording, frame: int) -> dict[str, str]:
    """The colours of the movable bodies that are there, by name."""
    states = recording.states[frame].tolist()
    return {
        body.name: FILLS[state]
        for body, state in zip(recording.bodies, states, strict=True)
        if state != ABSENT and not body.fixed
    }


def note_of(recording: Recording, frame: int) -> str:
    """When the frame is, and what is said about it."""
    step = frame if recording.steps is None else int(recording.steps[frame])
    when = "" if recording.times is None else f"{recording.times[frame]:.3f} s, "
    said = [text for at, text in recording.captions if at <= frame]
    return f"{when}step {step}" + (f". {said[-1]}" if said else "")


def sampled(recording: Recording) -> list[int]:
    """The frames that are looked at for the view; only the first where nothing moves."""
    if recording.poses is None:
        return [0]
    last = len(recording.states) - 1
    return [int(frame) for frame in np.unique(np.linspace(0, last, SAMPLES).astype(int))]


def reference_force(forces: FrameForces) -> float:
    """The magnitude that is drawn about as long as a block, N, in all frames."""
    every = np.linalg.norm(np.asarray(forces.vectors, dtype=np.float64), axis=1)
    if len(every) == 0:
        return 1.0
    return float(np.quantile(every, FEW)) or float(np.max(every)) or 1.0
