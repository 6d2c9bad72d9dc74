"""Bodies that overlap."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Overlap:
    """Two bodies that occupy the same place by more than the contact tolerance."""

    a: str
    b: str
    depth: float
    """The shortest way to part them, metres."""
    contact_tolerance: float
    """How deep these two might be in each other, metres."""
