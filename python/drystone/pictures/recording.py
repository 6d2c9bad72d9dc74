"""One frame of a recording, as a picture: the same view and the same scale of forces in all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from drystone.pictures import style
from drystone.pictures.arrows import draw_arrows
from drystone.pictures.canvas import Canvas, bounds, fitted
from drystone.pictures.shapes import (
    draw_absent,
    draw_blocks,
    draw_fixed,
    draw_labels,
    typical_size,
)
from drystone.scene import Body
from drystone.viewer.contract import ABSENT, FALLING, MOTIONLESS, NEXT, PRESENT
from drystone.viewer.recording import FrameForces, Recording, own_frame

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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


def frame_figure(recording: Recording, frame: int) -> Figure:
    """Bodies by state, forces to one scale; IndexError if there is no such frame."""
    frames = len(recording.states)
    if not 0 <= frame < frames:
        raise IndexError(f"frame {frame}: there are frames 0 to {frames - 1}")
    bodies = _moved(recording, frame)
    states = recording.states[frame]
    canvas = fitted(_view(recording), recording.title, _note(recording, frame), key=True)
    fills = {
        body.name: FILLS[state]
        for body, state in zip(bodies, states.tolist(), strict=True)
        if state != ABSENT and not body.fixed
    }
    draw_fixed(canvas, bodies)
    if recording.kind == "plan":
        draw_absent(canvas, [b for b in bodies if not b.fixed and b.name not in fills])
    draw_blocks(canvas, bodies, fills)
    draw_labels(canvas, bodies, {name: name for name in fills}, fills)
    if recording.forces is not None:
        _draw_forces(canvas, recording, recording.forces, frame)
    return canvas.figure


def _moved(recording: Recording, frame: int) -> list[Body]:
    """The bodies where the frame has them."""
    if recording.poses is None:
        return list(recording.bodies)
    return [
        replace(body, centroid=(x, y), angle=angle, vertices=_placed(body, x, y, angle))
        for body, (x, y, angle) in zip(
            recording.bodies, recording.poses[frame].tolist(), strict=True
        )
    ]


def _placed(body: Body, x: float, y: float, angle: float) -> NDArray[np.float64]:
    cos, sin = np.cos(angle), np.sin(angle)
    turned = own_frame(body) @ np.array([[cos, sin], [-sin, cos]])
    corners: NDArray[np.float64] = turned + np.array([x, y])
    return corners


def _view(recording: Recording) -> list[Body]:
    """Bodies that span the view: where they are in any frame, but not far away."""
    first = _moved(recording, 0)
    shown = [body.vertices for body in first if not body.fixed] or [b.vertices for b in first]
    if recording.poses is None or not shown:
        return first
    low, high = bounds(shown)
    reach = REACH * float(np.max(high - low))
    frames = np.unique(np.linspace(0, len(recording.states) - 1, SAMPLES).astype(int))
    later = [
        replace(body, vertices=np.clip(body.vertices, low - reach, high + reach))
        for frame in frames.tolist()
        for body, state in zip(_moved(recording, frame), recording.states[frame], strict=True)
        if not body.fixed and state != ABSENT
    ]
    return first + later


def _note(recording: Recording, frame: int) -> str:
    step = frame if recording.steps is None else int(recording.steps[frame])
    when = "" if recording.times is None else f"{recording.times[frame]:.3f} s, "
    said = [text for at, text in recording.captions if at <= frame]
    return f"{when}step {step}" + (f". {said[-1]}" if said else "")


def _draw_forces(canvas: Canvas, recording: Recording, forces: FrameForces, frame: int) -> None:
    """Each once, as it acts on the body that is carried: against gravity."""
    every = np.hypot(*np.asarray(forces.vectors, dtype=np.float64).reshape(-1, 2).T)
    span = slice(*np.asarray(forces.offsets)[frame : frame + 2].tolist())
    points = np.asarray(forces.points, dtype=np.float64)[span]
    vectors = np.array(forces.vectors, dtype=np.float64)[span]
    if len(vectors) == 0:
        return
    vectors[vectors @ np.asarray(recording.gravity) > 0] *= -1
    blocks: Sequence[Body] = [body for body in recording.bodies if not body.fixed]
    reference = float(np.quantile(every, FEW)) or float(np.max(every)) or 1.0
    peak = float(np.max(np.hypot(*vectors.T)))
    longest = 1.1 * typical_size(blocks) * peak / reference
    draw_arrows(canvas, points, vectors, longest, "N", style.FORCE)
