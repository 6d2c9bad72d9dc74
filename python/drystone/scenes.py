"""Built-in scenes: the paper's, and structures whose limits are known in closed form.

All stand under gravity (0, -9.81) m/s^2, or (0, 0, -9.81) in space, with density 1 kg/m^2
(kg/m^3). Movable blocks are named by numbers from "1", fixed ones by what they are ("ground",
"table", "plane"). The paper's planning scenes are frictionless by default.
"""

from __future__ import annotations

from typing import Any

from drystone import _core
from drystone.common.numbers import number
from drystone.scene import Scene

__all__ = [
    "arch",
    "brick_wall",
    "col20",
    "col50",
    "column",
    "diamond",
    "drop84",
    "fall7",
    "falling_column",
    "five_blocks",
    "harmonic_stack",
    "inverted_triangle",
    "pyr13",
    "pyramid",
    "random_stack",
    "slope",
    "square_pyramid",
    "three_segments",
    "wall",
    "wall84",
]


def column(n: int = 50, friction: float = 0.0) -> Scene:
    """Unit squares on top of each other, the lowest of them fixed.

    `n` counts the fixed one. From the paper's Table I (50 and 80 blocks).

    >>> len(column(50))
    50
    """
    return _built("column", n=n, friction=friction)


def pyramid(rows: int = 13, friction: float = 0.0) -> Scene:
    """Rows of unit squares in full face contact, each on two of the row below.

    From the paper's Table I: 13 rows are 91 blocks, on fixed ground. Neighbours in a row touch
    side by side, and the contact forces are not unique.

    >>> len(pyramid(13))
    92
    """
    return _built("pyramid", rows=rows, friction=friction)


def random_stack(blocks: int = 84, seed: int = 1, friction: float = 0.0) -> Scene:
    """Blocks of mixed widths and heights with overhangs, like Fig. 7: the order matters.

    The same `seed` always gives the same stack.
    """
    return _built("random_stack", blocks=blocks, seed=seed, friction=friction)


def five_blocks(friction: float = 0.0) -> Scene:
    """Five blocks in which the order of removal matters, after Fig. 5.

    Blocks 1 and 2 carry the plank 3, and that the load 4 and the counterweight 5: {1, 3, 5}
    stands, {1, 3} and {1, 3, 4, 5} fall.
    """
    return _built("five_blocks", friction=friction)


def arch(voussoirs: int = 20, thickness: float = 0.2, friction: float = 0.7) -> Scene:
    """A semicircular arch of mean radius 1 m with radial joints, on fixed ground.

    Given enough friction it stands only if `thickness` (metres) is at least 0.1075
    (Milankovitch, Heyman).
    """
    return _built("arch", voussoirs=voussoirs, thickness=thickness, friction=friction)


def harmonic_stack(n: int = 10, overhang_factor: float = 1.0, friction: float = 0.0) -> Scene:
    """Blocks of length 1 m reaching over a table's edge, at the limit for factor 1.

    `n` blocks reach H_n / 2 = (1 + 1/2 + ... + 1/n) / 2 metres over the edge and no further;
    these reach `overhang_factor` times as far.
    """
    return _built("harmonic_stack", n=n, overhang_factor=overhang_factor, friction=friction)


def diamond(m: int = 4, friction: float = 0.0) -> Scene:
    """Rows of 1, 2, ..., m, ..., 2, 1 blocks: stands without friction for m <= 4.

    The m-diamonds of Paterson and Zwick, *Overhang*; the lowest block is wholly on the table.
    """
    return _built("diamond", m=m, friction=friction)


def inverted_triangle(rows: int = 3, friction: float = 0.0) -> Scene:
    """Rows of 1, 2, ... blocks from the bottom: falls without friction from 3 rows on."""
    return _built("inverted_triangle", rows=rows, friction=friction)


def slope(
    angle_degrees: float = 20.0,
    friction: float = 0.5,
    width: float = 1.0,
    height: float = 1.0,
) -> Scene:
    """A block on an inclined plane, which rises to the right.

    It slides if tan(angle) > `friction`, and topples if tan(angle) > `width` / `height`.
    """
    return _built(
        "slope", angle_degrees=angle_degrees, friction=friction, width=width, height=height
    )


def wall(rows: int = 10, columns: int = 10, seed: int = 0, friction: float = 0.6) -> Scene:
    """A brick wall in running bond.

    `columns` is its length in bricks of 1 m by 0.5 m. A `seed` other than 0 draws the joints'
    places at random.
    """
    return _built("wall", rows=rows, columns=columns, seed=seed, friction=friction)


def brick_wall(rows: int = 5, columns: int = 5, friction: float = 0.6) -> Scene:
    """A wall in space: bricks of 1 m by 0.5 m by 0.5 m in running bond, half ones at the ends."""
    return _built("brick_wall", rows=rows, columns=columns, friction=friction)


def square_pyramid(layers: int = 7, friction: float = 0.0) -> Scene:
    """Square layers of unit cubes in space, each cube on four of the layer below.

    >>> len(square_pyramid(7))
    141
    """
    return _built("square_pyramid", layers=layers, friction=friction)


def falling_column(friction: float = 0.2) -> Scene:
    """Seven blocks of which the upper two fall one after the other, after Fig. 1.

    A tall block leans over and comes to lie on the end of a plank; then the plank tips with it.
    The five blocks below stand still all the time.
    """
    return _built("falling_column", friction=friction)


def three_segments(friction: float = 0.3) -> Scene:
    """Seven slabs like dominoes: two move, then five, then all, after Fig. 4."""
    return _built("three_segments", friction=friction)


def col20(friction: float = 0.5) -> Scene:
    """A column of 20 unit squares on the ground, to be simulated."""
    return _built("col20", friction=friction)


def col50(friction: float = 0.5) -> Scene:
    """A column of 50 unit squares on the ground, to be simulated."""
    return _built("col50", friction=friction)


def pyr13(friction: float = 0.5) -> Scene:
    """The pyramid of 13 rows with friction, to be simulated."""
    return _built("pyr13", friction=friction)


def fall7(friction: float = 0.5) -> Scene:
    """Five blocks that stand still while two squares topple off them, to be simulated."""
    return _built("fall7", friction=friction)


def wall84(seed: int = 1, friction: float = 0.5) -> Scene:
    """A wall of 12 courses of 7 bricks of random widths, to be simulated."""
    return _built("wall84", seed=seed, friction=friction)


def drop84(seed: int = 1, friction: float = 0.5) -> Scene:
    """84 random boxes dropped on the ground, to be simulated."""
    return _built("drop84", seed=seed, friction=friction)


def _built(name: str, **parameters: Any) -> Scene:
    for key, value in parameters.items():
        number(value, f"{name}: {key}")
    # NumPy's numbers become Python's own: the core takes what JSON knows.
    plain = {key: getattr(value, "item", lambda v=value: v)() for key, value in parameters.items()}
    return Scene._of(_core.Scene.built_in(name, plain))
