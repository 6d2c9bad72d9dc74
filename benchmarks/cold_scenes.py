"""The structures of cold.py: families of one kind each, in growing sizes."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import drystone as ds

GRAVITY = 9.81

Build = Callable[[], ds.Scene]


@dataclass(frozen=True, slots=True)
class Family:
    """Structures that differ in size only; an exponent is fitted to their times."""

    name: str
    sizes: dict[str, Build]
    """By the names of the scenes, the smallest first."""
    quick: int = 1
    """So many of the smallest are taken by `--quick`."""


def under_gravity(scene: ds.Scene, gravity: tuple[float, ...]) -> ds.Scene:
    """The same scene where things fall in another direction (m/s^2)."""
    content = json.loads(scene.to_json())
    content["gravity"] = list(gravity)
    return ds.Scene.from_json(json.dumps(content))


def wall(rows: int, k: float) -> ds.Scene:
    """A planar wall of as many rows as columns, under gravity (k g, -g)."""
    scene = ds.scenes.wall(rows, columns=rows, friction=0.5)
    return under_gravity(scene, (k * GRAVITY, -GRAVITY))


def leaning(rows: int, columns: int) -> ds.Scene:
    """A wall in space under gravity (g / 2, 0.1 m/s^2, -g): it leans along itself, a little out."""
    return under_gravity(ds.scenes.brick_wall(rows, columns), (0.5 * GRAVITY, 0.1, -GRAVITY))


def dome(rings: int, friction: float) -> ds.Scene:
    """Half a sphere of 5 m with a hole of 20 degrees in its crown, half a metre thick.

    Each ring has 4 `rings` segments.
    """
    inner, outer, oculus, segments = 4.5, 5.0, 20.0, 4 * rings
    scene = ds.Scene(dimension=3, friction=friction)
    scene.add_box((0, 0, -0.5), (14, 14, 1), name="ground", fixed=True)
    polar = [math.radians(90 + (oculus - 90) * ring / rings) for ring in range(rings + 1)]
    around = [2 * math.pi * k / segments for k in range(segments + 1)]
    for ring in range(rings):
        for k in range(segments):
            corners = [
                (r * math.sin(t) * math.cos(p), r * math.sin(t) * math.sin(p), r * math.cos(t))
                for r in (inner, outer)
                for t in polar[ring : ring + 2]
                for p in around[k : k + 2]
            ]
            scene.add_polyhedron(corners, name=f"{ring}-{k}", density=2000)
    return scene


def loose_brick(rows: int) -> ds.Scene:
    """A wall in space that stands, with one brick on its end that tips over."""
    scene = ds.Scene(dimension=3, friction=0.6)
    scene.add_box((rows / 2, 0, -0.5), (rows + 10, 4, 1), fixed=True, name="ground")
    for row in range(rows):
        for k in range(rows):
            center = (k + 0.3 * (row % 2), 0, 0.25 + 0.5 * row)
            scene.add_box(center, (1, 0.5, 0.5), name=f"{row}-{k}")
    scene.add_box((rows + 0.3, 0, 0.5 * rows + 0.25), (1.6, 0.5, 0.5), name="loose")
    return scene


def cubes(rows: int) -> ds.Scene:
    """A pyramid of cubes in one plane."""
    return ds.scenes.pyramid(rows, friction=0.6).extruded(1.0)


def _sizes(build: Callable[..., ds.Scene], *sizes: tuple[float, ...]) -> dict[str, Build]:
    """Named by the numbers that `build` is given."""
    return {" x ".join(f"{number:g}" for number in size): partial(build, *size) for size in sizes}


def _walls(k: float, *rows: int) -> dict[str, Build]:
    return {f"{n} at {k:g}": partial(wall, n, k) for n in rows}


def _domes(friction: float) -> dict[str, Build]:
    return {f"{n} rings": partial(dome, n, friction) for n in (4, 5, 6, 8)}


FAMILIES = (
    *(
        Family(f"wall, k = {k:g}", _walls(k, 10, 20, 30, 40), quick)
        for k, quick in ((0.0, 2), (0.1, 1), (0.2, 1), (0.38, 3))
    ),
    Family("wall that slides", _walls(0.6, 10) | _walls(0.5, 20, 30), 2),
    Family(
        "bricks in space",
        _sizes(ds.scenes.brick_wall, (10, 15), (20, 30), (40, 60), (70, 100)),
        2,
    ),
    Family("dome", _domes(0.7), 3),
    Family("dome that falls", _domes(0.15), 1),
    Family("pyramid of cubes", _sizes(cubes, (20,), (40,), (100,)), 1),
    Family(
        "random stack",
        _sizes(partial(ds.scenes.random_stack, friction=0.5), (84,), (300,), (1000,)),
        2,
    ),
    Family("arch", _sizes(partial(ds.scenes.arch, friction=0.5), (60,), (110,), (200,)), 3),
    Family("loose brick", _sizes(loose_brick, (6,), (8,), (12,), (24,), (36,)), 1),
    Family("leaning bricks", _sizes(leaning, (10, 10), (15, 15), (30, 30)), 1),
)
