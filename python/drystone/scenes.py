"""Built-in scenes: the paper's, and structures whose limits are known in closed form.

Lengths are in metres, angles in radians. The scenes of the paper's planner are frictionless by
default. The blocks are named by numbers from "1", the fixed ones by what they are.
"""

from __future__ import annotations

from typing import Any

from drystone import _core
from drystone.scene import Scene

__all__ = [
    "arch",
    "column",
    "diamond",
    "five_blocks",
    "harmonic_stack",
    "inverted_triangle",
    "pyramid",
    "random_stack",
    "slope",
    "wall",
]


def column(blocks: int = 10, friction: float = 0.0) -> Scene:
    """A column of unit squares, the lowest of them fixed.

    `blocks` counts the fixed one. From the paper's Table I (50 and 80 blocks).

    >>> len(column(50))
    50
    """
    return _built("column", blocks=blocks, friction=friction)


def pyramid(rows: int = 5, friction: float = 0.0) -> Scene:
    """Unit squares in rows of `rows`, `rows` - 1, ... 1, each across two below, on fixed ground.

    From the paper's Table I: 13 rows are 91 blocks. Every block meets its neighbours face to face,
    so the contact forces are not unique.
    """
    return _built("pyramid", rows=rows, friction=friction)


def random_stack(blocks: int = 20, seed: int = 1, friction: float = 0.0) -> Scene:
    """Blocks of mixed widths and heights, dropped one by one where they stand; like Fig. 7.

    There are overhangs, so the order of removal matters. The same `seed` gives the same stack.
    """
    return _built("random_stack", blocks=blocks, seed=seed, friction=friction)


def five_blocks(friction: float = 0.0) -> Scene:
    """The five-block structure of the paper's Fig. 5."""
    return _built("five_blocks", friction=friction)


def arch(voussoirs: int = 20, thickness: float = 0.2, friction: float = 0.5) -> Scene:
    """A semicircular arch of equal wedges, mean radius 1, on two fixed springings.

    With enough friction it stands if `thickness` is at least 0.1075 (Milankovitch, Heyman).
    """
    return _built("arch", voussoirs=voussoirs, thickness=thickness, friction=friction)


def harmonic_stack(blocks: int = 5, stretch: float = 1.0, friction: float = 0.0) -> Scene:
    """Unit-wide blocks leaning out over a table's edge by `stretch` times the harmonic overhang.

    n blocks reach H_n / 2 = (1 + 1/2 + ... + 1/n) / 2 and no further: they stand up to a
    `stretch` of 1 and fall beyond it.
    """
    return _built("harmonic_stack", blocks=blocks, stretch=stretch, friction=friction)


def diamond(size: int = 3, friction: float = 0.0) -> Scene:
    """Rows of 1, 2, ... `size`, ... 2, 1 bricks on a fixed base (Paterson and Zwick, *Overhang*).

    Without friction diamonds up to 4 stand and the one of 5 falls.
    """
    return _built("diamond", size=size, friction=friction)


def inverted_triangle(rows: int = 3, friction: float = 0.0) -> Scene:
    """Rows of 1, 2, ... `rows` bricks, the single one below; falls from 3 rows on."""
    return _built("inverted_triangle", rows=rows, friction=friction)


def slope(
    angle: float = 0.3, width: float = 1.0, height: float = 1.0, friction: float = 0.5
) -> Scene:
    """A block on a plane inclined by `angle` radians.

    It slides if tan(angle) > `friction`, and topples if tan(angle) > `width` / `height`.
    """
    return _built("slope", angle=angle, width=width, height=height, friction=friction)


def wall(courses: int = 8, length: int = 10, friction: float = 0.5) -> Scene:
    """A wall of bricks in running bond: `courses` rows of about `length` bricks each."""
    return _built("wall", courses=courses, length=length, friction=friction)


def _built(name: str, **parameters: Any) -> Scene:
    return Scene._of(_core.Scene.built_in(name, parameters))
