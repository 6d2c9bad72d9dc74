"""How large a page may become, and what is left out to keep to that.

A run of 100,000 steps, or the forces of every structure of a plan of thousands of blocks (their
number grows with the square), would make a page that no browser opens. So the arrays of a page are
bounded before they are packed: frames are thinned to every k-th step, and forces are kept of every
k-th frame only. The page says so.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil

import numpy as np
from numpy.typing import NDArray

from drystone.common.text import ordinal
from drystone.recording.recording import FrameForces, Recording, Series, rows_of

MIB = 1 << 20
STATE_BYTES = 1
"""Bytes of one body's state in one frame, before they are compressed, as all numbers here."""
POSE_BYTES = {2: 12, 3: 28}
"""Bytes of one body's pose in one frame, by dimension."""
FORCE_BYTES = {2: 24, 3: 32}
"""Bytes of one force, by dimension."""


@dataclass(frozen=True, slots=True)
class Budget:
    """Bytes of arrays that a page may hold, before they are compressed; as text a third more."""

    frames: int = 24 * MIB
    """States and poses of all frames."""
    forces: int = 24 * MIB


FILE = Budget()
"""A page on disk: at most 64 MiB, in practice a few."""
INLINE = Budget(3 * MIB, 3 * MIB)
"""A page within a notebook, which keeps it as text: at most 8 MiB."""


def bounded(recording: Recording, budget: Budget) -> Recording:
    """The recording, or as much of it as the budget allows with notes on what is missing."""
    return _with_fewer_forces(_with_fewer_frames(recording, budget.frames), budget.forces)


def _with_fewer_frames(recording: Recording, most: int) -> Recording:
    frames, bodies = recording.states.shape
    pose = 0 if recording.poses is None else POSE_BYTES[recording.dimension]
    a_frame = bodies * (STATE_BYTES + pose)
    every = ceil(frames * a_frame / most)
    if every <= 1:
        return recording
    kept = np.unique(np.append(np.arange(0, frames, every), frames - 1))
    steps = np.arange(frames) if recording.steps is None else recording.steps
    apart = every * int(steps[1] - steps[0])
    notes = (
        *recording.notes,
        f"Every {ordinal(apart)} step is shown; charts say what they have of the steps between.",
    )
    return replace(
        recording,
        states=recording.states[kept],
        poses=None if recording.poses is None else recording.poses[kept],
        times=None if recording.times is None else recording.times[kept],
        steps=steps[kept],
        forces=None if recording.forces is None else _chosen(recording.forces, kept),
        series=[_together(one, kept, every) for one in recording.series],
        captions=[(int(np.searchsorted(kept, at)), text) for at, text in recording.captions],
        notes=notes,
    )


def _with_fewer_forces(recording: Recording, most: int) -> Recording:
    forces = recording.forces
    if forces is None:
        return recording
    known = _kept(forces)
    sizes = np.diff(np.asarray(forces.offsets)) * known
    sizes *= FORCE_BYTES[recording.dimension]
    strides = range(1, len(sizes) + 1)
    every = next((k for k in strides if int(sizes[::k].sum()) <= most), None)
    kept = np.zeros_like(known)
    if every is not None:
        kept[::every] = known[::every]
    if kept.all():
        return recording
    note = f"Forces are kept of {kept.sum()} of {len(kept)} frames, to bound the page's size."
    return replace(recording, forces=replace(forces, kept=kept), notes=(*recording.notes, note))


def _kept(forces: FrameForces) -> NDArray[np.bool_]:
    if forces.kept is None:
        return np.ones(len(np.asarray(forces.offsets)) - 1, dtype=bool)
    return np.asarray(forces.kept, dtype=bool)


def _chosen(forces: FrameForces, frames: NDArray[np.int64]) -> FrameForces:
    """The forces of some frames."""
    offsets = np.asarray(forces.offsets)
    counts = np.diff(offsets)[frames]
    rows = rows_of(offsets[frames], counts)
    return FrameForces(
        np.concatenate([[0], np.cumsum(counts)]),
        np.asarray(forces.bodies)[rows],
        np.asarray(forces.points)[rows],
        np.asarray(forces.vectors)[rows],
        _kept(forces)[frames],
    )


def _together(series: Series, kept: NDArray[np.int64], every: int) -> Series:
    """Over the frames since the last one kept; the first kept is the first."""
    values = np.asarray(series.values, dtype=np.float64)
    if series.together == "least":
        least = np.fmin.reduceat(values, np.concatenate([[0], kept[:-1] + 1]))
        return replace(series, name=f"{series.name}, least of {every}", values=least)
    sums = np.diff(np.concatenate([[0.0], np.cumsum(np.nan_to_num(values))[kept]]))
    return replace(series, name=f"{series.name}, sums of {every}", values=sums)
