"""Bodies that nearly touch."""

from __future__ import annotations

from dataclasses import dataclass

from drystone.common.text import shown


@dataclass(frozen=True, slots=True)
class NearMiss:
    """Two bodies that do not touch, but would with a contact tolerance ten times larger."""

    a: str
    b: str
    gap: float
    """Metres between their surfaces."""
    contact_tolerance: float
    """Metres: a scene with this one takes them for touching."""

    def __str__(self) -> str:
        return (
            f'With contact_tolerance={self.contact_tolerance:.3g} "{shown(self.a)}" would touch '
            f'"{shown(self.b)}": gap {self.gap:.3g} m.'
        )
