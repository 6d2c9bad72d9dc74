"""Hard scenes of Box2D, solver2d and Box3D: does it stand, here, in MuJoCo and in Rapier?

    .venv/bin/pip install "mujoco<4"      # as far as wanted; Rapier needs cargo
    .venv/bin/python benchmarks/hard_scenes.py [--scenes SCENE ...] [--simulators NAME ...]

`hard_scene_list.py` says what they are and where they are from. 240 steps a second, for five
seconds, dominoes for ten and the large pyramid for half a second. drystone takes overlaps back
before it begins (`Scene.parted`); the others do so on their way.

A body has fallen if its centre is lower than where it should be by more than a quarter of its
longest side, or if it has turned by more than 45 degrees. *Drift* is how far a body went in the
last quarter of the time, metres; *overlap* the deepest in the second half. Times are of the
fastest of three runs. Results go to results/<machine>/<version>-<date>-hard-scenes.csv and to the
screen.
"""

from __future__ import annotations

import threads  # noqa: F401  (before anything that loads NumPy)

# isort: split

import argparse
import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

import drystone as ds
import fastest_run
import kept_table
import results
from hard_scene_list import SCENES, HardScene
from kept_table import KeptTable
from simulators import Simulator
from simulators.drystone import Drystone
from simulators.mujoco import MuJoCo
from simulators.rapier import Rapier

SIMULATORS: dict[str, Simulator] = {
    "drystone": Drystone("full"),
    "mujoco": MuJoCo(cone="elliptic"),
    "rapier": Rapier(),
}
LOOKS = 20
"""Times that places are looked at."""

FALLEN = 0.25
"""Of the longest side."""

TURNED = math.pi / 4

LEFT_OUT = {("large pyramid", "MuJoCo"): "left out: more than two seconds a step"}

COLUMNS = (
    *results.WHERE,
    *fastest_run.COLUMNS,
    "should",
    "fallen",
    "drift",
    "penetration",
    *fastest_run.TIMES,
    "stopped",
)
"""Explained in benchmarks/README.md."""

SHOWN = {
    "scene": "scene",
    "simulator": "",
    "fallen": "fallen",
    "drift": "drift, m",
    "penetration": "overlap, m",
    **fastest_run.TIMES,
}

Floats = NDArray[np.float64]


def main() -> None:
    """Measure what the arguments say."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--simulators", nargs="+", choices=SIMULATORS, default=list(SIMULATORS))
    results.add_output(parser)
    arguments = parser.parse_args()
    chosen = [SIMULATORS[name] for name in arguments.simulators]
    ready = kept_table.ready(chosen)
    table = KeptTable(arguments.output, "hard-scenes", COLUMNS, SHOWN)
    for name in arguments.scenes:
        table.add(measure(name, ready))
    table.show(chosen)


def measure(name: str, simulators: list[Simulator]) -> Iterator[dict[str, object]]:
    """A line for each simulator."""
    hard = SCENES[name]()
    steps = round(hard.seconds * fastest_run.RATE)
    blocks = sum(not body.fixed for body in hard.scene.bodies)
    common = fastest_run.common(name, blocks, hard.scene.friction, steps)
    common["should"] = "fall" if hard.falls else "stand"
    for simulator in simulators:
        ours = isinstance(simulator, Drystone)
        why = LEFT_OUT.get((name, simulator.name), "")
        if why:
            blank = dict.fromkeys(COLUMNS, "")
            yield blank | common | {"simulator": simulator.name, "stopped": why}
            continue
        scene = hard.scene.parted() if ours else hard.scene
        every = steps // LOOKS
        motion = fastest_run.fastest_run(simulator, scene, steps, every, hard.velocities)
        frames = motion.frames
        late = frames[-1 - LOOKS // 4 :, :, :2]
        measured = {
            "fallen": fallen(hard, frames[-1]),
            "drift": results.number(float(np.linalg.norm(late - late[0], axis=-1).max()), 2),
            "penetration": results.number(deepest(hard.scene, frames[len(frames) // 2 :]), 2),
            "stopped": motion.stopped,
        }
        yield common | fastest_run.times(simulator, motion, steps) | measured


def fallen(hard: HardScene, frame: Floats) -> int:
    """Bodies that are lower than they should be, or turned."""
    count = 0
    for body, place in zip(hard.scene.bodies, frame, strict=True):
        height = hard.heights.get(body.name, body.center_of_mass[1])
        longest = np.linalg.norm(np.diff(body.vertices, axis=0), axis=1).max()
        upright = place[1] > height - FALLEN * longest and abs(place[2] - body.angle) < TURNED
        count += not (body.fixed or upright)
    return count


def deepest(scene: ds.Scene, frames: Floats) -> float:
    """The deepest overlap, metres: zero where none is deeper than the contact tolerance."""
    depth = 0.0
    for frame in frames:
        now = ds.Scene(gravity=scene.gravity, friction=scene.friction)
        # From the middle, so that overlaps far from the origin are seen too.
        middle = frame[0, :2]
        for body, place in zip(scene.bodies, frame, strict=True):
            turn = place[2] - body.angle
            cos, sin = math.cos(turn), math.sin(turn)
            arms = (body.vertices - body.center_of_mass) @ np.array([[cos, sin], [-sin, cos]])
            now.add_polygon(arms + (place[:2] - middle), name=body.name, fixed=body.fixed)
        depth = max([depth, *(overlap.depth for overlap in now.overlaps)])
    return depth


if __name__ == "__main__":
    main()
