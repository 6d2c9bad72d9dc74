"""Where small displacements take bodies: those of a settlement, or the beginning of a motion."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from drystone.common.units import round_number
from drystone.scene.body import Body, Solid

if TYPE_CHECKING:
    from drystone.equilibrium.contact_force import ContactForces
    from drystone.equilibrium.settled import Settled
    from drystone.scene import Scene

Moves: TypeAlias = Mapping[str, NDArray[np.float64]]
"""Displacement of the centre of mass and turn, (3,) or in space (6,), of the bodies that move."""


def settled_moves(settled: Settled) -> Moves:
    """Of the supports, and of the blocks if it is known how these follow."""
    supports = support_moves(settled.scene)
    if settled.status != "solved":
        return supports
    return dict(zip(settled.names, settled.displacements, strict=True)) | supports


def support_moves(scene: Scene) -> dict[str, NDArray[np.float64]]:
    """How the supports move."""
    moves: dict[str, NDArray[np.float64]] = {}
    for settlement in scene.settlements:
        center = np.asarray(scene.body(settlement.body).center_of_mass)
        turn = np.atleast_1d(settlement.rotation)
        whole = np.concatenate([np.zeros(len(settlement.displacement)), turn])
        moved = np.asarray(settlement.displacement) + moved_at(whole, center, settlement.at)
        row = np.concatenate([moved, turn])
        moves[settlement.body] = moves.get(settlement.body, 0.0) + row
    return moves


def moved_at(
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


def moved_contacts(scene: Scene, moves: Moves, forces: ContactForces) -> NDArray[np.float64]:
    """How far the second bodies of contacts move at the contact points, as `forces.points`."""
    bodies, moved = scene.bodies, np.zeros_like(forces.points)
    for k, (point, (_, b)) in enumerate(zip(forces.points, forces.bodies, strict=True)):
        if bodies[b].name in moves:
            moved[k] = moved_at(moves[bodies[b].name], point, bodies[b].center_of_mass)
    return moved


def enlargement(bodies: Iterable[Body | Solid], moves: Moves, most: float) -> float:
    """By how much displacements are multiplied so that no corner goes further than `most`, metres:
    a round number, or 0 if nothing moves."""
    corners = [
        moved_at(moves[body.name], body.vertices, body.center_of_mass)
        for body in bodies
        if body.name in moves
    ]
    largest = max((float(np.linalg.norm(c, axis=1).max()) for c in corners), default=0.0)
    return round_number(most / largest) if largest > 0.0 else 0.0


def pose_of(body: Body | Solid) -> NDArray[np.float64]:
    """(3,): the centre of mass and the angle; in space (7,): with the orientation."""
    turn = (body.angle,) if isinstance(body, Body) else body.orientation
    return np.array([*body.center_of_mass, *turn], dtype=float)


def pose_after(body: Body | Solid, move: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same after a displacement, turned as a rigid body."""
    if isinstance(body, Body):
        return pose_of(body) + move
    w, (x, y, z) = 1.0, 0.5 * move[3:]
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
    return np.concatenate([position, turned / np.linalg.norm(turned)])
