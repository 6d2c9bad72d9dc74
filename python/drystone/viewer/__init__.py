"""Plans, runs and scenes to look at: one self-contained page each, which opens from disk.

`plan_page`, `run_page` and `scene_page` make pages of what they are given; `Page.save` writes one,
and a notebook shows it. The front end is in `viewer/` of the source tree, the contract between the
two sides in `drystone/recording/contract.py` and `contract.ts` there.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import singledispatch
from typing import TYPE_CHECKING

from drystone.equilibrium.contact_force import CANONICAL
from drystone.motion.run import Run
from drystone.planning.answer import Plan
from drystone.recording.of_plan import Progress, plan_recording
from drystone.recording.of_run import recording_of_run, run_recording
from drystone.recording.of_scene import scene_recording
from drystone.recording.recording import FrameForces, Recording, Series
from drystone.scene import Scene
from drystone.viewer.page import Page

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["FrameForces", "Page", "Recording", "Series", "plan_page", "run_page", "scene_page"]


def plan_page(plan: Plan, progress: Progress | None = None, which: str = CANONICAL) -> Page:
    """The order of removal, step by step; see `plan_recording`.

    >>> import drystone as ds
    >>> plan_page(ds.plan(ds.scenes.column(4)))
    <Page: plan, 4 frames of 4 bodies>
    """
    return Page(plan_recording(plan, progress, which))


def scene_page(scene: Scene) -> Page:
    """The bodies of a scene, those that overlap in red; see `scene_recording`.

    >>> import drystone as ds
    >>> scene_page(ds.scenes.column(4))
    <Page: plan, 1 frames of 4 bodies>
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
    """The motion of the bodies of `scene`; the arrays are those of `run_recording`."""
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
    """The page of a scene, a plan or a run; TypeError for what has none."""
    raise TypeError(f"there is no page of a {type(thing).__name__}")


page_of.register(Scene, scene_page)
page_of.register(Plan, plan_page)


@page_of.register
def _(run: Run) -> Page:
    return Page(recording_of_run(run))
