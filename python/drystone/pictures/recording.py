"""One frame of a recording, as a picture: the same view and the same scale of forces in all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import NDArray

from drystone.pictures import style
from drystone.pictures.arrows import draw_arrows
from drystone.pictures.axonometry import Shadow
from drystone.pictures.canvas import Canvas, Outlined, fitted
from drystone.pictures.frames import Box, box_around, fills_in, note_of, reference_force
from drystone.pictures.recording_in_space import solid_box, solid_frame
from drystone.pictures.shapes import (
    draw_absent,
    draw_blocks,
    draw_fixed,
    draw_held,
    draw_labels,
    typical_size,
)
from drystone.recording.recording import FrameForces, Recording, own_frame
from drystone.scene import Body

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def frames_box(recording: Recording, frames: Sequence[int] | None = None) -> Box:
    """What the pictures of these frames show, or those of all."""
    if recording.dimension == 3:
        return solid_box(recording, frames)
    return box_around(recording, partial(_moved, recording), frames)


def frame_figure(recording: Recording, frame: int, box: Box | None = None) -> Figure:
    """Bodies by state, forces to one scale; IndexError if there is no such frame.

    `box` is what it shows, by default `frames_box` of all frames. It takes longer than a picture:
    for many of them it is to be found once.
    """
    frames = len(recording.states)
    if not 0 <= frame < frames:
        raise IndexError(f"frame {frame}: there are frames 0 to {frames - 1}")
    box = frames_box(recording) if box is None else box
    if recording.dimension == 3:
        return solid_frame(recording, frame, box)
    bodies = _moved(recording, frame)
    span: list[Outlined] = [body for body in bodies if body.fixed]
    span.append(Shadow("", False, (0.0, 0.0), np.array(box)))
    canvas = fitted(span, recording.title, note_of(recording, frame), key=True)
    fills = fills_in(recording, frame)
    draw_fixed(canvas, bodies)
    if recording.kind == "plan":
        draw_absent(canvas, [b for b in bodies if not b.fixed and b.name not in fills])
    draw_blocks(canvas, bodies, fills)
    if recording.held is not None:
        draw_held(
            canvas, [b for b, held in zip(bodies, recording.held[frame], strict=True) if held]
        )
    draw_labels(canvas, bodies, {name: name for name in fills}, fills)
    if recording.forces is not None:
        _draw_forces(canvas, recording, recording.forces, frame)
    return canvas.figure


def _moved(recording: Recording, frame: int) -> list[Body]:
    """The bodies where the frame has them."""
    bodies = cast("Sequence[Body]", recording.bodies)
    if recording.poses is None:
        return list(bodies)
    return [
        replace(body, center_of_mass=(x, y), angle=angle, vertices=_placed(body, x, y, angle))
        for body, (x, y, angle) in zip(bodies, recording.poses[frame].tolist(), strict=True)
    ]


def _placed(body: Body, x: float, y: float, angle: float) -> NDArray[np.float64]:
    cos, sin = np.cos(angle), np.sin(angle)
    turned = own_frame(body) @ np.array([[cos, sin], [-sin, cos]])
    corners: NDArray[np.float64] = turned + np.array([x, y])
    return corners


def _draw_forces(canvas: Canvas, recording: Recording, forces: FrameForces, frame: int) -> None:
    """Each once, as it acts on the body that is carried: against gravity."""
    span = slice(*np.asarray(forces.offsets)[frame : frame + 2].tolist())
    points = np.asarray(forces.points, dtype=np.float64)[span]
    vectors = np.array(forces.vectors, dtype=np.float64)[span]
    if len(vectors) == 0:
        return
    vectors[vectors @ np.asarray(recording.gravity) > 0] *= -1
    bodies = cast("Sequence[Body]", recording.bodies)
    blocks = [body for body in bodies if not body.fixed]
    peak = float(np.max(np.hypot(*vectors.T)))
    longest = 1.1 * typical_size(blocks) * peak / reference_force(forces)
    draw_arrows(canvas, points, vectors, longest, "N", style.FORCE)
