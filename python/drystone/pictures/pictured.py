"""Which picture belongs to what."""

from __future__ import annotations

from functools import singledispatch
from typing import TYPE_CHECKING

from drystone.equilibrium.limits import Limit
from drystone.equilibrium.margins import Margin
from drystone.equilibrium.verdict import Verdict
from drystone.pictures.figures import plan_figure, scene_figure, verdict_figure
from drystone.pictures.limits import limit_figure, margin_figure
from drystone.planning.answer import Plan
from drystone.scene import Scene

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@singledispatch
def figure_of(thing: object) -> Figure:
    """The picture of a scene or an answer; TypeError for what has none."""
    raise TypeError(f"there is no picture of a {type(thing).__name__}")


figure_of.register(Scene, scene_figure)
figure_of.register(Verdict, verdict_figure)
figure_of.register(Limit, limit_figure)
figure_of.register(Margin, margin_figure)
figure_of.register(Plan, plan_figure)
