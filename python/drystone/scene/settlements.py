"""Settlements: small displacements that are prescribed for supports."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from warnings import warn

from drystone import _core
from drystone.scene.body import Body, Solid
from drystone.scene.loads import axial


@dataclass(frozen=True, slots=True)
class Settlement:
    """A snapshot of how one support is to move."""

    body: str
    """The fixed body that settles."""
    displacement: tuple[float, ...]
    """Displacement of the point `at`, metres, along the axes of the world."""
    rotation: float | tuple[float, float, float]
    """Turn about that point, radians: counter-clockwise, in space about the axes of the world."""
    at: tuple[float, ...]
    """About which point it turns, metres, world coordinates."""


def listed(scene: _core.Scene) -> tuple[Settlement, ...]:
    """The settlements of a scene, body by body."""
    return tuple(
        Settlement(body, displacement, axial(rotation), at)
        for body, displacement, rotation, at in _core.settlements(scene)
    )


def require_small(displacement: Sequence[float], bodies: Sequence[Body | Solid]) -> None:
    """A hint where a displacement looks like one in millimetres."""
    corners = [corner for body in bodies for corner in body.vertices.tolist()]
    size = max((max(xs) - min(xs) for xs in zip(*corners, strict=True)), default=0.0)
    moved = math.hypot(*displacement)
    if moved > 0.1 * size:
        warn(
            f"the displacement is {moved:g} m, and the whole scene {size:g} m wide: a settlement "
            "is small, and in metres",
            UserWarning,
            stacklevel=3,
        )
