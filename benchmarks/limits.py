"""Load factors: known ones, times beside HiGHS, random structures against programs and verdicts.

    .venv/bin/python benchmarks/limits.py [--random 300] [--highs]

Random structures: `limit` beside HiGHS's maximum and minimum of the factor on the same cones, which
must agree within 1e-7, and a bisection of `check` (for some of them: it takes 40 verdicts).
`--highs` times HiGHS on the known ones too: the wall of 30 x 30 takes half a minute.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from pathlib import Path

import numpy as np

import drystone as ds

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "python"))
from limit_programs import factors, push_of

G = 9.81
BISECTED = 10
"""Every so manieth random structure is bisected too."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--random", type=int, default=300)
    parser.add_argument("--highs", action="store_true")
    arguments = parser.parse_args()
    known(arguments.highs)
    return 1 if random_structures(arguments.random) else 0


def known(highs: bool) -> None:
    """Factors with a source, and times."""
    scenes = {
        "ten blocks": (ds.scenes.column(11, friction=2.0), 0.1),
        "arch of 20": (ds.scenes.arch(20, thickness=0.2, friction=0.7), 0.285646),
        "wall 10 x 10": (ds.scenes.wall(10, 10, friction=0.5), 0.495746),
        "wall 20 x 20": (ds.scenes.wall(20, 20, friction=0.5), None),
        "wall 30 x 30": (ds.scenes.wall(30, 30, friction=0.5), 0.386748),
    }
    for name, (scene, expected) in scenes.items():
        begun = time.perf_counter()
        lim = ds.limit(scene, gravity=(G, 0))
        took = time.perf_counter() - begun
        line = f"{name:14} {lim.factor:.9f} {took:8.3f} s  {lim.iterations} iterations"
        line += f"  bound - factor {lim.upper.bound - lim.factor:.0e}"
        if expected is not None:
            assert abs(lim.factor - expected) < 1e-6, (name, lim.factor)
        if highs:
            begun = time.perf_counter()
            _, most = factors(scene, push_of(scene, (G, 0)))
            line += f"  HiGHS {most:.9f} {time.perf_counter() - begun:8.3f} s"
            assert abs(most - lim.factor) < 1e-7, (name, most)
        print(line, flush=True)


def random_structures(count: int) -> int:
    """How many disagree."""
    wrong, worst, ends, none, infinite, unanswered = 0, 0.0, 0, 0, 0, 0
    for seed in range(count):
        random = np.random.default_rng(seed)
        mu = float(random.choice([0.0, 0.3, 0.6, 1.5]))
        scene = ds.scenes.random_stack(int(random.integers(3, 40)), seed=seed, friction=mu)
        space = seed % 3 == 2
        pull = (G * random.normal(), G * random.normal())
        cones, options = None, {}
        if space:
            scene = scene.extruded(1.0)
            pull = (pull[0], G * random.normal(), pull[1])
            cones, options = (6, "inscribed"), {"cone": "inscribed", "facets": 6}
        names = [body.name for body in scene.bodies if not body.fixed]
        for _ in range(int(random.integers(0, 3))):
            name = str(random.choice(names))
            weight = G * scene.body(name).mass
            scene.add_load(name, random.uniform(-0.3, 0.3, scene.dimension) * weight)
        lim = ds.limit(scene, gravity=pull, **options)
        least, most = factors(scene, push_of(scene, pull), cones)
        if math.isnan(least) != math.isnan(most):
            unanswered += 1
            continue
        if math.isnan(most) or lim.status != "solved":
            none += 1
            if not (math.isnan(most) and lim.status == "no_solution"):
                wrong += 1
                print(f"seed {seed}: {lim.status} {lim.bounds}, HiGHS {(least, most)}")
            continue
        for found, expected in zip(lim.bounds, (least, most), strict=True):
            if math.isinf(found) or math.isinf(expected):
                infinite += 1
                bad = found != expected
            else:
                ends += 1
                apart = abs(found - expected) / max(1.0, abs(expected))
                worst = max(worst, apart)
                bad = apart > 1e-7
            if bad:
                wrong += 1
                print(f"seed {seed}: {lim.status} {lim.bounds}, HiGHS {(least, most)}")
        if seed % BISECTED == 0 and math.isfinite(lim.factor) and lim.bounds[0] < 0 < lim.factor:
            apart = abs(bisected(scene, pull, options, lim.factor) - lim.factor)
            if apart > 1e-7 * max(1.0, lim.factor):
                wrong += 1
                print(f"seed {seed}: bisection is {apart:.1e} apart from {lim.factor}")
    print(
        f"{count} random structures: {ends} ends, worst {worst:.1e} apart; {infinite} infinite, "
        f"{none} stand for no factor, HiGHS gave no answer on {unanswered}; {wrong} disagree"
    )
    return wrong


def bisected(
    scene: ds.Scene, pull: tuple[float, ...], options: dict[str, object], guess: float
) -> float:
    """The factor at which verdicts change, by halving."""
    low, high = 0.0, 2.0 * guess
    for _ in range(40):
        middle = 0.5 * (low + high)
        loaded = scene.with_gravity(scene.gravity)
        for body in scene.bodies:
            force = middle * body.mass * np.asarray(pull)
            loaded.add_load(body.name, force, at=body.center_of_mass)
        if ds.check(loaded, **options).stable:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


if __name__ == "__main__":
    sys.exit(main())
