"""What a picture of forces and of a motion is of: a verdict, or a structure at its limit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from drystone.equilibrium.contact_force import ContactForces
    from drystone.scene import Scene


class Moved(Protocol):
    """A structure with forces, and with blocks that move, if any do; `str` is its caption."""

    @property
    def scene(self) -> Scene: ...
    @property
    def names(self) -> tuple[str, ...]:
        """The movable bodies that are there."""

    @property
    def forces(self) -> ContactForces | None: ...
    @property
    def falling(self) -> tuple[str, ...]: ...
    def acceleration(self, name: str) -> NDArray[np.float64]:
        """(3,), in space (6,)."""
