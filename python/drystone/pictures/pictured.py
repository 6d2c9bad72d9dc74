"""Which picture belongs to what."""

from __future__ import annotations

from functools import singledispatch
from typing import TYPE_CHECKING

from drystone.equilibrium.limits import Limit
from drystone.equilibrium.margins import Margin
from drystone.equilibrium.settled import Settled
from drystone.equilibrium.strong import Escape
from drystone.equilibrium.structure import Structure
from drystone.equilibrium.verdict import Verdict
from drystone.motion.run import Run
from drystone.motion.world import World
from drystone.pictures.canvas import drawing_on
from drystone.pictures.figures import plan_figure, scene_figure, verdict_figure
from drystone.pictures.limits import escape_figure, limit_figure, margin_figure
from drystone.pictures.recording import frame_figure, frames_box
from drystone.pictures.settled import settled_figure
from drystone.planning.answer import Plan
from drystone.recording.of_run import recording_of_run
from drystone.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@singledispatch
def figure_of(thing: object) -> Figure:
    """The picture of a scene or an answer; TypeError for what has none."""
    raise TypeError(f"there is no picture of a {type(thing).__name__}")


figure_of.register(Scene, scene_figure)
figure_of.register(Verdict, verdict_figure)
figure_of.register(Limit, limit_figure)
figure_of.register(Margin, margin_figure)
figure_of.register(Escape, escape_figure)
figure_of.register(Settled, settled_figure)
figure_of.register(Plan, plan_figure)


@figure_of.register(Run)
def _(run: Run) -> Figure:
    """Where the bodies are at the end."""
    recording = recording_of_run(run)
    last = len(recording.states) - 1
    return frame_figure(recording, last, frames_box(recording, [last]))


@figure_of.register(World)
def _(world: World) -> Figure:
    """Where the bodies are now."""
    return scene_figure(world.scene)


@figure_of.register(Structure)
def _(structure: Structure) -> Figure:
    """The blocks that are there, with the forces between them or how they fall."""
    return verdict_figure(structure.check())


def draw_on(thing: object, axes: Axes) -> None:
    """Its picture, in axes of a figure that is somebody else's."""
    with drawing_on(axes):
        figure_of(thing)
