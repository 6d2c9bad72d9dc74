"""Settlements: small displacements that are prescribed for supports."""

from __future__ import annotations

from dataclasses import dataclass

from drystone import _core
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
