"""Figs. 1 and 4: what reuse saves in a simulation, segment by segment."""

from __future__ import annotations

import csv
from collections.abc import Callable
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from drystone import scenes
from drystone.motion.modes import REUSE, Reuse
from drystone.motion.run import Run
from drystone.motion.simulation import simulate
from drystone.paper.plain import plain_table

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from rich.table import Table

    from drystone.scene import Scene

MODES = tuple(reversed(REUSE))
"""none, motionless, full: the first is what the others are compared with."""

REPEATS = 7
"""Runs of which the fastest time of every step counts; the work is the same in all of them."""

SHORTEST = 20
"""Segments of fewer steps are left out: blocks that come to rest one after the other."""


@dataclass(frozen=True, slots=True)
class Motion:
    """A scene that moves, after a figure of the paper."""

    name: str
    build: Callable[[], Scene]
    steps: int
    printed: str
    """What the paper says about its own."""


MOTIONS = (
    Motion(
        "Fig. 1",
        scenes.falling_column,
        584,
        "time saved by motionless: 45 %, with five of seven motionless 65 %",
    ),
    Motion(
        "Fig. 4",
        scenes.three_segments,
        353,
        "second segment nearly four times slower with motionless",
    ),
)
"""The paper's scenes are not published: ours are built to do what it describes."""


@dataclass(frozen=True, slots=True, eq=False)
class Segment:
    """Steps in which the same bodies move, or a whole run."""

    motion: Motion
    label: str
    moving: int
    """Bodies in motion; -1 for a whole run."""
    first: int
    steps: int
    pivots: dict[str, int]
    seconds: dict[str, float]
    """Of all solves of complementarity problems, by the mode of reuse."""

    def saved(self, work: dict[str, int] | dict[str, float], mode: str) -> float:
        """Share of the work without reuse that a mode does not do."""
        return 1 - work[mode] / work["none"]


@dataclass(frozen=True, slots=True, eq=False)
class Measured:
    """One scene in all modes."""

    motion: Motion
    runs: dict[str, Run]
    seconds: dict[str, NDArray[np.float64]]
    """The fastest time of every step's solves."""

    def segments(self) -> list[Segment]:
        """The whole run, then the segments with the same bodies in motion."""
        still = self.runs["full"].motionless
        found = [self._segment("all", -1, 0, len(still))]
        first = 0
        for rests, group in groupby(map(tuple, still)):
            steps = len(list(group))
            if steps >= SHORTEST and not all(rests):
                moving = rests.count(False)
                found.append(self._segment(f"{moving} of 7 move", moving, first, steps))
            first += steps
        return found

    def _segment(self, label: str, moving: int, first: int, steps: int) -> Segment:
        part = slice(first, first + steps)
        pivots = {mode: int(run.pivots[part].sum()) for mode, run in self.runs.items()}
        seconds = {mode: float(times[part].sum()) for mode, times in self.seconds.items()}
        return Segment(self.motion, label, moving, first, steps, pivots, seconds)


def measure_motions(announce: Callable[[str], None] = lambda what: None) -> list[Measured]:
    """Simulate every scene in every mode, the modes in turns."""
    measured = []
    for motion in MOTIONS:
        announce(motion.name)
        scene = motion.build()
        rounds = [{mode: _run(scene, motion.steps, mode) for mode in MODES} for _ in range(REPEATS)]
        fastest = {
            mode: np.min([runs[mode].solve_seconds for runs in rounds], axis=0) for mode in MODES
        }
        measured.append(Measured(motion, rounds[0], fastest))
    return measured


def _run(scene: Scene, steps: int, mode: Reuse) -> Run:
    run = simulate(scene, steps=steps, reuse=mode)
    if run.ending == "interrupted":  # its work is not that of all steps
        raise KeyboardInterrupt
    return run


def motion_tables(measured: list[Measured]) -> list[Table]:
    """Pivots by segment, then the times of the solves."""
    pivots = _table("Simulation: pivots by the mode of reuse")
    times = _table("Milliseconds in solves, on this machine")
    for scene in measured:
        for segment in scene.segments():
            where = (scene.motion.name if segment.moving < 0 else "", segment.label)
            saved = [segment.saved(work, "full") for work in (segment.pivots, segment.seconds)]
            pivots.add_row(
                *where,
                str(segment.steps),
                *(str(segment.pivots[mode]) for mode in MODES),
                f"{100 * saved[0]:.0f} %",
            )
            times.add_row(
                *where,
                str(segment.steps),
                *(f"{1e3 * segment.seconds[mode]:.3g}" for mode in MODES),
                f"{100 * saved[1]:.0f} %",
            )
    times.caption = "\n".join(f"the paper, {m.name}: {m.printed}" for m in MOTIONS)
    return [pivots, times]


def _table(title: str) -> Table:
    table = plain_table(title)
    for heading in ("figure", "segment"):
        table.add_column(heading, no_wrap=True)
    for heading in ("steps", *MODES, "full saves"):
        table.add_column(heading, justify="right", no_wrap=True)
    return table


def write_motion_csv(measured: list[Measured], folder: Path) -> Path:
    """One line a segment and mode."""
    path = folder / "motion.csv"
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["figure", "segment", "first", "steps", "reuse", "pivots", "solve_seconds"])
        for scene in measured:
            for s in scene.segments():
                for mode in MODES:
                    where = (scene.motion.name, s.label, s.first, s.steps)
                    writer.writerow([*where, mode, s.pivots[mode], f"{s.seconds[mode]:.6f}"])
    return path
