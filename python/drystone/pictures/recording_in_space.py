"""One frame of a recording in space, as a picture: the same view and scale of forces in all."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, cast

import numpy as np

from drystone.pictures.axonometry import Shadow, View, placed
from drystone.pictures.canvas import Canvas, fitted
from drystone.pictures.frames import Box, box_around, fills_in, note_of, reference_force
from drystone.pictures.in_space import draw_forces
from drystone.pictures.shapes import typical_size
from drystone.pictures.solids import Drawing, draw_solids
from drystone.recording.recording import FrameForces, Recording
from drystone.scene import Solid

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def solid_box(recording: Recording, frames: Sequence[int] | None) -> Box:
    """Around the movable bodies in these frames."""
    return box_around(recording, partial(_moved, recording), frames)


def solid_frame(recording: Recording, frame: int, box: Box) -> Figure:
    """Bodies by state, forces to one scale."""
    first = _moved(recording, 0)
    view = View.of(first, recording.gravity)
    drawing = Drawing.of(_moved(recording, frame), view, box)
    # What spans the view is the same in all frames with one box: fixed bodies, and what is in it.
    corners = np.array(list(itertools.product(*np.stack(box, axis=1))))
    span = [shadow for shadow in drawing.outlines if shadow.fixed or recording.poses is None]
    if recording.poses is not None:
        span.append(Shadow("", False, (0.0, 0.0), view.flat(corners)))
    canvas = fitted(span, recording.title, note_of(recording, frame), key=True)
    fills = fills_in(recording, frame)
    names = {name: name for name in fills}
    draw_solids(canvas, drawing, fills, labels=names, ghosts=recording.kind == "plan")
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
