"""How blocks follow a settlement, or begin to move, as a recording: enlarged, to be seen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from drystone.common.text import shown
from drystone.common.units import quantity
from drystone.recording.contract import ABSENT, FALLING, PRESENT
from drystone.recording.displaced import (
    Moves,
    enlargement,
    moved_contacts,
    pose_after,
    pose_of,
    settled_moves,
)
from drystone.recording.recording import FrameForces, Recording

if TYPE_CHECKING:
    from drystone.equilibrium.contact_force import ContactForces
    from drystone.equilibrium.mechanism import Moved
    from drystone.equilibrium.settled import Joint, Settled
    from drystone.equilibrium.verdict import Verdict
    from drystone.scene import Scene

FRAMES = 40
"""Of a motion, after that of rest."""

SECONDS = 2.0
"""How long it is played."""

SETTLED, MOVED = 0.7, 0.3
"""How far the corner that goes furthest is shown moved, in sizes of a block. Bodies turn as rigid
ones there: where they turn much, faces that stay in touch part a little on the page."""


MOST_JOINTS = 12
"""What so many joints do is said, of the first ones."""


def verdict_recording(verdict: Verdict) -> Recording:
    """How the blocks follow a settlement, after the forces before it; how they begin to fall; or
    one frame of what stands, with its forces."""
    if verdict.settled is not None:
        return settled_recording(verdict.settled, verdict.forces)
    return moved_recording(verdict)


def moved_recording(moved: Moved) -> Recording:
    """A frame at rest, with the forces, and how blocks begin to move from there, if any do."""
    moving = moved.falling
    moves = {name: moved.acceleration(name) for name in moving}
    first, *more = str(moved).splitlines()
    title, _, details = first.partition("; ")
    captions = [(0, "At rest, with the contact forces.")]
    if moving:
        captions.append((1, "How it begins to move, enlarged."))
    return _recording(
        moved.scene,
        moves,
        _enlargement(moved.scene, moves, MOVED),
        [moved.forces],
        title=title,
        states=_states(moved.scene, moved.names, moving),
        captions=captions,
        notes=[*_sentence(details), *more],
    )


def settled_recording(settled: Settled, before: ContactForces | None = None) -> Recording:
    """A frame before the settlement, with the forces `before` it, and how the blocks follow, with
    the forces after it. One frame where rigid blocks cannot follow."""
    scene = settled.scene
    moves = settled_moves(settled) if settled.status == "solved" else {}
    factor = _enlargement(scene, moves, SETTLED)
    title, _, details = str(settled).partition("; ")
    captions = [(0, "Before the settlement.")]
    if factor > 0.0:
        captions.append((1, f"The settlement, displacements {factor:g} times as large."))
    elif settled.squeezed:
        captions = [(0, "Rigid blocks cannot follow: the red ones are squeezed.")]
    joints = [_said_of_joint(joint) for joint in settled.joints[:MOST_JOINTS]]
    if len(settled.joints) > MOST_JOINTS:
        joints.append(f"And {len(settled.joints) - MOST_JOINTS} more joints.")
    return _recording(
        scene,
        moves,
        factor,
        [before, settled.forces],
        title=title,
        states=_states(scene, settled.names, settled.squeezed),
        captions=captions,
        notes=[*_sentence(details), *joints],
    )


def _recording(
    scene: Scene,
    moves: Moves,
    factor: float,
    forces: Sequence[ContactForces | None],
    *,
    title: str,
    states: NDArray[np.uint8],
    captions: Sequence[tuple[int, str]],
    notes: Sequence[str],
) -> Recording:
    """`factor` enlarges the moves; `forces` are those of the first frame, and of those that follow
    if there is a second. `states` (bodies,) are the same in all frames."""
    shares = np.linspace(0.0, 1.0, FRAMES + 1) if factor > 0.0 else np.zeros(1)
    poses = np.array([_poses(scene, moves, factor * share) for share in shares])
    return Recording(
        kind="motion",
        title=title,
        bodies=scene.bodies,
        states=np.tile(states, (len(shares), 1)),
        gravity=scene.gravity,
        poses=poses if len(shares) > 1 else None,
        times=SECONDS * shares,
        forces=_forces(scene, moves, factor * shares, forces),
        loads=scene.loads,
        captions=captions,
        notes=notes,
    )


def _enlargement(scene: Scene, moves: Moves, most: float) -> float:
    blocks = [body for body in scene.bodies if not body.fixed]
    sides = [np.ptp(body.vertices, axis=0) for body in blocks]
    size = float(np.median([np.prod(side) ** (1 / len(side)) for side in sides])) if sides else 1.0
    return enlargement(scene.bodies, moves, most * size)


def _poses(scene: Scene, moves: Moves, factor: float) -> NDArray[np.float64]:
    bodies = scene.bodies
    return np.array(
        [
            pose_after(body, factor * moves[body.name]) if body.name in moves else pose_of(body)
            for body in bodies
        ]
    )


def _states(scene: Scene, names: Sequence[str], red: Sequence[str]) -> NDArray[np.uint8]:
    """(bodies,)."""
    there, marked = set(names), set(red)

    def state(name: str, fixed: bool) -> int:
        if fixed:
            return PRESENT
        return FALLING if name in marked else PRESENT if name in there else ABSENT

    return np.array([state(body.name, body.fixed) for body in scene.bodies], dtype=np.uint8)


def _forces(
    scene: Scene,
    moves: Moves,
    factors: NDArray[np.float64],
    forces: Sequence[ContactForces | None],
) -> FrameForces | None:
    """Each at its contact point, where that has gone with the second body."""
    first, *rest = forces
    every = [first, *((rest[0] if rest else None) for _ in factors[1:])]
    if all(one is None for one in every):
        return None
    counts = [0 if one is None else len(one) for one in every]
    there = [(one, factor) for one, factor in zip(every, factors, strict=True) if one is not None]
    return FrameForces(
        np.concatenate([[0], np.cumsum(counts)]),
        np.concatenate([one.bodies for one, _ in there]),
        np.concatenate(
            [one.points + factor * moved_contacts(scene, moves, one) for one, factor in there]
        ),
        np.concatenate([one.vectors for one, _ in there]),
    )


def _sentence(text: str) -> list[str]:
    """What follows a semicolon, on a line of its own; none if nothing does."""
    return [text[0].upper() + text[1:]] if text else []


def _said_of_joint(joint: Joint) -> str:
    what = {"hinge": "Hinge", "slides": "Sliding joint", "parts": "Open joint"}[joint.opening]
    opens = f"opens by {quantity(joint.opens, 'm')}"
    slides = f", slides by {quantity(joint.slides, 'm')}" if joint.opening == "slides" else ""
    return f"{what} between {shown(joint.a)} and {shown(joint.b)}: {opens}{slides}."
