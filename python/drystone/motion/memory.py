"""How much memory a run will take, said before it does."""

from __future__ import annotations

import warnings

from drystone.common.text import ordinal
from drystone.common.units import quantity

NUMBERS = {2: 3 + 3, 3: 7 + 6}
"""Of a body's place and velocity, by dimension; eight bytes each."""
STEP = 400
"""Bytes of what is known of a step, measured, beside two of each body."""

MUCH = 1e9
"""Bytes that are worth a word."""
FEW = 1e8
"""Bytes of places and velocities with as many steps left out as is proposed."""


def warn_of_much_memory(steps: int, every: int, bodies: int, dimension: int, forces: bool) -> None:
    """A UserWarning where a run of so many steps would take more than `MUCH`."""
    of_all = 8.0 * NUMBERS[dimension] * bodies * steps
    size = of_all / every + (STEP + 2.0 * bodies) * steps
    if size <= MUCH:
        return
    what = " and the forces" if forces else ""
    text = f"a run of {steps} steps takes {quantity(size, 'B', 2)} of memory{what}"
    less = _round_up(of_all / FEW)
    if less > every:
        text += f": every={less} keeps the bodies{what} of every {ordinal(less)} step only"
    warnings.warn(text, stacklevel=3)


def _round_up(number: float) -> int:
    """To 1, 2 or 5 times a power of ten."""
    power = 1
    while 10 * power < number:
        power *= 10
    return next(k * power for k in (1, 2, 5, 10) if k * power >= number)
