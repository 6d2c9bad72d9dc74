"""A simulator's fastest run of a scene, for tables with a line for each simulator."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import drystone as ds
import results
from simulators import Motion, Simulator
from simulators.base import Velocities
from simulators.drystone import Drystone

RATE = 240
"""Steps a second."""

ROUNDS = 3
"""Runs of which the fastest counts; they move alike."""

LONG = 5.0
"""Seconds: what takes longer is run once."""

COLUMNS = ("scene", "blocks", "friction", "dt", "steps", "simulator", "simulator_version")
"""Of such a table, behind those of `results.WHERE`."""

TIMES = {"microseconds": "us a step", "worst_ms": "worst, ms", "not_exact": "not exact"}
"""Columns of `times` besides, with their titles where they are shown."""

BESIDE = {**TIMES, "ratio": "drystone / it"}
"""The same of `beside`."""


def common(scene: str, blocks: int, friction: float, steps: int) -> dict[str, object]:
    """What is the same on the lines of all simulators."""
    return results.where(results.load()) | {
        "scene": scene,
        "blocks": blocks,
        "friction": f"{friction:g}",
        "dt": f"1/{RATE}",
        "steps": steps,
    }


def fastest_run(
    simulator: Simulator,
    scene: ds.Scene,
    steps: int,
    every: int,
    velocities: Velocities | None = None,
) -> Motion:
    """The fastest of some runs, or the one that takes long."""

    def once() -> Motion:
        return simulator.run(scene, 1 / RATE, steps, every, velocities)

    first = once()
    again = [once() for _ in range(0 if first.seconds > LONG else ROUNDS - 1)]
    return min(first, *again, key=lambda motion: motion.seconds) if again else first


def times(simulator: Simulator, motion: Motion, steps: int) -> dict[str, object]:
    """Who it was, and how long a step took."""
    return {
        "simulator": simulator.name,
        "simulator_version": simulator.version(),
        "microseconds": results.number(1e6 * motion.seconds / steps, 3),
        "worst_ms": results.number(1e3 * motion.worst, 3),
        "not_exact": motion.not_exact if isinstance(simulator, Drystone) else "",
    }


def beside(
    common: dict[str, object],
    scene: ds.Scene,
    steps: int,
    simulators: Iterable[Simulator],
    velocities: Velocities | None = None,
) -> Iterator[dict[str, object]]:
    """A line for each simulator, drystone first, with the ratio of its time to theirs."""
    first = math.nan
    for simulator in simulators:
        motion = fastest_run(simulator, scene, steps, steps, velocities)
        ours = isinstance(simulator, Drystone)
        first = motion.seconds if ours else first
        ratio = "" if ours else results.number(first / motion.seconds, 3)
        yield common | times(simulator, motion, steps) | {"ratio": ratio}
