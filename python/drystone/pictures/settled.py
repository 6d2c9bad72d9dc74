"""Blocks after a settlement, displacements enlarged, with hinges and the forces through them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from drystone.pictures import style
from drystone.pictures.arrows import draw_arrows
from drystone.pictures.axonometry import View, placed
from drystone.pictures.canvas import Canvas, fitted
from drystone.pictures.in_space import draw_forces
from drystone.pictures.shapes import draw_absent, draw_blocks, draw_fixed, draw_labels, typical_size
from drystone.pictures.solids import Drawing, draw_solids
from drystone.recording.displaced import (
    Moves,
    enlargement,
    moved_at,
    moved_contacts,
    pose_after,
    settled_moves,
)
from drystone.scene.body import planar, solids

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from drystone.equilibrium.settled import Joint, Settled
    from drystone.pictures.loads import Flat
    from drystone.scene import Body, Scene, Solid

SHOWN = 0.5
"""How far the point that goes furthest is shown moved, in typical block sizes."""
MARKERS = {"hinge": "o", "slides": "s", "parts": "D"}
"""Of joints, by what they do."""
MARKER = 6.0
"""Size of the markers, points."""


def settled_figure(settled: Settled) -> Figure:
    """The blocks after the settlement, dotted where they were."""
    scene = settled.scene
    moves = settled_moves(settled)
    return (_in_plane if scene.dimension == 2 else _in_space)(settled, moves)


def _in_plane(settled: Settled, moves: Moves) -> Figure:
    bodies = planar(settled.scene.bodies)
    there = [body for body in bodies if body.fixed or body.name in settled.names]
    size = typical_size([body for body in there if not body.fixed])
    reach = enlargement(there, moves, SHOWN * size)
    after = [_displaced(body, moves, reach) for body in there]
    canvas = fitted([*bodies, *after], *_words(settled, reach), key=True)
    draw_absent(canvas, [body for body in bodies if body.name in moves])
    draw_fixed(canvas, after)
    fills = _fills(settled)
    draw_blocks(canvas, after, fills)
    draw_labels(canvas, after, {name: name for name in fills}, fills)
    if settled.forces is not None:
        points, vectors = settled.forces.points, settled.forces.vectors
        points = points + reach * moved_contacts(settled.scene, moves, settled.forces)
        down = vectors @ np.asarray(settled.scene.gravity) > 0
        vectors = np.where(down[:, None], -vectors, vectors)  # as on what is carried
        draw_arrows(canvas, points, vectors, min(0.12 * canvas.diagonal, size), "N", style.FORCE)
    _draw_joints(canvas, settled.joints, moves, settled.scene, reach, np.asarray)
    return canvas.figure


def _in_space(settled: Settled, moves: Moves) -> Figure:
    bodies = [b for b in solids(settled.scene.bodies) if b.fixed or b.name in settled.names]
    view = View.of(bodies, settled.scene.gravity)
    before = Drawing.of(bodies, view)
    size = typical_size([outline for outline in before.outlines if not outline.fixed])
    reach = enlargement(bodies, moves, SHOWN * size)
    after = Drawing.of([_turned(body, moves, reach) for body in bodies], view)
    canvas = fitted([*before.outlines, *after.outlines], *_words(settled, reach), key=True)
    draw_absent(canvas, [outline for outline in before.outlines if outline.name in moves])
    draw_solids(canvas, after, _fills(settled))
    if settled.forces is not None:
        points, vectors = settled.forces.points, settled.forces.vectors
        points = points + reach * moved_contacts(settled.scene, moves, settled.forces)
        longest = min(0.12 * canvas.diagonal, 0.6 * size)
        draw_forces(canvas, after, points, vectors, settled.scene.gravity, longest)
    _draw_joints(canvas, settled.joints, moves, settled.scene, reach, view.flat)
    return canvas.figure


def _fills(settled: Settled) -> dict[str, str]:
    """Colours of the blocks: red where supports squeeze them."""
    red = set(settled.squeezed)
    return {name: style.FALLING if name in red else style.STONE for name in settled.names}


def _words(settled: Settled, reach: float) -> tuple[str, str]:
    """Title and note."""
    headline, _, details = str(settled).partition("; ")
    note = f"displacements {reach:g} times as large, dotted: before; " if reach > 0.0 else ""
    return headline, note + details


def _displaced(body: Body, moves: Moves, reach: float) -> Body:
    """To first order, as the answer is: blocks that stay in contact stay so on the picture."""
    if body.name not in moves:
        return body
    move = moves[body.name]
    x, y = body.center_of_mass + reach * move[:2]
    moved = body.vertices + reach * moved_at(move, body.vertices, body.center_of_mass)
    return replace(body, vertices=moved, center_of_mass=(float(x), float(y)))


def _turned(body: Solid, moves: Moves, reach: float) -> Solid:
    if body.name not in moves:
        return body
    pose = pose_after(body, reach * moves[body.name]).tolist()
    return placed(body, pose[:3], pose[3:])


def _draw_joints(
    canvas: Canvas,
    joints: Sequence[Joint],
    moves: Moves,
    scene: Scene,
    reach: float,
    flat: Flat,
) -> None:
    """A marker at every joint that opens, on the second body: a disc for a hinge."""
    still = np.zeros(3 if scene.dimension == 2 else 6)
    for joint in joints:
        point = np.asarray(joint.at)
        move = moves.get(joint.b, still)
        center = scene.body(joint.b).center_of_mass
        x, y = flat(point + reach * moved_at(move, point, center)).reshape(2)
        canvas.axes.plot(
            x,
            y,
            marker=MARKERS[joint.opening],
            markersize=MARKER,
            markerfacecolor=style.FALL if joint.opening == "hinge" else "white",
            markeredgecolor=style.FALL,
            linestyle="none",
            zorder=6,
        )
