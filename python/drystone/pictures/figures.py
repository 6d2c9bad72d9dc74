"""The three pictures: a scene, a verdict, a plan."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_hex

from drystone.common.text import counted
from drystone.equilibrium.mechanism import Moved
from drystone.equilibrium.verdict import Verdict
from drystone.pictures import in_space, style
from drystone.pictures.arrows import draw_arrows, draw_directions
from drystone.pictures.canvas import Canvas, fitted
from drystone.pictures.loads import draw_loads
from drystone.pictures.order_bar import draw_order_bar
from drystone.pictures.overlaps import draw_overlaps
from drystone.pictures.shapes import (
    draw_absent,
    draw_blocks,
    draw_fixed,
    draw_held,
    draw_labels,
    typical_size,
)
from drystone.report.overlaps import names_in, titled
from drystone.scene import Body, Scene
from drystone.scene.body import planar

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from drystone.planning.answer import Plan

GHOST_MOVE = 0.35
"""How far the fastest corner of a falling block is shown moved, in typical block sizes."""


def scene_figure(scene: Scene) -> Figure:
    """The bodies with their names; what overlaps in red, with its depth."""
    if scene.dimension == 3:
        return in_space.scene_figure(scene)
    bodies = planar(scene.bodies)
    movable = [body for body in bodies if not body.fixed]
    overlaps = scene.overlaps
    red = names_in(overlaps)
    canvas = fitted(bodies, *titled(scene, overlaps), key=bool(scene.loads))
    fills = {b.name: style.FALLING if b.name in red else style.STONE for b in movable}
    draw_fixed(canvas, bodies)
    draw_blocks(canvas, bodies, fills, dict.fromkeys(red, style.FALL))
    if overlaps:
        draw_overlaps(canvas, bodies, overlaps)
    draw_labels(canvas, bodies, {name: name for name in fills}, fills)
    draw_loads(canvas, scene, fills, _longest(canvas, movable), key_at=0.0)
    return canvas.figure


def _longest(canvas: Canvas, blocks: Sequence[Body]) -> float:
    """Of the arrows, metres."""
    return min(0.12 * canvas.diagonal, 1.1 * typical_size(blocks))


def verdict_figure(verdict: Verdict) -> Figure:
    """Contact forces to scale; blocks that fall in red, with where they go."""
    return moved_figure(verdict, "m/s²")


def moved_figure(verdict: Moved, unit: str) -> Figure:
    """The same of whatever moves, in so many of a unit."""
    if verdict.scene.dimension == 3:
        return in_space.moved_figure(verdict, unit)
    bodies = planar(verdict.scene.bodies)
    present = set(verdict.names)
    falling = set(verdict.falling)
    headline, _, details = str(verdict).partition("; ")
    blocks = [body for body in bodies if body.name in present]
    gone = _displaced(verdict, blocks)
    canvas = fitted([*bodies, *gone], headline, details, key=True)
    draw_fixed(canvas, bodies)
    draw_absent(canvas, [b for b in bodies if not b.fixed and b.name not in present])
    fills = {name: style.FALLING if name in falling else style.STONE for name in verdict.names}
    draw_blocks(canvas, bodies, fills, dict.fromkeys(falling, style.FALL))
    draw_labels(canvas, bodies, {name: name for name in fills}, fills)
    longest = _longest(canvas, blocks)
    _draw_forces(canvas, verdict, longest)
    draw_loads(canvas, verdict.scene, present, longest)
    if falling:
        _draw_fall(canvas, verdict, blocks, gone, longest, unit)
    return canvas.figure


def plan_figure(plan: Plan) -> Figure:
    """Blocks coloured by their place in the order; without one, how far the search came.

    An assembly that does not stand as a whole is drawn as it falls.
    """
    if plan.status == "whole_falls" and plan.whole is not None:
        return verdict_figure(plan.whole)
    if plan.scene.dimension == 3:
        return in_space.plan_figure(plan)
    # No times: the same plan is the same picture.
    work = f"{counted(plan.tests, 'test')} ({plan.test}), {counted(plan.pivots, 'pivot')}"
    headline = str(plan).partition("; ")[0]
    bodies = planar(plan.scene.bodies)
    if not plan.found:
        return _unfinished_figure(plan, bodies, headline, work)
    held = {name for names in plan.holds for name in names}
    if held:
        work = f"hatched: held on the way ({_counted_holds(plan)})\n{work}"
    canvas = fitted(bodies, headline, work, colour_bar=True)
    colours = colormaps[style.ORDER_MAP]
    last = max(len(plan.order) - 1, 1)
    fills = {name: to_hex(colours(1 - i / last)) for i, name in enumerate(plan.order)}
    draw_fixed(canvas, bodies)
    draw_blocks(canvas, bodies, fills)
    draw_held(canvas, [body for body in bodies if body.name in held])
    if plan.directions:
        _draw_ways_out(canvas, plan)
    draw_labels(canvas, bodies, {n: str(i + 1) for i, n in enumerate(plan.order)}, fills)
    draw_order_bar(canvas, len(plan.order))
    return canvas.figure


def _unfinished_figure(plan: Plan, bodies: Sequence[Body], headline: str, work: str) -> Figure:
    legend = f"reached: {counted(len(plan.reached), 'block')}"
    if plan.falls_next:
        legend += "; red: something falls when any of these is added"
    held = set(plan.holds[0]) if plan.holds else set()
    if held:
        legend += "; hatched: held"
    stuck = [one.name for one in plan.blocked if one.name not in plan.falls_next]
    if stuck:
        legend += "; dark: something is in the way of these"
    canvas = fitted(bodies, headline, f"{legend}\n{work}")
    fills = dict.fromkeys(plan.reached, style.STONE) | dict.fromkeys(stuck, style.STILL)
    fills |= dict.fromkeys(plan.falls_next, style.FALLING)
    draw_fixed(canvas, bodies)
    draw_absent(canvas, [b for b in bodies if not b.fixed and b.name not in fills])
    draw_blocks(canvas, bodies, fills, dict.fromkeys(plan.falls_next, style.FALL))
    draw_held(canvas, [body for body in bodies if body.name in held])
    draw_labels(canvas, bodies, {name: name for name in fills}, fills)
    return canvas.figure


def _counted_holds(plan: Plan) -> str:
    return counted(sum(action == "hold" for action, _, _ in plan.hold_steps), "hold")


def _draw_ways_out(canvas: Canvas, plan: Plan) -> None:
    """From the middle of every block, beside its label, towards where it leaves."""
    bodies = {body.name: body for body in planar(plan.scene.bodies)}
    ways = np.array(plan.directions)
    centroids = np.array([bodies[name].centroid for name in plan.order])
    reach = [
        float(np.max((bodies[name].vertices - centroid) @ way))
        for name, centroid, way in zip(plan.order, centroids, ways, strict=True)
    ]
    lengths = np.array(reach)
    tails = centroids + 0.4 * lengths[:, None] * ways
    draw_directions(canvas, tails, ways, 0.55 * lengths, style.WAY)


def _draw_forces(canvas: Canvas, verdict: Moved, longest: float) -> None:
    """Each force once, as it acts on the body that is carried: against gravity."""
    if verdict.forces is None:
        return
    points, vectors = verdict.forces.points, verdict.forces.vectors
    down = vectors @ np.asarray(verdict.scene.gravity) > 0
    vectors = np.where(down[:, None], -vectors, vectors)
    draw_arrows(canvas, points, vectors, longest, "N", style.FORCE)


def _displaced(verdict: Moved, blocks: Sequence[Body]) -> list[Body]:
    """Where the falling blocks are going."""
    falling = [body for body in blocks if body.name in verdict.falling]
    moves = [_corner_moves(body, verdict.acceleration(body.name)) for body in falling]
    fastest = max((float(np.max(np.hypot(*move.T))) for move in moves), default=0.0)
    reach = GHOST_MOVE * typical_size(blocks) / fastest if fastest > 0 else 0.0
    return [
        replace(body, vertices=body.vertices + reach * move)
        for body, move in zip(falling, moves, strict=True)
    ]


def _draw_fall(
    canvas: Canvas,
    verdict: Moved,
    blocks: Sequence[Body],
    gone: Sequence[Body],
    longest: float,
    unit: str,
) -> None:
    """Accelerations to scale, and dashed outlines of where the blocks are going."""
    falling = [body for body in blocks if body.name in verdict.falling]
    moves = np.array([verdict.acceleration(body.name) for body in falling])
    centers = np.array([body.center_of_mass for body in falling])
    draw_arrows(canvas, centers, moves[:, :2], longest, unit, style.FALL, key_at=0.5)
    outlines = [body.vertices for body in gone]
    canvas.axes.add_collection(
        PolyCollection(
            outlines,
            facecolors="none",
            edgecolors=style.FALL,
            linestyles="dashed",
            linewidths=0.8,
        ),
        autolim=False,
    )


def _corner_moves(body: Body, acceleration: np.ndarray) -> np.ndarray:
    """(n, 2): acceleration of every corner of a body that is at rest, m/s^2."""
    arm = body.vertices - np.asarray(body.center_of_mass)
    turn = acceleration[2] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    moves: np.ndarray = acceleration[:2] + turn
    return moves
