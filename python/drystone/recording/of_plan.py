"""A plan as a recording: one frame for the whole structure and one for each block taken away."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from drystone import _core
from drystone.common.text import counted, shorten, shown
from drystone.common.units import quantity
from drystone.equilibrium.contact_force import ANY, CANONICAL, WhichForces, which_forces
from drystone.equilibrium.verdict import Verdict
from drystone.recording import budget
from drystone.recording.contract import ABSENT, FALLING, NEXT, PRESENT
from drystone.recording.recording import FrameForces, Recording, Series, rows_of

if TYPE_CHECKING:
    from drystone.planning.answer import Plan

Progress = Callable[[int, int], None]
"""Called with (blocks placed, blocks in all) a few times a second."""

Hands = list[tuple[str, list[float]]]
"""Held blocks, and the wrench of the hand on each: force, N, and moment about its centre, N m."""

MOST_POINTS = {2: 250_000, 3: 100_000}
"""Contact points of all frames together for which forces of least norm are computed, by dimension:
that takes some 10 s. In longer plans only every second, third, ... structure has forces."""

SLACK = 8
"""Forces are computed for this many times what a page may hold; beyond, frames are skipped."""


def plan_recording(
    plan: Plan, progress: Progress | None = None, which: WhichForces = CANONICAL
) -> Recording:
    """The order of `plan` step by step, with contact forces of every structure on the way.

    Without an order it shows the largest structure that could be built, taken apart as it was put
    up. A structure that does not stand as a whole is one frame. `which` says which forces are
    shown: those of least norm ("canonical", see `Verdict.forces`), or those found first ("any"),
    which are not known of structures that stand only because blocks are held.
    """
    which_forces(which)
    headline = str(plan).partition("; ")[0]
    if plan.status == "whole_falls" and plan.whole is not None:
        return _fallen(plan, plan.whole, headline)
    order = plan.order if plan.found else tuple(reversed(plan.reached))
    forces, hands = _forces(plan, order, progress, which)
    notes = []
    if plan.found and len(order) > 1:
        notes.append(
            "Played backwards it is an order of assembly: the last block taken away is the first "
            "one put up."
        )
    if len(np.asarray(forces.vectors)):
        notes.append(
            "Many forces can hold up one structure; these are the ones of least norm."
            if which == CANONICAL
            else "Many forces can hold up one structure; these are some of them."
        )
    if any(plan.holds) and which == ANY:
        notes.append("No forces are shown of structures that stand only because blocks are held.")
    return Recording(
        kind="plan",
        title=headline,
        bodies=plan.scene.bodies,
        states=_states(plan, order),
        held=_held(plan, len(order) + 1) if any(plan.holds) else None,
        gravity=plan.scene.gravity,
        loads=plan.scene.loads,
        forces=forces,
        series=_series(plan, len(order)),
        captions=_captions(plan, order, hands),
        notes=notes,
        details=_details(plan),
    )


def _details(plan: Plan) -> list[str]:
    """What the charts show."""
    margins = (
        "The margin is the least horizontal acceleration that brings down what stands at a step, "
        "with nothing held."
    )
    return [
        *([margins] if _margins(plan) else []),
        f"The search made {counted(plan.tests, 'stability test')} by the method {plan.test!r}, "
        f"with {counted(plan.pivots, 'pivot')} of its solver.",
        "At each step the charts show the work of all tests of structures with as many blocks as "
        "are left at that step. The first check, of the whole structure, is not counted.",
    ]


def _states(plan: Plan, order: Sequence[str]) -> NDArray[np.uint8]:
    names = plan.scene.names
    place = {name: step for step, name in enumerate(order)}
    gone_after = [
        len(order) if body.fixed else place.get(body.name, -1) for body in plan.scene.bodies
    ]
    steps = np.arange(len(order) + 1)[:, None]
    taken = np.asarray(gone_after, dtype=np.int64)[None, :]
    states = np.where(steps > taken, ABSENT, np.where(steps == taken, NEXT, PRESENT))
    states[:, [body.fixed for body in plan.scene.bodies]] = PRESENT
    for name in plan.falls_next:
        states[0, names.index(name)] = FALLING
    return states.astype(np.uint8)


def _held(plan: Plan, frames: int) -> NDArray[np.bool_]:
    names = plan.scene.names
    held = np.zeros((frames, len(names)), dtype=bool)
    for step, blocks in enumerate(plan.holds):
        held[step, [names.index(name) for name in blocks]] = True
    return held


def _captions(plan: Plan, order: Sequence[str], hands: dict[int, Hands]) -> list[tuple[int, str]]:
    captions, margins = [], _margins(plan)
    for step in range(len(order) + 1):
        left = counted(len(order) - step, "block")
        if step > 0:
            text = f"{order[step - 1]} is taken away; {left} left."
        elif plan.found:
            text = f"The whole structure: {left}."
        else:
            text = f"The largest structure reached: {left}."
        if step == 0 and plan.falls_next:
            any_of = "any of " if len(plan.falls_next) > 1 else ""
            text += f" With {any_of}{shorten(plan.falls_next)} something falls."
        if step < len(plan.holds) and plan.holds[step]:
            text += f" Held: {shorten(plan.holds[step])}."
        for name, wrench in hands.get(step, ()):
            force = float(np.linalg.norm(wrench[: plan.scene.dimension]))
            text += f" The hand on {shown(name)} bears {quantity(force, 'N')}."
        if step < len(margins) and np.isfinite(margins[step]):
            text += f" It bears {margins[step]:.3g} g sideways."
        if step < len(order):
            text += f" Next: {_next_step(plan, order, step)}."
        captions.append((step, text))
    return captions


def _next_step(plan: Plan, order: Sequence[str], step: int) -> str:
    """What hands do first, which block goes, and whereto."""
    name = order[step]
    hands = [
        f"{action} {block}"
        for action, block, before in plan.hold_steps
        if before == step and (step > 0 or block not in plan.holds[0]) and block != name
    ]
    way = ""
    if plan.directions:
        numbers = ", ".join(f"{round(x, 3) + 0.0:g}" for x in plan.directions[step])
        way = f" towards ({numbers})"
    away = f"take away {name}{way}"
    return f"{', '.join(hands)}, then {away}" if hands else away


def _margins(plan: Plan) -> tuple[float, ...]:
    """Of each structure on the way, g; none unless the plan was asked for a margin, or they have
    been read: it takes a question or two for each."""
    return plan.margins if plan.margin > 0 or plan.margins_are_known else ()


def _series(plan: Plan, blocks: int) -> list[Series]:
    """For each frame its margin, and the work of all tests of structures with as many blocks."""
    sizes = np.array([record.size for record in plan.records], dtype=np.int64)

    def total(values: Sequence[float]) -> NDArray[np.float64]:
        weights = np.asarray(values, dtype=np.float64)
        by_size = np.zeros(max(blocks, int(sizes.max(initial=0))) + 1)
        np.add.at(by_size, sizes, weights)
        if plan.found:
            by_size[blocks] = np.nan  # the whole: not among the tests
        by_size[0] = np.nan
        return by_size[blocks::-1]

    series = [
        Series("pivots of the stability tests", total([r.pivots for r in plan.records])),
        Series("time of the stability tests", total([r.seconds for r in plan.records]), "s"),
    ]
    if len(set(sizes.tolist())) < len(sizes):
        series.append(Series("stability tests", total([1.0] * len(sizes))))
    if margins := _margins(plan):
        # The bare supports, last, bear whatever comes.
        values = np.array([m if np.isfinite(m) else np.nan for m in (*margins, np.nan)])
        series.insert(0, Series("margin", values, "g", together="least"))
    return series


def _forces(
    plan: Plan, order: Sequence[str], progress: Progress | None, which: WhichForces
) -> tuple[FrameForces, dict[int, Hands]]:
    """Of order[k:] in frame k, and what hands do there; the bare supports are the last frame."""
    scene = plan.scene
    contacts = scene.contacts
    index = {name: body for body, name in enumerate(scene.names)}
    points_in_all = len(contacts) * len(order) / 2
    every = max(1, ceil(points_in_all * budget.FORCE_BYTES[scene.dimension] / _most_bytes()))
    if which == CANONICAL:
        every = max(every, ceil(points_in_all / MOST_POINTS[scene.dimension]))
    held = [list(names) for names in reversed(plan.holds)]
    found = _core.forces_along(
        scene._core, order[::-1], every, progress, plan.cones, held[-len(order) :], which == ANY
    )
    frames = len(order) - found.blocks[::-1]
    counts = np.zeros(len(order) + 1, dtype=np.int64)
    counts[frames] = np.diff(found.offsets)[::-1]
    kept = np.zeros(len(order) + 1, dtype=bool)
    kept[frames] = found.stands[::-1]
    kept[-1] = True
    rows = rows_of(found.offsets[:-1][::-1], np.diff(found.offsets)[::-1])
    pairs = np.array([[index[c.a], index[c.b]] for c in contacts], dtype=np.int64).reshape(-1, 2)
    points = np.array([c.point for c in contacts], dtype=np.float64)
    points = points.reshape(-1, scene.dimension)
    at = found.contact[rows]
    offsets = np.concatenate([[0], np.cumsum(counts)])
    hands = {len(order) - int(n): h for n, h in zip(found.blocks, found.hands, strict=True) if h}
    return FrameForces(offsets, pairs[at], points[at], found.force[rows], kept), hands


def _most_bytes() -> int:
    return SLACK * budget.FILE.forces


def _fallen(plan: Plan, whole: Verdict, headline: str) -> Recording:
    """One frame: the complete assembly, and what of it falls."""
    names = plan.scene.names
    falling = set(whole.falling)
    states = np.array([[FALLING if name in falling else PRESENT for name in names]], np.uint8)
    forces = whole.forces
    return Recording(
        kind="plan",
        title=headline,
        bodies=plan.scene.bodies,
        states=states,
        gravity=plan.scene.gravity,
        loads=plan.scene.loads,
        forces=FrameForces([0, len(forces)], forces.bodies, forces.points, forces.vectors),
        captions=[(0, str(whole).partition("; ")[0] + ".")],
    )
