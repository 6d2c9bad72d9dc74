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
    low, high = start.min(axis=0), start.max(axis=0)
    if recording.poses is None:
        return low, high
    reach = REACH * float(np.max(high - low))
    least, most = low - reach, high + reach
    # Down to where fixed bodies are: what falls on them is seen to land.
    corners = np.concatenate([body.vertices for body in first])
    pull = np.asarray(recording.gravity)
    least = np.where(pull < 0, np.minimum(least, corners.min(axis=0)), least)
    most = np.where(pull > 0, np.maximum(most, corners.max(axis=0)), most)
    points = [start] if frames is None else []
    for frame in sampled(recording) if frames is None else frames:
        points += [
            np.clip(body.vertices, least, most)
            for body, state in zip(moved(frame), recording.states[frame].tolist(), strict=True)
            if not body.fixed and state != ABSENT
        ]
    every = np.concatenate(points or [start])
    return every.min(axis=0), every.max(axis=0)


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
