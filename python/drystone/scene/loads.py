"""Permanent loads of a scene: forces, moments and pressures on bodies beside their weight."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from drystone import _core
from drystone.common.numbers import Floats, number, vector


@dataclass(frozen=True, slots=True)
class Load:
    """A snapshot of one permanent load."""

    name: str
    """Unique among the loads of its scene."""
    body: str
    """The body that it acts on."""
    force: tuple[float, ...]
    """N, world axes."""
    at: tuple[float, ...]
    """Where the force acts, metres, world coordinates."""
    moment: float | tuple[float, float, float]
    """N m beside the force: counter-clockwise, in space about the axes of the world."""


def listed(scene: _core.Scene) -> tuple[Load, ...]:
    """The loads of a scene, body by body."""

    def load(
        name: str, body: str, force: tuple[float, ...], at: tuple[float, ...], moment: list[float]
    ) -> Load:
        return Load(name, body, force, at, axial(moment))

    return tuple(load(*found) for found in _core.loads(scene))


def axial(numbers: Sequence[float]) -> float | tuple[float, float, float]:
    """A moment or a turn of the core as users have it: a number in the plane, three in space."""
    x, *others = numbers
    return (x, others[0], others[1]) if others else x


def turning(
    value: float | Floats | None, dimension: int, what: str = "moment"
) -> tuple[float, float, float]:
    """A moment or a turn as the core takes it: three numbers, of which the plane uses the last."""
    if value is None:
        return 0.0, 0.0, 0.0
    if dimension == 2:
        return 0.0, 0.0, number(value, f"{what} in the plane")
    x, y, z = vector(value, 3, what)
    return x, y, z
