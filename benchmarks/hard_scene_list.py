"""Scenes that are hard for simulators, rebuilt from the samples of Box2D, solver2d and Box3D.

Dimensions, densities, coefficients of friction and gravity are those of erincatto/solver2d (commit
d178a56, `samples/collection/sample_contact.cpp` and `sample_far.cpp`) and, for the large pyramid,
erincatto/box3d (commit 30c67b5, `shared/benchmarks.c`), both under the MIT licence. Where these
have a line for the ground there is a box here.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import drystone as ds

GRAVITY = (0.0, -10.0)

Point = tuple[float, float]

# Inner and outer corners of half the arch, of a quarter of this size (m).
_INNER = (
    (16.0, 0.0),
    (14.93803712795643, 5.133601056842984),
    (13.79871746027416, 10.24928069555078),
    (12.56252963284711, 15.34107019122473),
    (11.20040987372525, 20.39856541571217),
    (9.66521217819836, 25.40369899225096),
    (7.87179930638133, 30.3179337000085),
    (5.635199558196225, 35.03820717801641),
    (2.405937953536585, 39.09554102558315),
)
_OUTER = (
    (24.0, 0.0),
    (22.33619528222415, 6.02299846205841),
    (20.54936888969905, 12.00964361211476),
    (18.60854610798073, 17.9470321677465),
    (16.46769273811807, 23.81367936585418),
    (14.05325025774858, 29.57079353071012),
    (11.23551045834022, 35.13775818285372),
    (7.752568160730571, 40.30450679009583),
    (3.016931552701656, 44.28891593799322),
)


@dataclass(frozen=True, slots=True)
class HardScene:
    """A scene, and where its bodies should be at the end."""

    scene: ds.Scene
    heights: dict[str, float] = field(default_factory=dict)
    """Metres, of centres of bodies that should come to rest elsewhere than where they begin."""
    falls: bool = False
    """Whether all bodies should fall; else all should stand."""
    seconds: float = 5.0
    velocities: dict[str, tuple[float, float, float]] = field(default_factory=dict)


def _on_ground(friction: float, origin: Point = (0.0, 0.0)) -> ds.Scene:
    scene = ds.Scene(gravity=GRAVITY, friction=friction)
    scene.add_box((origin[0], origin[1] - 1), (200, 2), name="ground", fixed=True)
    return scene


def _pyramid(base: int, spacing: float, origin: Point = (0.0, 0.0)) -> Iterator[Point]:
    """Centres of boxes, row by row, of a pyramid whose neighbours are `spacing` metres apart."""
    for row in range(base):
        for k in range(base - row):
            yield origin[0] + (k + row / 2) * spacing, origin[1] + row * spacing


def high_mass_ratio_1() -> HardScene:
    """Three pyramids of ten rows; a box 100, 200, 300 times as heavy falls 2 m on each."""
    scene, heights = _on_ground(0.5), {}
    for j in range(3):
        for place in _pyramid(10, 2.0, (-30 + 22 * j, 1)):
            top = place[1] > 18
            above = (place[0], place[1] + 2 * top)
            name = scene.add_box(above, (2, 2), density=100.0 * (j + 1) if top else 1.0)
            heights[name] = place[1]
    return HardScene(scene, heights)


def high_mass_ratio_2() -> HardScene:
    """A box 400 times as heavy falls 15 m on two small ones, far apart."""
    scene = _on_ground(0.6)
    for x in (-9, 9):
        scene.add_box((x, 0.5), (1, 1))
    return HardScene(scene, {scene.add_box((0, 26), (20, 20)): 11.0})


def arch() -> HardScene:
    """An arch of 17 blocks with four slabs on its keystone."""
    scene = _on_ground(0.6)
    inner, outer = ([(x / 4, y / 4) for x, y in corners] for corners in (_INNER, _OUTER))
    for side in (1, -1):
        for k in range(8):
            corners = [inner[k], outer[k], outer[k + 1], inner[k + 1]]
            scene.add_polygon([(side * x, y) for x, y in corners][::side])
    (x, y), (u, v) = inner[8], outer[8]
    scene.add_polygon([(x, y), (u, v), (-u, v), (-x, y)])
    for k in range(4):
        scene.add_box((0, v + 0.5 + k), (4, 1))
    return HardScene(scene)


def card_house(storeys: int) -> HardScene:
    """Cards of 2 mm by 40 cm that lean on one another by 25 degrees. They are drawn with overlaps
    and gaps of millimetres."""
    scene = _on_ground(0.7)
    card, lean = (0.002, 0.4), math.radians(25)
    for storey in range(storeys):
        y = 0.18 + 0.37 * storey
        for k in range(storeys - storey):
            x = 0.175 * storey + 0.35 * k
            if k < storeys - storey - 1:
                scene.add_box((x + 0.25, y + 0.185), card, angle=math.pi / 2)
            scene.add_box((x, y), card, angle=-lean)
            scene.add_box((x + 0.175, y), card, angle=lean)
    return HardScene(scene)


def double_domino() -> HardScene:
    """Fifteen dominoes; the first gets an impulse of .2 N s at its top."""
    scene, width, impulse = _on_ground(0.6), 0.25, 0.2
    names = [scene.add_box((-7.5 + k, 0.5), (width, 1)) for k in range(15)]
    inertia = width * (width**2 + 1) / 12
    first = (impulse / width, 0.0, -0.5 * impulse / inertia)
    return HardScene(scene, falls=True, seconds=10.0, velocities={names[0]: first})


def overlap_recovery(origin: Point = (0.0, 0.0)) -> HardScene:
    """A pyramid of four rows, each box a quarter of itself in its neighbours."""
    scene = _on_ground(0.6, origin)
    for place in _pyramid(4, 0.75, (origin[0] - 1.5, origin[1] + 0.5)):
        scene.add_box(place, (1, 1))
    return HardScene(scene)


def far_pyramid() -> HardScene:
    """A pyramid of ten rows 128 km from the origin, a quarter of a box between all boxes."""
    origin = (1e5, -8e4)
    scene, heights = _on_ground(0.6, origin), {}
    for place in _pyramid(10, 1.25, (origin[0] - 4.375, origin[1] + 1.125)):
        row = round((place[1] - origin[1] - 1.125) / 1.25)
        heights[scene.add_box(place, (1, 1))] = origin[1] + 0.5 + row
    return HardScene(scene, heights)


def large_pyramid() -> HardScene:
    """5,050 boxes in a hundred rows."""
    scene = _on_ground(0.6)
    for place in _pyramid(100, 1.0, (-49.5, 0.5)):
        scene.add_box(place, (1, 1), density=100.0)
    return HardScene(scene, seconds=0.5)


SCENES: dict[str, Callable[[], HardScene]] = {
    "high mass ratio 1": high_mass_ratio_1,
    "high mass ratio 2, 3": high_mass_ratio_2,
    "arch": arch,
    "card house, 5": lambda: card_house(5),
    "card house, 10": lambda: card_house(10),
    "double domino": double_domino,
    "overlap recovery": overlap_recovery,
    "overlap recovery, far": lambda: overlap_recovery((8e4, -7e4)),
    "pyramid, far": far_pyramid,
    "large pyramid": large_pyramid,
}
"""By name. High mass ratios 2 and 3 differ in the ground's thickness alone."""
