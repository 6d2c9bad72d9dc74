"""Random structures, each with its reference answer where one is known without a solver.

A structure is a list of boxes before it becomes a scene, so that the same one can be written in
another unit of length, mass and time, turned with its gravity, moved, and listed in another order.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

import drystone as ds

Floats = NDArray[np.float64]
GRAVITY = 9.81


@dataclass(frozen=True, slots=True)
class Box:
    """A box: centre and size (2 or 3 numbers, m), density, and for one turned the angle (rad) about
    y (in the plane about z), by which x turns towards the last axis."""

    name: str
    center: tuple[float, ...]
    size: tuple[float, ...]
    density: float = 1.0
    fixed: bool = False
    angle: float = 0.0


@dataclass(frozen=True, slots=True)
class Structure:
    """Boxes under gravity, and what is right: True stands, False falls, None not known."""

    family: str
    boxes: tuple[Box, ...]
    friction: float
    gravity: tuple[float, ...]
    right: bool | None = None

    @property
    def dimension(self) -> int:
        return len(self.gravity)


@dataclass(frozen=True, slots=True)
class Seen:
    """How a structure is written down: units, turn, place, order."""

    length: float = 1.0
    mass: float = 1.0
    time: float = 1.0
    turn: Floats | None = None
    """A rotation matrix, 2 x 2 or 3 x 3."""
    offset: Floats | None = None
    """In the new unit of length."""
    order: NDArray[np.int64] | None = None


def scene_of(structure: Structure, seen: Seen) -> ds.Scene:
    """The structure as seen. Corners are computed in doubles, as any user's program does."""
    d = structure.dimension
    turn = np.eye(d) if seen.turn is None else seen.turn
    offset = np.zeros(d) if seen.offset is None else seen.offset
    gravity = turn @ np.array(structure.gravity) * seen.length / seen.time**2
    scene = ds.Scene(d, tuple(gravity), friction=structure.friction)
    order = range(len(structure.boxes)) if seen.order is None else seen.order
    for k in order:
        box = structure.boxes[k]
        corners = corners_of(box) @ turn.T * seen.length + offset
        options = {
            "name": box.name,
            "density": box.density * seen.mass / seen.length**d,
            "fixed": box.fixed,
        }
        if d == 2:
            scene.add_polygon([tuple(c) for c in corners], **options)
        else:
            scene.add_polyhedron([tuple(c) for c in corners], **options)
    return scene


def corners_of(box: Box) -> Floats:
    """(4, 2) counter-clockwise, or (8, 3)."""
    half = np.array(box.size) / 2
    if len(half) == 2:
        signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)
    else:
        signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    corners = signs * half
    if box.angle:
        c, s = math.cos(box.angle), math.sin(box.angle)
        x, z = corners[:, 0].copy(), corners[:, -1].copy()
        corners[:, 0], corners[:, -1] = c * x - s * z, s * x + c * z
    return corners + np.array(box.center)


def seen_at_random(rng: np.random.Generator, structure: Structure, far: bool) -> Seen:
    """Other units, a turn with gravity, a place up to 1e5 sizes away, another order."""
    d = structure.dimension
    length, mass, time = 10.0 ** rng.uniform(-3, 3, 3)
    if d == 2:
        a = rng.uniform(0, 2 * math.pi)
        turn = np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]])
    else:
        q, r = np.linalg.qr(rng.standard_normal((3, 3)))
        turn = q * np.sign(np.diag(r))
        turn[:, 0] *= np.linalg.det(turn)
    offset = rng.uniform(-1, 1, d) * length * (10.0 ** rng.uniform(0, 5) if far else 0.0)
    return Seen(length, mass, time, turn, offset, rng.permutation(len(structure.boxes)))


# ---------------------------------------------------------------------------------- the families


def _down(d: int) -> tuple[float, ...]:
    return (0.0, -GRAVITY) if d == 2 else (0.0, 0.0, -GRAVITY)


def _at(d: int, x: float, y: float, z: float) -> tuple[float, ...]:
    return (x, z) if d == 2 else (x, y, z)


def _ground(d: int) -> Box:
    return Box("ground", _at(d, 0, 0, -0.5), _at(d, 40, 40, 1), fixed=True)


def _density(rng: np.random.Generator, decades: float) -> float:
    return float(10.0 ** rng.uniform(0, decades))


def tower(
    rng: np.random.Generator, d: int, friction: float, decades: float, thin: float = 1.0
) -> Structure:
    """Boxes one on another, each on exactly one: it stands exactly if for every joint the centre of
    mass of all that is above lies within the joint. (Joints are level, so friction has no part.)"""
    boxes, z = [_ground(d)], Fraction(0)
    x, y = 0.0, 0.0
    count = int(rng.integers(2, 12))
    for k in range(count):
        size = [float(s) for s in rng.uniform(0.5, 1.5, 3)]
        if rng.random() < 0.3:
            size[2] *= thin
        if k:
            x += float(rng.uniform(-0.28, 0.28))
            y += float(rng.uniform(-0.28, 0.28)) if d == 3 else 0.0
        # Heights by exact sums, rounded once.
        centre = z + Fraction(size[2]) / 2
        boxes.append(
            Box(str(k), _at(d, x, y, float(centre)), _at(d, *size), _density(rng, decades))
        )
        z += Fraction(size[2])
    return Structure("", tuple(boxes), friction, _down(d), _tower_stands(boxes[1:], d))


def _tower_stands(boxes: list[Box], d: int) -> bool | None:
    """By exact arithmetic; None within 1e-7 of a joint's edge."""
    verdict = True
    for k in range(1, len(boxes)):
        for axis in range(d - 1):
            low = max(
                Fraction(b.center[axis]) - Fraction(b.size[axis]) / 2 for b in boxes[k - 1 : k + 1]
            )
            high = min(
                Fraction(b.center[axis]) + Fraction(b.size[axis]) / 2 for b in boxes[k - 1 : k + 1]
            )
            mass = [Fraction(b.density) * math.prod(map(Fraction, b.size)) for b in boxes[k:]]
            moment = sum(m * Fraction(b.center[axis]) for m, b in zip(mass, boxes[k:], strict=True))
            inside = min(moment / sum(mass) - low, high - moment / sum(mass))
            if abs(inside) < Fraction(1, 10**7):
                return None
            verdict &= inside > 0
    return verdict


def wall(rng: np.random.Generator, d: int, friction: float, decades: float) -> Structure:
    """A running-bond wall, some bricks missing, under a gravity that leans."""
    rows, columns = (int(n) for n in rng.integers(2, 6, 2))
    boxes = [_ground(d)]
    for row in range(rows):
        for k in range(columns):
            if rng.random() < 0.12:
                continue
            place = _at(d, k + 0.3 * (row % 2) - columns / 2, 0, row / 2 + 0.25)
            size = _at(d, 1, float(rng.uniform(0.5, 1)), 0.5)
            boxes.append(Box(f"{row}-{k}", place, size, _density(rng, decades)))
    lean = float(rng.choice([0, 0, 1])) * rng.uniform(0, 0.45) * GRAVITY
    gravity = (lean, -GRAVITY) if d == 2 else (lean, 0.3 * lean, -GRAVITY)
    return Structure("", tuple(boxes), friction, tuple(map(float, gravity)))


def pile(rng: np.random.Generator, d: int, friction: float, decades: float) -> Structure:
    """Boxes let down at random places until they touch: bridges, overhangs, corners over gaps."""
    boxes, tops = [_ground(d)], []
    for k in range(int(rng.integers(3, 14))):
        size = rng.uniform(0.4, 1.6, 3)
        x, y = rng.uniform(-1.5, 1.5), rng.uniform(-0.5, 0.5)
        z = 0.0
        for cx, cy, sx, sy, top in tops:
            if abs(cx - x) < (sx + size[0]) / 2 and (d == 2 or abs(cy - y) < (sy + size[1]) / 2):
                z = max(z, top)
        place = _at(d, float(x), float(y), float(z + size[2] / 2))
        boxes.append(Box(str(k), place, _at(d, *map(float, size)), _density(rng, decades)))
        tops.append((x, y, size[0], size[1], z + size[2]))
    return Structure("", tuple(boxes), friction, _down(d))


def squeezed(rng: np.random.Generator, d: int, friction: float, decades: float) -> Structure:
    """A light block between a fixed post and a heavy block that leans on it down a fixed ramp.
    Without friction the light one falls, whatever the masses."""
    angle = float(rng.uniform(0.3, 0.8))
    c, s = math.cos(angle), math.sin(angle)
    heavy = Box(
        "heavy", _at(d, 0, 0, 0), _at(d, 1, 1, 1), _density(rng, decades) * 10, angle=-angle
    )
    right = max(corners_of(heavy)[:, 0])
    low = corners_of(heavy)[np.argmax(corners_of(heavy)[:, 0])]
    width = float(rng.uniform(0.2, 0.5))
    light = Box("light", _at(d, right + width / 2, 0, float(low[-1])), _at(d, width, 1, 0.5), 1.0)
    post = Box("post", _at(d, right + width + 0.5, 0, 0), _at(d, 1, 2, 8), fixed=True)
    ramp_at = (-s * 1.0, -c * 1.0)  # one unit below the heavy block, square to its base
    ramp = Box(
        "ramp", _at(d, ramp_at[0], 0, ramp_at[1]), _at(d, 1.2, 2, 1), fixed=True, angle=-angle
    )
    return Structure("", (ramp, post, heavy, light), friction, _down(d), False)


Family = Callable[[np.random.Generator], Structure]


def families(d: int) -> Iterator[tuple[str, Family]]:
    """Name and maker of every family in a dimension."""
    for decades in (0, 4, 8, 10):
        for friction in (0.5, 0.8):
            yield f"tower 1e{decades} mu {friction}", _made(tower, d, friction, decades)
    # Turned joints are level but for rounding: 1e-16 of a load of 1e6 on a block of 1.
    for decades in (0, 4, 6):
        yield f"tower without friction 1e{decades}", _made(tower, d, 0.0, decades)
    for decades in (4, 10):
        yield f"tower with shims 1e{decades}", _made(tower, d, 0.5, decades, 1e-4)
    for decades in (0, 4, 8, 10):
        yield f"wall 1e{decades}", _made(wall, d, 0.6, decades)
        yield f"pile 1e{decades}", _made(pile, d, 0.5, decades)
    for decades in (0, 6):
        yield f"pile without friction 1e{decades}", _made(pile, d, 0.0, decades)
    yield "squeezed between smooth walls 1e10", _made(squeezed, d, 0.0, 9.0)


def _made(make: Callable[..., Structure], d: int, *more: float) -> Family:
    return lambda rng: make(rng, d, *more)


def named(structure: Structure, family: str) -> Structure:
    return replace(structure, family=family)
