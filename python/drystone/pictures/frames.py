"""What the pictures of a recording's frames have in common, in the plane and in space."""

from __future__ import annotations

import numpy as np

from drystone.pictures import style
from drystone.recording.contract import ABSENT, FALLING, MOTIONLESS, NEXT, PRESENT
from drystone.recording.recording import FrameForces, Recording

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
