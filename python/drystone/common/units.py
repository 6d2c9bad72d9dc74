"""Quantities for people: a few digits, and a unit whose number is neither huge nor tiny."""

from __future__ import annotations

import math
from collections.abc import Iterable

PREFIXES = {-3: "n", -2: "µ", -1: "m", 0: "", 1: "k", 2: "M", 3: "G", 4: "T"}
"""By powers of a thousand."""

WITHOUT_KILO = ("s", "m")
"""Units that nobody says kilo of here: 1200 s, 1200 m."""


def scale_of(values: Iterable[float], unit: str) -> tuple[float, str]:
    """The unit in which the largest of some values has one to three digits before the point, and
    its size in SI: (1000.0, "kN").

    >>> scale_of([12.0, 81_500.0], "N"), scale_of([0.0], "N")
    ((1000.0, 'kN'), (1.0, 'N'))
    """
    largest = max((abs(value) for value in values if math.isfinite(value)), default=0.0)
    if largest == 0.0:
        return 1.0, unit
    # Four digits: 999.96 is 1000 as it will be written.
    power = math.floor(math.log10(float(f"{largest:.4g}")) / 3 + 1e-12)
    power = min(max(power, min(PREFIXES)), 0 if unit in WITHOUT_KILO else max(PREFIXES))
    return 1000.0**power, PREFIXES[power] + unit


def quantity(value: float, unit: str, digits: int = 3) -> str:
    """A value in words.

    >>> quantity(0.00213, "s"), quantity(81_500, "N"), quantity(0.0, "m"), quantity(4000, "s")
    ('2.13 ms', '81.5 kN', '0 m', '4000 s')
    """
    size, name = scale_of([value], unit)
    shown = value / size + 0.0  # no minus zero
    return f"{shown:.0f} {name}" if abs(shown) >= 10**digits else f"{shown:.{digits}g} {name}"


def round_number(value: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above `value`.

    >>> round_number(0.37), round_number(5.0)
    (0.2, 5.0)
    """
    power = 10.0 ** math.floor(math.log10(value))
    step = max(factor for factor in (1.0, 2.0, 5.0) if factor * power <= value * (1 + 1e-9))
    return step * power
