"""Scenes, answers, plans and runs as pages of HTML, which open in a browser from disk, without a
network.

`plan_page`, `run_page` and `scene_page` make a page; `Page.save` writes it into a file, and a
notebook shows it. The front end is in `viewer/` of the source tree, the contract between the
two sides in `drystone/recording/contract.py` and `contract.ts` there.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import singledispatch
from typing import TYPE_CHECKING

from drystone.equilibrium.contact_force import CANONICAL, WhichForces
from drystone.equilibrium.limits import Limit
from drystone.equilibrium.margins import Margin
from drystone.equilibrium.mechanism import at_limit, at_margin
from drystone.equilibrium.settled import Settled
from drystone.equilibrium.strong import Escape
from drystone.equilibrium.structure import Structure
from drystone.equilibrium.verdict import Verdict
from drystone.motion.run import Run
from drystone.planning.answer import Plan
from drystone.recording.of_motion import moved_recording, settled_recording, verdict_recording
from drystone.recording.of_plan import Progress, plan_recording
from drystone.recording.of_run import recording_of_run, run_recording
from drystone.recording.of_scene import scene_recording
from drystone.recording.recording import FrameForces, Recording, Series
from drystone.scene import Scene
from drystone.viewer.page import Page
from drystone.viewer.showing import show

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["FrameForces", "Page", "Recording", "Series", "plan_page", "run_page", "scene_page"]


def plan_page(plan: Plan, progress: Progress | None = None, which: WhichForces = CANONICAL) -> Page:
    """The page of a plan: the order of removal, step by step, with contact forces.

    >>> import drystone as ds
    >>> plan_page(ds.plan(ds.scenes.column(4)))
    <Page: plan, 4 frames of 4 bodies>
    """
    return Page(plan_recording(plan, progress, which))


def scene_page(scene: Scene) -> Page:
    """The page of a scene: its bodies, those that overlap in red.

    >>> import drystone as ds
    >>> scene_page(ds.scenes.column(4))
    <Page: plan, 1 frame of 4 bodies>
    """
    return Page(scene_recording(scene))


def run_page(
    scene: Scene,
    times: ArrayLike,
    poses: ArrayLike,
    motionless: ArrayLike,
    pivots: ArrayLike,
    solve_seconds: ArrayLike,
    forces: FrameForces | None = None,
    *,
    title: str = "",
    captions: Sequence[tuple[int, str]] = (),
    notes: Sequence[str] = (),
    series: Sequence[Series] = (),
) -> Page:
    """The page of a motion, given as arrays: it may come from any simulator.

    Bodies are in the order of `scene.bodies`, fixed ones included. For a run of n steps:

    - `times` (n + 1,), s;
    - `poses` (n + 1, bodies, 3): x and y of the centre of mass (m) and the angle (rad, as
      `Body.angle`). In space (n + 1, bodies, 7): position (m) and a unit quaternion w, x, y, z.
      NaN where a body is not there;
    - `motionless` (n + 1, bodies), or (n, bodies) if it is known of steps only: these bodies are
      drawn dark;
    - `pivots` and `solve_seconds` (n,), and the values of further `series`: the charts;
    - `forces`: contact forces of n + 1 frames;
    - `captions`: (frame, text), what is said from that frame on; `notes`: lines under the picture.

    Raises ValueError, naming the array, if shapes do not fit together.
    """
    recording = run_recording(
        scene,
        times,
        poses,
        motionless,
        pivots,
        solve_seconds,
        forces,
        title=title,
        captions=captions,
        notes=notes,
        series=series,
    )
    return Page(recording)


@singledispatch
def page_of(thing: object) -> Page:
    """The page of a scene, an answer, a plan or a run; TypeError for what has none."""
    raise TypeError(f"there is no page of a {type(thing).__name__}")


page_of.register(Page, lambda page: page)
page_of.register(Scene, scene_page)
page_of.register(Plan, plan_page)


@page_of.register(Run)
def _(run: Run) -> Page:
    return Page(recording_of_run(run))


@page_of.register(Verdict)
def _(verdict: Verdict) -> Page:
    return Page(verdict_recording(verdict))


@page_of.register(Structure)
def _(structure: Structure) -> Page:
    return Page(verdict_recording(structure.check()))


@page_of.register(Settled)
def _(settled: Settled) -> Page:
    return Page(settled_recording(settled))


@page_of.register(Escape)
def _(escape: Escape) -> Page:
    return Page(moved_recording(escape))


@page_of.register(Limit)
def _(limit: Limit) -> Page:
    return Page(moved_recording(at_limit(limit)))


@page_of.register(Margin)
def _(margin: Margin) -> Page:
    return Page(moved_recording(at_margin(margin)))


def show_thing(thing: object) -> None:
    """Show its page, or its picture if it has none; see `drystone.viewer.showing`."""
    known = page_of.dispatch(type(thing)) is not page_of.dispatch(object)
    show(thing, page_of(thing) if known else None)
