"""A structure at its limit, with the forces that still hold it; and one that can leave rest."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drystone.equilibrium.mechanism import at_limit, at_margin
from drystone.pictures.figures import moved_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from drystone.equilibrium.limits import Limit
    from drystone.equilibrium.margins import Margin
    from drystone.equilibrium.strong import Escape


def escape_figure(escape: Escape) -> Figure:
    """How blocks leave rest although they could stay, with the forces in that motion."""
    return moved_figure(escape, "m/s²")


def margin_figure(margin: Margin) -> Figure:
    """The collapse under the least horizontal acceleration, with the forces before it."""
    return moved_figure(at_margin(margin), "m/s")


def limit_figure(limit: Limit) -> Figure:
    """The greatest factor: contact forces and the push to scale, blocks that move in red."""
    return moved_figure(at_limit(limit), "m/s")
