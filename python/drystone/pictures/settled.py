"""Blocks after a settlement, displacements enlarged, with hinges and the forces through them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from drystone.pictures import style
from drystone.pictures.arrows import draw_arrows, round_number
from drystone.pictures.axonometry import View, placed
from drystone.pictures.canvas import Canvas, fitted
from drystone.pictures.in_space import draw_forces
from drystone.pictures.shapes import draw_absent, draw_blocks, draw_fixed, draw_labels, typical_size
from drystone.pictures.solids import Drawing, draw_solids
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

Moves = Mapping[str, NDArray[np.float64]]
"""Displacement of the centre of mass and turn, (3,) or in space (6,), of the bodies that move."""


def settled_figure(settled: Settled) -> Figure:
    """The blocks after the settlement, dotted where they were."""
    scene = settled.scene
    moves = dict(zip(settled.names, settled.displacements, strict=True)) | _supports(scene)
    if settled.status != "solved":  # then only the supports are shown as they go
        moves = _supports(scene)
    return (_in_plane if scene.dimension == 2 else _in_space)(settled, moves)


def _in_plane(settled: Settled, moves: Moves) -> Figure:
    bodies = planar(settled.scene.bodies)
    there = [body for body in bodies if body.fixed or body.name in settled.names]
    size = typical_size([body for body in there if not body.fixed])
    reach = _reach(there, moves, size)
    after = [_displaced(body, moves, reach) for body in there]
    canvas = fitted([*bodies, *after], *_words(settled, reach), key=True)
    draw_absent(canvas, [body for body in bodies if body.name in moves])
    draw_fixed(canvas, after)
    fills = _fills(settled)
    draw_blocks(canvas, after, fills)
    draw_labels(canvas, after, {name: name for name in fills}, fills)
    if settled.forces is not None:
        points, vectors = settled.forces.points, settled.forces.vectors
        points = points + reach * _at_contacts(settled, moves, points)
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
    reach = _reach(bodies, moves, size)
    after = Drawing.of([_turned(body, moves, reach) for body in bodies], view)
    canvas = fitted([*before.outlines, *after.outlines], *_words(settled, reach), key=True)
    draw_absent(canvas, [outline for outline in before.outlines if outline.name in moves])
    draw_solids(canvas, after, _fills(settled))
    if settled.forces is not None:
        points, vectors = settled.forces.points, settled.forces.vectors
        points = points + reach * _at_contacts(settled, moves, points)
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


def _supports(scene: Scene) -> dict[str, NDArray[np.float64]]:
    """How the supports move, as rows of displacements of their centres of mass."""
    moves: dict[str, NDArray[np.float64]] = {}
    for settlement in scene.settlements:
        center = np.asarray(scene.body(settlement.body).center_of_mass)
        turn = np.atleast_1d(settlement.rotation)
        whole = np.concatenate([np.zeros(len(settlement.displacement)), turn])
        moved = np.asarray(settlement.displacement) + _moved_at(whole, center, settlement.at)
        row = np.concatenate([moved, turn])
        moves[settlement.body] = moves.get(settlement.body, 0.0) + row
    return moves


def _moved_at(
    move: NDArray[np.float64], points: NDArray[np.float64], center: Sequence[float]
) -> NDArray[np.float64]:
    """Displacements of points (n, 2 or 3), or of one, of a body that moves about `center`."""
    arm = points - np.asarray(center)
    if len(move) == 3:
        turned = move[2] * np.stack([-arm[..., 1], arm[..., 0]], axis=-1)
    else:
        turned = np.cross(move[3:], arm)
    moved: NDArray[np.float64] = move[: arm.shape[-1]] + turned
    return moved


def _reach(bodies: Sequence[Body | Solid], moves: Moves, size: float) -> float:
    """By how much displacements are enlarged: a round number, or 0 if nothing moves."""
    corners = [
        _moved_at(moves[body.name], body.vertices, body.center_of_mass)
        for body in bodies
        if body.name in moves
    ]
    largest = max((float(np.linalg.norm(c, axis=1).max()) for c in corners), default=0.0)
    return round_number(SHOWN * size / largest) if largest > 0.0 else 0.0


def _displaced(body: Body, moves: Moves, reach: float) -> Body:
    """To first order, as the answer is: blocks that stay in contact stay so on the picture."""
    if body.name not in moves:
        return body
    move = moves[body.name]
    x, y = body.center_of_mass + reach * move[:2]
    moved = body.vertices + reach * _moved_at(move, body.vertices, body.center_of_mass)
    return replace(body, vertices=moved, center_of_mass=(float(x), float(y)))


def _turned(body: Solid, moves: Moves, reach: float) -> Solid:
    if body.name not in moves:
        return body
    move = reach * moves[body.name]
    half = 0.5 * move[3:]
    w, (x, y, z) = 1.0, half
    a, b, c, d = body.orientation
    turned = np.array(
        [
            w * a - x * b - y * c - z * d,
            w * b + x * a + y * d - z * c,
            w * c - x * d + y * a + z * b,
            w * d + x * c - y * b + z * a,
        ]
    )
    position = np.asarray(body.center_of_mass) + move[:3]
    return placed(body, position.tolist(), (turned / np.linalg.norm(turned)).tolist())


def _at_contacts(
    settled: Settled, moves: Moves, points: NDArray[np.float64]
) -> NDArray[np.float64]:
    """How far the second bodies of contacts have moved at the contact points."""
    assert settled.forces is not None
    bodies = settled.scene.bodies
    still = np.zeros(3 if settled.scene.dimension == 2 else 6)
    return np.array(
        [
            _moved_at(moves.get(bodies[b].name, still), point, bodies[b].center_of_mass)
            for (_, b), point in zip(settled.forces.bodies, points, strict=True)
        ]
    ).reshape(points.shape)


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
        x, y = flat(point + reach * _moved_at(move, point, center)).reshape(2)
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
