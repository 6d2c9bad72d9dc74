"""Permanent loads of a scene: forces, moments and pressures on bodies beside their weight."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from drystone import _core

if TYPE_CHECKING:
    from drystone.scene import Scene


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


def listed(scene: Scene) -> tuple[Load, ...]:
    """The loads of a scene, body by body."""

    def load(
        name: str, body: str, force: tuple[float, ...], at: tuple[float, ...], moment: list[float]
    ) -> Load:
        x, *others = moment
        turning = (x, others[0], others[1]) if others else x
        return Load(name, body, force, at, turning)

    return tuple(load(*found) for found in _core.loads(scene._core))


def vector(value: Any, dimension: int, what: str) -> tuple[float, ...]:
    """`value` as so many floats; SceneError naming `what` otherwise."""
    try:
        found = tuple(float(x) for x in value)
    except (TypeError, ValueError):
        found = ()
    if len(found) != dimension or isinstance(value, str):
        words = "two numbers (x, y)" if dimension == 2 else "three numbers (x, y, z)"
        raise _core.SceneError(f"{what} must be {words}, not {value!r}")
    return found


def number(value: Any, what: str) -> float:
    """`value` as a float; SceneError naming `what` otherwise."""
    try:
        return float(value)
    except (TypeError, ValueError):
        raise _core.SceneError(f"{what} must be a number, not {value!r}") from None


def turning(value: float | Sequence[float] | None, dimension: int) -> tuple[float, float, float]:
    """A moment as the core takes it: three numbers, of which the plane uses the last."""
    if value is None:
        return 0.0, 0.0, 0.0
    if dimension == 2:
        return 0.0, 0.0, number(value, "moment in the plane")
    x, y, z = vector(value, 3, "moment")
    return x, y, z
