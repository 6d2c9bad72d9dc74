"""Heaps of boxes that tumble in the plane: drystone beside MuJoCo and Rapier.

    .venv/bin/pip install "mujoco<4"      # as far as wanted; Rapier needs cargo
    .venv/bin/python benchmarks/heaps_in_plane.py [--boxes N ...] [--friction MU ...]
        [--simulators NAME ...]

Boxes of .3 to .8 m, turned at random, fall at once from a grid half as high as wide: three seconds
at 240 steps a second, nobody sleeps. The others have their own settings and leave overlaps of
centimetres. Times are of the fastest of three runs, of one where it takes more than five seconds.
Results go to results/<machine>/<version>-<date>-heaps-in-plane.csv and to the screen.
"""

from __future__ import annotations

import threads  # noqa: F401  (before anything that loads NumPy)

# isort: split

import argparse
import math
from collections.abc import Iterator

import numpy as np

import drystone as ds
import fastest_run
import kept_table
import results
from kept_table import KeptTable
from simulators import Simulator
from simulators.drystone import Drystone
from simulators.mujoco import MuJoCo
from simulators.rapier import Rapier

SIMULATORS: dict[str, Simulator] = {
    "drystone": Drystone("full"),
    "rapier": Rapier(),
    "mujoco": MuJoCo(),
}
BOXES = (25, 50, 100, 200, 400, 800)
FRICTION = (0.3, 0.5, 0.8)
STEPS = 3 * fastest_run.RATE
"""Three seconds."""

SPACING = 1.15
"""Metres between the middles of boxes: none touches another, however it is turned."""

WIDE = 1.3
"""Boxes in a layer, beside the root of their number."""

SLOWEST = {"MuJoCo": 200}
"""Boxes from which on a simulator is left out: with more a step takes MuJoCo 10 ms and longer."""

COLUMNS = (*results.WHERE, *fastest_run.COLUMNS, *fastest_run.BESIDE)
"""Explained in benchmarks/README.md."""

SHOWN = {"blocks": "boxes", "friction": "friction", "simulator": "", **fastest_run.BESIDE}


def heap(boxes: int, friction: float, seed: int = 0) -> ds.Scene:
    """Boxes above a ground, that fall when the first step is made."""
    random = np.random.default_rng(seed)
    scene = ds.Scene(friction=friction)
    scene.add_box((0, -0.5), (120, 1), name="ground", fixed=True)
    wide = max(3, round(WIDE * math.sqrt(boxes)))
    for k in range(boxes):
        layer, i = divmod(k, wide)
        size, stray = random.uniform(0.3, 0.8, 2), random.uniform(-0.05, 0.05)
        place = (SPACING * (i - (wide - 1) / 2) + stray, 0.8 + SPACING * layer)
        scene.add_box(place, tuple(size), angle=random.uniform(-1.5, 1.5), name=f"b{k}")
    return scene


def measure(
    boxes: int,
    friction: float,
    simulators: list[Simulator],
    steps: int = STEPS,
) -> Iterator[dict[str, object]]:
    """A line for each simulator, drystone first."""
    scene = heap(boxes, friction)
    common = fastest_run.common(f"heap of {boxes}", boxes, friction, steps)
    timed = [s for s in simulators if boxes <= SLOWEST.get(s.name, boxes)]
    yield from fastest_run.beside(common, scene, steps, timed)


def exponent(lines: list[dict[str, object]], friction: float, name: str) -> float:
    """Of the number of boxes, in a simulator's time of a step at one friction: least squares."""
    own = [x for x in lines if (x["friction"], x["simulator"]) == (f"{friction:g}", name)]
    boxes, times = ([float(str(x[c])) for x in own] for c in ("blocks", "microseconds"))
    if len(own) < 2:
        return math.nan
    return float(np.polyfit(np.log(boxes), np.log(times), 1)[0])


def main() -> None:
    """Measure what the arguments say."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--boxes", nargs="+", type=int, default=list(BOXES))
    parser.add_argument("--friction", nargs="+", type=float, default=list(FRICTION))
    parser.add_argument("--simulators", nargs="+", choices=SIMULATORS, default=list(SIMULATORS))
    results.add_output(parser)
    arguments = parser.parse_args()
    chosen = [SIMULATORS[name] for name in SIMULATORS if name in arguments.simulators]
    ready = kept_table.ready(chosen)
    table = KeptTable(arguments.output, "heaps-in-plane", COLUMNS, SHOWN)
    for friction in arguments.friction:
        for boxes in arguments.boxes:
            table.add(measure(boxes, friction, ready))
    notes = []
    for friction in arguments.friction:
        grown = ", ".join(f"{s.name} {exponent(table.lines, friction, s.name):.2f}" for s in ready)
        notes.append(f"exponent of the number of boxes, friction {friction:g}: {grown}")
    table.show(chosen, notes)


if __name__ == "__main__":
    main()
