"""One frame of a recording in space, as a picture: the same view and scale of forces in all."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import NDArray

from drystone.pictures.axonometry import Shadow, View, movable_of, placed
from drystone.pictures.canvas import Canvas, fitted
from drystone.pictures.frames import REACH, fills_in, note_of, reference_force, sampled
from drystone.pictures.in_space import draw_forces
from drystone.pictures.shapes import typical_size
from drystone.pictures.solids import Drawing, draw_solids
from drystone.recording.contract import ABSENT
from drystone.recording.recording import FrameForces, Recording
from drystone.scene import Solid

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def solid_frame(recording: Recording, frame: int) -> Figure:
    """Bodies by state, forces to one scale."""
    first = _moved(recording, 0)
    view = View.of(first, recording.gravity)
    box = _box(recording)
    drawing = Drawing.of(_moved(recording, frame), view, box)
    # What spans the view is the same in all frames: the first one, and all that is in the box.
    corners = np.array(list(itertools.product(*np.stack(box, axis=1))))
    span = [*Drawing.of(first, view, box).outlines]
    if recording.poses is not None:
        span.append(Shadow("", False, (0.0, 0.0), view.flat(corners)))
    canvas = fitted(span, recording.title, note_of(recording, frame), key=True)
    draw_solids(canvas, drawing, fills_in(recording, frame), ghosts=recording.kind == "plan")
    if recording.forces is not None:
        _draw_forces(canvas, drawing, recording, recording.forces, frame)
    return canvas.figure


def _moved(recording: Recording, frame: int) -> Sequence[Solid]:
    bodies = cast("Sequence[Solid]", recording.bodies)
    if recording.poses is None:
        return bodies
    return [
        placed(body, pose[:3], pose[3:])
        for body, pose in zip(bodies, recording.poses[frame].tolist(), strict=True)
    ]


def _box(recording: Recording) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Around the movable bodies in all frames, but not far away."""
    bodies = _moved(recording, 0)
    start = np.concatenate([body.vertices for body in movable_of(bodies)])
    low, high = start.min(axis=0), start.max(axis=0)
    reach = REACH * float(np.max(high - low))
    points = [start]
    for frame in sampled(recording):
        states = recording.states[frame].tolist()
        points += [
            np.clip(body.vertices, low - reach, high + reach)
            for body, state in zip(_moved(recording, frame), states, strict=True)
            if not body.fixed and state != ABSENT
        ]
    every = np.concatenate(points)
    return every.min(axis=0), every.max(axis=0)


def _draw_forces(
    canvas: Canvas, drawing: Drawing, recording: Recording, forces: FrameForces, frame: int
) -> None:
    span = slice(*np.asarray(forces.offsets)[frame : frame + 2].tolist())
    points = np.asarray(forces.points, dtype=np.float64)[span]
    vectors = np.asarray(forces.vectors, dtype=np.float64)[span]
    if len(vectors) == 0:
        return
    blocks = [outline for outline in drawing.outlines if not outline.fixed]
    peak = float(np.max(np.linalg.norm(vectors, axis=1)))
    longest = 0.6 * typical_size(blocks) * peak / reference_force(forces)
    draw_forces(canvas, drawing, points, vectors, recording.gravity, longest)
