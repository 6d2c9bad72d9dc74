"""Friction cones in space: their edges, and on which side of the round cone these lie."""

from __future__ import annotations

from drystone import _core

FACETS = 8
"""Edges of a friction cone without a choice."""

MOST_FACETS = 1000
"""Edges of a friction cone at most: they leave out 5e-6 of the coefficient, and cost memory."""

ROUND = "round"
"""Coulomb's cone itself, which `check` knows."""

CONES = ("inscribed", "circumscribed", "both")
"""Pyramids on either side of Coulomb's cone; `check` alone knows both at once."""


def core_cones(facets: int, cone: str, known: tuple[str, ...] = CONES[:2]) -> tuple[int, str]:
    """What the core takes; SceneError for facets that are not 3 to `MOST_FACETS`,
    ValueError for another cone."""
    if cone not in known:
        raise ValueError(f"unknown cone {cone!r}: choose one of {', '.join(known)}")
    if not 3 <= facets <= MOST_FACETS:
        raise _core.SceneError(f"facets is {facets}: a cone in space has 3 to {MOST_FACETS}")
    return facets, cone
