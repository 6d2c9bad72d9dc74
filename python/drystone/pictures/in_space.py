"""The pictures of `figures.py` for scenes in space: the same colours, keys and words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_hex
from numpy.typing import NDArray

from drystone.common.text import counted
from drystone.equilibrium.mechanism import Moved
from drystone.pictures import style
from drystone.pictures.arrows import draw_arrows
from drystone.pictures.axonometry import Shadow, View
from drystone.pictures.canvas import Canvas, fitted
from drystone.pictures.loads import draw_loads
from drystone.pictures.order_bar import draw_order_bar
from drystone.pictures.outline import outline
from drystone.pictures.shapes import typical_size
from drystone.pictures.solids import Drawing, draw_dashed, draw_solids
from drystone.report.overlaps import names_in, titled
from drystone.scene.body import solids

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from drystone.planning.answer import Plan
    from drystone.scene import Scene, Solid

GHOST_MOVE = 0.35
"""How far the fastest corner of a falling block is shown moved, in typical block sizes."""


def scene_figure(scene: Scene) -> Figure:
    """The bodies with their names; what overlaps in red, with its depth below."""
    drawing = _drawing(scene)
    movable = [body.name for body in drawing.bodies if not body.fixed]
    overlaps = scene.overlaps
    red = names_in(overlaps)
    canvas = fitted(drawing.outlines, *titled(scene, overlaps), key=bool(scene.loads))
    fills = {name: style.FALLING if name in red else style.STONE for name in movable}
    labels = {name: name for name in movable}
    draw_solids(canvas, drawing, fills, dict.fromkeys(red & set(movable), style.FALL), labels)
    if scene.loads:
        present = [outline for outline in drawing.outlines if outline.name in fills]
        longest = min(0.12 * canvas.diagonal, 0.6 * typical_size(present))
        draw_loads(canvas, scene, fills, longest, drawing.view.flat, key_at=0.0)
    return canvas.figure


def moved_figure(verdict: Moved, unit: str) -> Figure:
    """Contact forces to scale; blocks that move in red, with whereto, in so many of a unit."""
    drawing = _drawing(verdict.scene)
    falling = set(verdict.falling)
    headline, _, details = str(verdict).partition("; ")
    fills = {name: style.FALLING if name in falling else style.STONE for name in verdict.names}
    present = [outline for outline in drawing.outlines if outline.name in fills]
    gone = _displaced(drawing, verdict, typical_size(present))
    canvas = fitted([*drawing.outlines, *gone], headline, details, key=True)
    # Names would be under the arrows.
    draw_solids(canvas, drawing, fills, dict.fromkeys(falling, style.FALL))
    longest = min(0.12 * canvas.diagonal, 0.6 * typical_size(present))
    if verdict.forces is not None:
        points, vectors = verdict.forces.points, verdict.forces.vectors
        draw_forces(canvas, drawing, points, vectors, verdict.scene.gravity, longest)
    draw_loads(canvas, verdict.scene, fills, longest, drawing.view.flat)
    if falling:
        _draw_fall(canvas, drawing, verdict, gone, longest, unit)
    return canvas.figure


def plan_figure(plan: Plan) -> Figure:
    """Blocks coloured and numbered by their place in the order."""
    work = f"{counted(plan.tests, 'test')} ({plan.test}), {counted(plan.pivots, 'pivot')}"
    headline = str(plan).partition("; ")[0]
    drawing = _drawing(plan.scene)
    if not plan.found:
        return _unfinished_figure(plan, drawing, headline, work)
    canvas = fitted(drawing.outlines, headline, work, colour_bar=True)
    colours = colormaps[style.ORDER_MAP]
    last = max(len(plan.order) - 1, 1)
    fills = {name: to_hex(colours(1 - i / last)) for i, name in enumerate(plan.order)}
    numbers = {name: str(i + 1) for i, name in enumerate(plan.order)}
    draw_solids(canvas, drawing, fills, labels=numbers)
    draw_order_bar(canvas, len(plan.order))
    return canvas.figure


def draw_forces(
    canvas: Canvas,
    drawing: Drawing,
    points: NDArray[np.float64],
    vectors: NDArray[np.float64],
    gravity: Sequence[float],
    longest: float,
) -> None:
    """Each once, as it acts on the body that is carried: against gravity.

    `longest` is how long the longest would be, were it not foreshortened.
    """
    carrying = np.where((vectors @ np.asarray(gravity) > 0)[:, None], -vectors, vectors)
    flat = drawing.view.flat(carrying)
    peak = float(np.max(np.linalg.norm(vectors, axis=1), initial=0.0))
    if peak > 0:
        reach = longest * float(np.max(np.hypot(*flat.T))) / peak
        draw_arrows(canvas, drawing.view.flat(points), flat, reach, "N", style.FORCE)


def _drawing(scene: Scene) -> Drawing:
    bodies = solids(scene.bodies)
    return Drawing.of(bodies, View.of(bodies, scene.gravity))


def _unfinished_figure(plan: Plan, drawing: Drawing, headline: str, work: str) -> Figure:
    legend = f"reached: {counted(len(plan.reached), 'block')}"
    if plan.falls_next:
        legend += "; red: something falls when any of these is added"
    canvas = fitted(drawing.outlines, headline, f"{legend}\n{work}")
    fills = dict.fromkeys(plan.reached, style.STONE)
    fills |= dict.fromkeys(plan.falls_next, style.FALLING)
    names = {name: name for name in fills}
    draw_solids(canvas, drawing, fills, dict.fromkeys(plan.falls_next, style.FALL), names)
    return canvas.figure


def _displaced(drawing: Drawing, verdict: Moved, size: float) -> list[Shadow]:
    """Where the falling blocks are going."""
    falling = [body for body in drawing.bodies if body.name in verdict.falling]
    moves = [_corner_moves(body, verdict.acceleration(body.name)) for body in falling]
    fastest = max((float(np.max(np.linalg.norm(move, axis=1))) for move in moves), default=0.0)
    reach = GHOST_MOVE * size / fastest if fastest > 0 else 0.0
    found = []
    for body, move in zip(falling, moves, strict=True):
        corners = outline(drawing.view.flat(body.vertices + reach * move))
        x, y = corners.mean(axis=0).tolist()
        found.append(Shadow(body.name, False, (x, y), corners))
    return found


def _draw_fall(
    canvas: Canvas,
    drawing: Drawing,
    verdict: Moved,
    gone: Sequence[Shadow],
    longest: float,
    unit: str,
) -> None:
    """Accelerations to scale, and dashed outlines of where the blocks are going."""
    falling = [body for body in drawing.bodies if body.name in verdict.falling]
    moves = np.array([verdict.acceleration(body.name) for body in falling])
    origins = np.array([body.center_of_mass for body in falling])
    flat = drawing.view.flat
    draw_arrows(canvas, flat(origins), flat(moves[:, :3]), longest, unit, style.FALL, key_at=0.5)
    draw_dashed(canvas, [shadow.vertices for shadow in gone])


def _corner_moves(body: Solid, acceleration: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 3): acceleration of every corner of a body that is at rest, m/s^2."""
    arm = body.vertices - np.asarray(body.center_of_mass)
    moves: NDArray[np.float64] = acceleration[:3] + np.cross(acceleration[3:], arm)
    return moves
