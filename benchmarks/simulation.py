"""Time per step and drift of simulations: drystone and its peers, one thread, in turns.

    python benchmarks/simulation.py [--quick] [--space] [--scenes ...] [--rates ...]
        [--simulators ...]

Results go to results/<machine>/<version>-<date>-simulation[-space].csv and to the screen. The
file is rewritten after every scene, so that an interrupted run leaves what it measured.
"""

from __future__ import annotations

import threads  # noqa: F401  (before anything that loads NumPy)

# isort: split

import argparse
import gc
import math
import statistics
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

import drystone as ds
import judge
import results
from simulators import SIMULATORS, Simulator

SECONDS = 5
"""Simulated."""

LOOKS = 20
"""Times a second that places are looked at, between the steps timed."""

ROUNDS = 25
"""Most repetitions."""

REPEAT_WITHIN = 10.0
"""Seconds of steps: a simulator is repeated while its repetitions together take less."""

FRICTION = 0.5

STILL: dict[str, Callable[[str], bool]] = {
    "col20": lambda name: True,
    "col50": lambda name: True,
    "pyr13": lambda name: True,
    "fall7": lambda name: name in {"1", "2", "3", "4", "5"},
    "wall84": lambda name: True,
    "drop84": lambda name: False,
}
"""The scenes, and which of their blocks should stay where they are."""

QUICK = ("col20", "fall7")

SPACE = ("col20", "pyr13", "fall7")
"""The scenes that are simulated as boxes in space too."""

DEPTH = 1.0
"""Metres, of these boxes."""

MOST_FROM_SCRATCH = 30
"""Blocks in space: with more a step from scratch takes a second, and 1,200 are too many."""

COLUMNS = (
    *results.WHERE,
    "scene",
    "dimension",
    "blocks",
    "friction",
    "dt",
    "steps",
    "simulator",
    "simulator_version",
    "microseconds",
    "microseconds_least",
    "microseconds_most",
    "rounds",
    "ratio_to_full",
    "ratio_of_least",
    "displacement",
    "penetration",
    "energy_rise",
    "stopped",
    "refused",
)
"""Explained in benchmarks/README.md."""


@dataclass(slots=True)
class Measured:
    """One simulator on one scene."""

    simulator: Simulator
    refused: str
    times: list[float] = field(default_factory=list)
    """Seconds a step, one entry a round."""
    displacement: float = math.nan
    penetration: float = math.nan
    energy_rise: float = math.nan
    stopped: str = ""

    @property
    def median(self) -> float:
        """Of the rounds, seconds a step."""
        return statistics.median(self.times) if self.times else math.nan

    @property
    def least(self) -> float:
        """Of the rounds: what other work on the machine disturbed least."""
        return min(self.times, default=math.nan)


@dataclass(slots=True)
class Case:
    """One scene at one time step, with everybody's results."""

    scene: str
    dimension: int
    blocks: int
    rate: int
    results: dict[str, Measured]
    load: float = math.nan

    def ratio(self, result: Measured) -> float:
        """A simulator's median time by that of full reuse."""
        full = self.results.get("full")
        return result.median / full.median if full else math.nan

    def ratio_of_least(self, result: Measured) -> float:
        """As `ratio`, of the least times."""
        full = self.results.get("full")
        return result.least / full.least if full else math.nan


def main() -> None:
    """Measure what the arguments say."""
    arguments = _arguments()
    console = Console()
    console.width = max(console.width, 100)
    simulators = {key: SIMULATORS[key] for key in arguments.simulators}
    for simulator in simulators.values():
        if not simulator.missing():
            with console.status(f"{simulator.name}: being made ready"):
                simulator.prepare()
    dimension = 3 if arguments.space else 2
    names = arguments.scenes or (QUICK if arguments.quick else SPACE if arguments.space else STILL)
    path = results.path_in(arguments.output)
    ending = f"-simulation{'-space' * arguments.space}{'-quick' * arguments.quick}.csv"
    path = path.with_name(path.name + ending)
    cases: list[Case] = []
    for rate in arguments.rates:
        for name in names:
            with console.status(f"{name}, dt = 1/{rate}") as status:
                cases.append(measure(name, rate, simulators, status.update, dimension=dimension))
            show(console, cases[-1])
            results.write_lines(path, COLUMNS, _lines(cases))
    console.print(f"wrote {path}", soft_wrap=True)


def measure(
    name: str,
    rate: int,
    simulators: dict[str, Simulator],
    say: Callable[[str], None] = lambda text: None,
    rounds: int = ROUNDS,
    dimension: int = 2,
) -> Case:
    """Every simulator in turn, then all again in the opposite order, and so on."""
    scene = getattr(ds.scenes, name)(friction=FRICTION)
    if dimension == 3:
        scene = scene.extruded(DEPTH)
    steps, every = SECONDS * rate, rate // LOOKS
    still = np.array([not body.fixed and STILL[name](body.name) for body in scene.bodies])
    measured = {
        key: Measured(peer, peer.missing())
        for key, peer in simulators.items()
        if dimension in peer.dimensions
    }
    if dimension == 3 and len(scene) > MOST_FROM_SCRATCH:
        for key in {"motionless", "none"} & measured.keys():
            measured[key].refused = "left out: a second a step"
    running = [key for key, result in measured.items() if not result.refused]
    for round_ in range(rounds):
        for key in running if round_ % 2 == 0 else running[::-1]:
            result = measured[key]
            say(f"{name}, dt = 1/{rate}: {result.simulator.name}, round {round_ + 1}")
            gc.collect()
            motion = result.simulator.run(scene, 1 / rate, steps, every)
            result.times.append(motion.seconds / steps)
            if round_ == 0:
                result.stopped = motion.stopped
                _judge(result, judge.Boxes.of(scene), motion.frames, still)
        running = [key for key in running if _repeats(measured[key], steps)]
    load = results.load()
    blocks = int((~judge.Boxes.of(scene).fixed).sum())
    return Case(name, dimension, blocks, rate, measured, load)


def _judge(
    result: Measured, boxes: judge.Boxes, frames: NDArray[np.float64], still: NDArray[np.bool_]
) -> None:
    result.displacement = judge.displacement(frames, still, boxes.dimension)
    result.penetration = judge.penetration(boxes, frames)
    result.energy_rise = judge.energy_rise(boxes, frames)


def _repeats(result: Measured, steps: int) -> bool:
    taken = steps * sum(result.times)
    return not result.stopped and taken * (1 + 1 / len(result.times)) < REPEAT_WITHIN


def show(console: Console, case: Case) -> None:
    """All simulators on one scene."""
    where = "in space" if case.dimension == 3 else "in the plane"
    title = f"{case.scene}: {case.blocks} blocks {where}, {SECONDS} s at dt = 1/{case.rate}"
    table = Table(title=title, title_justify="left")
    table.add_column("simulator")
    for name in ("us a step", "/ full", "of least", "drift m", "penetration m", "energy rise J"):
        table.add_column(name, justify="right")
    for r in case.results.values():
        if not r.refused:
            measures = (r.displacement, r.penetration, r.energy_rise)
            table.add_row(
                r.simulator.name,
                f"{1e6 * r.median:.3g}",
                f"{case.ratio(r):.3g}",
                f"{case.ratio_of_least(r):.3g}",
                *("-" if math.isnan(value) else f"{value:.0e}" for value in measures),
            )
    console.print(table)
    for r in case.results.values():
        if r.refused or r.stopped:
            console.print(f"{r.simulator.name}: {r.refused or r.stopped}", highlight=False)


def _lines(cases: list[Case]) -> Iterator[dict[str, object]]:
    for case in cases:
        common = results.where(case.load) | {
            "scene": case.scene,
            "dimension": case.dimension,
            "blocks": case.blocks,
            "friction": f"{FRICTION:g}",
            "dt": f"1/{case.rate}",
            "steps": SECONDS * case.rate,
        }
        for r in case.results.values():
            yield common | {
                "simulator": r.simulator.name,
                "simulator_version": r.simulator.version(),
                "microseconds": results.number(1e6 * r.median, 4),
                "microseconds_least": results.number(1e6 * r.least, 4),
                "microseconds_most": results.number(1e6 * max(r.times, default=math.nan), 4),
                "rounds": len(r.times),
                "ratio_to_full": results.number(case.ratio(r), 4),
                "ratio_of_least": results.number(case.ratio_of_least(r), 4),
                "displacement": results.number(r.displacement, 3),
                "penetration": results.number(r.penetration, 3),
                "energy_rise": results.number(r.energy_rise, 3),
                "stopped": r.stopped,
                "refused": r.refused,
            }


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--quick", action="store_true", help=f"only {' and '.join(QUICK)}")
    parser.add_argument("--space", action="store_true", help="as boxes in space")
    parser.add_argument("--scenes", nargs="+", choices=STILL, metavar="SCENE")
    parser.add_argument(
        "--rates",
        nargs="+",
        type=int,
        choices=(240, 1000),
        default=[240],
        metavar="HZ",
        help="steps a second: 240 (the default), 1000",
    )
    parser.add_argument(
        "--simulators", nargs="+", choices=SIMULATORS, default=list(SIMULATORS), metavar="NAME"
    )
    results.add_output(parser)
    return parser.parse_args()


if __name__ == "__main__":
    main()
