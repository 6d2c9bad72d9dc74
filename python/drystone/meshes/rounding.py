"""How exact the numbers of a mesh are, read off the numbers themselves, and what that explains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drystone.meshes.errors import MeshError
from drystone.meshes.flatten import flattened, is_nearly_flat

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from drystone.meshes.surface import Surface

MOST_DIGITS = 12
"""Numbers that need more digits than this below the first of the largest were not rounded."""

SINGLE_PRECISION = 2.0**-23
"""Two numbers of single precision next to each other differ by no more than this share of them."""

PLACES = 2.0
"""Vertices are taken as exact to so many last places. Rounding moves one by up to sqrt(3) / 2, and
planes fitted to rounded vertices are off by about as much."""

UNEVEN = 0.25
"""Faces that are plane within this share of what counts as flat do no harm: none is made plane."""

COARSEST = 2e-2
"""Numbers that are less exact than this share of the diagonal are not taken as rounded: they more
likely are round because they were chosen so."""


@dataclass(frozen=True, slots=True)
class Exactness:
    """How far vertices may be from where they should be, in their unit of length, and why."""

    tolerance: float
    """0 for numbers that are not rounded."""
    reason: str
    """As in "its coordinates have 3 decimals"."""


EXACT = Exactness(0.0, "")


def check_tolerance(tolerance: float | None) -> None:
    """MeshError for what is no length."""
    if tolerance is not None and not 0 <= tolerance < np.inf:
        raise MeshError(f"its tolerance must be a length in metres, not {tolerance!r}")


def assumed(
    vertices: NDArray[np.float64], scale: float = 1.0, tolerance: float | None = None
) -> Exactness:
    """How exact coordinates (k, 3) are once they are multiplied by `scale`.

    They may have few decimals, or be of single precision, as STL and glTF keep them. A `tolerance`
    after scaling is taken if it is larger; 0 says that they are exact.
    """
    check_tolerance(tolerance)
    numbers = np.unique(np.abs(vertices))
    largest = float(numbers[-1]) if len(numbers) else 0.0
    if tolerance == 0 or not 0 < largest < np.inf:
        return EXACT
    decimals = _decimals(numbers, largest)
    rounded = 0.0 if decimals is None else PLACES * scale * 10.0**-decimals
    single = bool((numbers.astype(np.float32) == numbers).all())
    last_bit = PLACES * scale * SINGLE_PRECISION * largest if single else 0.0
    reasons = {
        "its coordinates are exact": 0.0,
        f"its coordinates have {decimals} decimals": rounded,
        "its coordinates are of single precision": last_bit,
        "its tolerance is given": tolerance or 0.0,
    }
    reason = max(reasons, key=lambda reason: reasons[reason])
    return Exactness(reasons[reason], reason)


def shown(surface: Surface, exact: Exactness, tight: float) -> Exactness:
    """How exact vertices are, if faces show it that are plane within that and not within `tight`
    (metres); exact otherwise, since numbers may also be round because they were chosen so."""
    if tight < exact.tolerance <= COARSEST * surface.diagonal and is_nearly_flat(
        surface.vertices, surface.triangles, UNEVEN * tight, exact.tolerance
    ):
        return exact
    return EXACT


def evened(surface: Surface, exact: Exactness, tight: float, most_planes: int) -> float:
    """Make faces plane that would be but for rounding, and say so.

    What is within the length returned (metres) of a plane is in it: `tight` if all went well.
    """
    if exact.tolerance == 0:
        return tight
    flat = flattened(surface.vertices, surface.triangles, exact.tolerance, most_planes)
    if flat is None:
        return tight
    surface.vertices = flat.vertices
    surface.messages.append(f"{exact.reason}: faces that are plane within that were made plane")
    return max(tight, 4 * flat.uneven)


def _decimals(numbers: NDArray[np.float64], largest: float) -> int | None:
    """After how many decimals all numbers end; negative if they end before the point."""
    first = -int(np.floor(np.log10(largest)))
    for decimals in range(first, first + MOST_DIGITS + 1):
        shifted = numbers * 10.0**decimals
        # The double nearest to a number of few decimals is half of its last bit off.
        if (abs(shifted - np.round(shifted)) <= 4 * np.finfo(float).eps * shifted).all():
            return decimals
    return None
