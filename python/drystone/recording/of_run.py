"""A run as a recording: one frame for the start and one for each step that is kept."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from drystone.common.text import ordinal
from drystone.recording.contract import ABSENT, MOTIONLESS, PRESENT
from drystone.recording.recording import POSE, FrameForces, Recording, Series

if TYPE_CHECKING:
    from drystone.motion.run import Run
    from drystone.scene import Scene


def recording_of_run(run: Run) -> Recording:
    """A run, with its contact forces if they were recorded."""
    steps = run.step_numbers
    made = run_recording(
        run.scene,
        run.times,
        run.poses,
        _together(np.logical_and, run.motionless, steps)
        if run.steps
        else np.ones((1, len(run.names)), dtype=bool),
        _together(np.add, run.pivots, steps),
        _together(np.add, run.solve_seconds, steps),
        _forces(run),
        title=f"{len(run.names):,} bodies, {run.steps:,} steps",
    )
    if run.every == 1:
        return made
    sums = [replace(one, name=f"{one.name}, sums of {run.every}") for one in made.series]
    note = f"The run has the bodies after every {ordinal(run.every)} step."
    return replace(made, steps=steps, series=sums, notes=[note])


def _together(function: np.ufunc, values: NDArray[Any], steps: NDArray[np.int64]) -> NDArray[Any]:
    """What is known of steps, of all those between two of them that are kept."""
    return function.reduceat(values, steps[:-1]) if len(steps) > 1 else values


def _forces(run: Run) -> FrameForces | None:
    if run.steps == 0 or len(run.force_starts) != len(run.poses):
        return None
    # The beginning has no forces of its own: it shows those of the first step.
    first = run.force_starts[1]
    twice = [
        np.concatenate([values[:first], values])
        for values in (run.force_bodies, run.force_points, run.forces)
    ]
    return FrameForces(np.concatenate([[0], run.force_starts + first]), *twice)


def run_recording(
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
) -> Recording:
    """The arrays of a run of `steps` steps, bodies in the order of `scene.bodies`.

    `times` is (steps + 1,), s. `poses` is (steps + 1, bodies, 3): x and y of the centroid (m) and
    the angle (rad, as `Body.angle`); in space (steps + 1, bodies, 7): position (m) and orientation
    (a unit quaternion w, x, y, z). A body that is not there in a frame has NaN. `motionless` is
    (steps + 1, bodies), or (steps, bodies) if it is found in the steps: the first frame then shows
    what the first step found. `pivots` and `solve_seconds` are (steps,), and so are the values of
    further `series`. `forces` has steps + 1 frames, and `captions` are (frame, text).

    Raises ValueError, naming the array, if shapes do not fit together.
    """
    at = np.asarray(poses, dtype=np.float64)
    bodies = len(scene)
    pose = POSE[scene.dimension]
    if at.ndim != 3 or at.shape[0] == 0 or at.shape[1:] != (bodies, pose):
        raise ValueError(
            f"poses has the shape {at.shape}: it must be (steps + 1, {bodies}, {pose})"
        )
    steps = len(at) - 1
    charts = [
        Series("pivots per step", pivots),
        Series("solve time per step", solve_seconds, "s"),
        *series,
    ]
    absent: NDArray[np.bool_] = np.any(np.isnan(at), axis=2)
    states = np.where(_still(motionless, steps, bodies), MOTIONLESS, PRESENT)
    return Recording(
        kind="run",
        title=title or f"{len(scene):,} bodies, {steps:,} steps",
        bodies=scene.bodies,
        states=np.where(absent, ABSENT, states).astype(np.uint8),
        gravity=scene.gravity,
        loads=scene.loads,
        poses=np.where(absent[:, :, None], 0.0, at),
        times=np.asarray(times, dtype=np.float64),
        forces=forces,
        series=[Series(one.name, _by_frame(one, steps), one.unit) for one in charts],
        captions=captions,
        notes=notes,
    )


def _still(motionless: ArrayLike, steps: int, bodies: int) -> NDArray[np.bool_]:
    """(steps + 1, bodies)."""
    still: NDArray[np.bool_] = np.asarray(motionless, dtype=np.bool_)
    if still.shape == (steps, bodies) and steps > 0:
        return np.concatenate([still[:1], still])
    if still.shape != (steps + 1, bodies):
        raise ValueError(
            f"motionless has the shape {still.shape}: it must be ({steps + 1}, {bodies}) "
            f"or ({steps}, {bodies})"
        )
    return still


def _by_frame(series: Series, steps: int) -> NDArray[np.float64]:
    """A value for each step, after nothing for the start."""
    values = np.asarray(series.values, dtype=np.float64)
    if values.shape != (steps,):
        raise ValueError(f"{series.name} has the shape {values.shape}: it must be ({steps},)")
    return np.concatenate([[np.nan], values])
