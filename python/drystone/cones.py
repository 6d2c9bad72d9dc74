"""Friction cones in space: their edges, and on which side of the round cone these lie."""

from __future__ import annotations

from drystone import _core

FACETS = 8
"""Edges of a friction cone without a choice."""

CONES = ("inscribed", "circumscribed", "both")
"""The sides of Coulomb's cone that `check` knows."""


def core_cones(facets: int, cone: str, known: tuple[str, ...] = CONES[:2]) -> tuple[int, str]:
    """What the core takes; SceneError for less than three facets, ValueError for another cone."""
    if cone not in known:
        raise ValueError(f"unknown cone {cone!r}: choose one of {', '.join(known)}")
    if facets < 3:
        raise _core.SceneError(f"facets is {facets}: a friction cone in space has at least 3")
    return facets, cone
