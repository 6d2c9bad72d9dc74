"""Friction cones in space: their edges, and on which side of the round cone these lie."""

from __future__ import annotations

from typing import Final, Literal, TypeAlias, get_args

from drystone import _core
from drystone.common.numbers import whole

FACETS = 8
"""Edges of a friction cone without a choice."""

MOST_FACETS = 1000
"""Edges of a friction cone at most: they leave out 5e-6 of the coefficient, and cost memory."""

Pyramid: TypeAlias = Literal["inscribed", "circumscribed"]
"""On which side of Coulomb's cone the pyramids lie."""

Cone: TypeAlias = Literal["round", "inscribed", "circumscribed"]
"""Coulomb's cone itself, or pyramids: what `limit` and `margin` know."""

ConeOfCheck: TypeAlias = Literal["round", "inscribed", "circumscribed", "both"]
"""What `check` knows: pyramids on both sides too."""

ROUND: Final = "round"
INSCRIBED: Final = "inscribed"
CONES = get_args(ConeOfCheck)[1:]
"""Pyramids on either side of Coulomb's cone; `check` alone knows both at once."""


def core_cones(facets: int, cone: str, known: tuple[str, ...] = CONES[:2]) -> tuple[int, str]:
    """What the core takes; SceneError for facets that are not 3 to `MOST_FACETS`,
    ValueError for another cone."""
    if cone not in known:
        raise ValueError(f"unknown cone {cone!r}: choose one of {', '.join(known)}")
    edges = whole(facets, "facets")
    if not 3 <= edges <= MOST_FACETS:
        raise _core.SceneError(f"facets is {edges}: a cone in space has 3 to {MOST_FACETS}")
    return edges, cone
