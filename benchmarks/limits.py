"""Load factors: known and published ones, times beside HiGHS, random structures against programs
and verdicts, and verdicts under gravity in random directions against programs.

    .venv/bin/python benchmarks/limits.py [--random 300] [--directions 500] [--cases 1000] [--highs]

Random structures: `limit` beside HiGHS's maximum and minimum of the factor on the same cones, which
must agree within 1e-7, and a bisection of `check` (for some of them: it takes 40 verdicts).
Directions: so many on each of 20 structures in the plane, `check` beside the phase one of HiGHS on
the same cones. A direction within 1e-7 of where the verdict changes may come out either way.
Cases: so many combinations of two, four and six loads on a wall of 30 x 30 at once, and some of
them by `check`.
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
from contact_laws import cut_stone
from limit_programs import Standing, case_of, factors, push_of
from published_walls import PUBLISHED, published_wall

G = 9.81
BISECTED = 10
"""Every so manieth random structure is bisected too, unless `--bisect` says otherwise."""

STRUCTURES = 20
CHECKED = 50
"""Load cases that are put to `check` as well."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--random", type=int, default=300)
    parser.add_argument("--bisect", type=int, default=BISECTED, metavar="EVERY")
    parser.add_argument("--directions", type=int, default=500)
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--highs", action="store_true")
    arguments = parser.parse_args()
    known(arguments.highs)
    published()
    wrong = random_structures(arguments.random, arguments.bisect)
    wrong += directions(arguments.directions)
    wrong += load_cases(arguments.cases)
    return 1 if wrong else 0


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


def published() -> None:
    """The six walls of Ferris and Tin-Loi (2001), with the associated flow rule."""
    for wall in range(1, 7):
        scene = published_wall(wall)
        lim = ds.limit(scene, gravity=(G, 0))
        _, most = factors(scene, push_of(scene, (G, 0)))
        assert abs(most - lim.factor) < 1e-7, (wall, most)
        told = f"published {PUBLISHED[wall]:.2f}" if wall in PUBLISHED else ""
        print(f"wall {wall} of Ferris and Tin-Loi: {len(scene.bodies) - 1:3} blocks ", end="")
        print(f"{lim.factor:.6f}, HiGHS {most:.6f} {told}", flush=True)


def directions(count: int) -> int:
    """How many verdicts under turned gravity disagree."""
    scenes = [cut_stone(seed) for seed in range(8)]
    scenes += [ds.scenes.random_stack(4 + 3 * k, seed=k, friction=0.3 + 0.1 * k) for k in range(6)]
    scenes += [ds.scenes.arch(n, thickness=0.3, friction=0.7) for n in (5, 9)]
    scenes += [ds.scenes.wall(4, 3, friction=mu) for mu in (0.4, 0.8)]
    scenes += [ds.scenes.pyramid(4, friction=0.6), ds.scenes.column(5, friction=1.5)]
    assert len(scenes) == STRUCTURES
    wrong = stand = close = 0
    for index, scene in enumerate(scenes):
        random = np.random.default_rng(index)
        program = Standing(scene)
        # Half of them all around, half where the verdicts change.
        around = random.uniform(0, 2 * math.pi, count)
        around[::2] = -0.5 * math.pi + random.normal(0.0, 0.4, len(around[::2]))
        for angle in around:
            ours, theirs = verdict(scene, program, angle)
            stand += ours
            if ours != theirs:
                beside = [verdict(scene, program, angle + step) for step in (-1e-7, 1e-7)]
                near = beside[0] != beside[1] and all(a == b for a, b in beside)
                close += near
                wrong += not near
                print(f"structure {index}, {angle!r}: {ours}, HiGHS {theirs}, near {near}")
    print(
        f"{count} directions on each of {STRUCTURES} structures: {stand} stand; "
        f"{close} too near to tell, {wrong} disagree"
    )
    return wrong


def load_cases(count: int) -> int:
    """Wrong ones among load cases of a wall of 30 x 30: an earthquake, a lift, wind from the left,
    snow, a column on the middle of the wall and a pull at its corner."""
    scene = ds.scenes.wall(30, 30, friction=0.5)
    ds.check(scene)  # contacts are found
    bodies = [body for body in scene.bodies if not body.fixed]
    place = np.array([body.center_of_mass for body in bodies])
    weight = G * bodies[len(bodies) // 2].mass
    top = place[:, 1] > place[:, 1].max() - 0.1
    rightmost_first = np.argsort(-place[:, 0])
    leftmost = {round(place[k, 1], 3): bodies[k].name for k in rightmost_first}
    middle = int(np.argmin(np.abs(place[:, 0] - place[:, 0].mean()) + 1e3 * ~top))
    corner = int(np.argmax(place[:, 0] + 1e3 * top))
    loads = [
        (G, 0.0),
        (0.0, -G),
        dict.fromkeys(leftmost.values(), (weight, 0.0)),
        {body.name: (0.0, -weight) for body, above in zip(bodies, top, strict=True) if above},
        {bodies[middle].name: (0.0, -30 * weight)},
        {bodies[corner].name: (-3 * weight, 0.0)},
    ]
    random = np.random.default_rng(1)
    low, high = (-0.6, -0.5, -1.0, 0.0, 0.0, 0.0), (0.6, 0.5, 1.0, 2.0, 1.0, 1.0)
    factors = random.uniform(low, high, (count, len(loads)))
    wrong = 0
    for some in (2, 4, 6):
        begun = time.perf_counter()
        cases = ds.load_cases(scene, loads[:some], factors[:, :some])
        took = time.perf_counter() - begun
        looked_at = random.choice(count, min(count, CHECKED), replace=False)
        for case in looked_at:
            loaded = case_of(scene, loads[:some], factors[case, :some])
            wrong += bool(cases.stands[case]) != ds.check(loaded).stable
        print(f"{some} loads: {took:.2f} s. {cases} {len(looked_at)} checked, {wrong} wrong")
    return wrong


def verdict(scene: ds.Scene, program: Standing, angle: float) -> tuple[bool, bool]:
    """Whether it stands under gravity in a direction: ours, and by HiGHS."""
    gravity = (G * math.cos(angle), G * math.sin(angle))
    return ds.check(scene.with_gravity(gravity)).stable, program.stands(gravity)


def random_structures(count: int, every: int) -> int:
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
        if seed % every == 0 and math.isfinite(lim.factor) and lim.bounds[0] < 0 < lim.factor:
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
