"""Runs of many steps: what is kept of them, and how much memory that takes."""

from __future__ import annotations

import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import drystone as ds
from conftest import Ran
from drystone.recording.of_run import recording_of_run


@pytest.mark.parametrize("space", [False, True])
@pytest.mark.parametrize(("steps", "every"), [(100, 7), (98, 7), (3, 7), (0, 7)])
def test_of_every_seventh_step_and_the_last(space: bool, steps: int, every: int) -> None:
    scene = ds.scenes.fall7().extruded(1.0) if space else ds.scenes.fall7()
    whole = ds.simulate(scene, steps=steps, forces=True)
    some = ds.simulate(scene, steps=steps, forces=True, every=every)
    kept = sorted({*range(0, steps + 1, every), steps})
    assert some.step_numbers.tolist() == kept
    assert some.times == pytest.approx(np.array(kept) / 240)
    assert (some.steps, some.every, whole.every) == (steps, every, 1)
    for name in ("poses", "velocities"):
        assert np.array_equal(getattr(some, name), getattr(whole, name)[kept])
    for name in ("pivots", "motionless", "penetration", "exact"):
        assert np.array_equal(getattr(some, name), getattr(whole, name))
    of_each = [
        whole.forces[a:b] for a, b in zip(whole.force_starts, whole.force_starts[1:], strict=False)
    ]
    assert np.array_equal(
        some.forces,
        np.concatenate([np.zeros((0, 3 if space else 2)), *(of_each[k - 1] for k in kept[1:])]),
    )


def test_a_page_a_film_and_a_file_of_it(tmp_path: Path) -> None:
    run = ds.simulate(ds.scenes.fall7(), steps=50, forces=True, every=20)
    recording = recording_of_run(run)
    assert recording.steps is not None
    assert recording.times is not None
    assert recording.steps.tolist() == [0, 20, 40, 50]
    assert recording.times.tolist() == pytest.approx([0, 20 / 240, 40 / 240, 50 / 240])
    (pivots, _) = recording.series
    assert np.nansum(pivots.values) == run.pivots.sum()
    assert "20" in pivots.name
    assert recording.title == "8 bodies, 50 steps"
    assert "every 20th step" in recording.notes[0]
    still = recording.states[1] == recording_of_run(ds.simulate(run.scene, steps=20)).states[-1]
    assert still.all(), "no body begins to move within these steps"
    for name in ("run.npz", "run.html", "run.gif", "run.svg"):
        run.save(tmp_path / name)
    again = ds.Run.load(tmp_path / "run.npz")
    assert again.every == 20
    assert np.array_equal(again.poses, run.poses)
    assert np.array_equal(again.step_numbers, run.step_numbers)


def test_the_command_line(cli: Callable[..., Ran], tmp_path: Path) -> None:
    path = tmp_path / "run.npz"
    ran = cli("simulate", "fall7", "--steps", "100", "--every", "30", "-o", path)
    assert ran.status == 0, ran.err
    run = ds.Run.load(path)
    assert run.step_numbers.tolist() == [0, 30, 60, 90, 100]
    assert len(run.poses) == 5


def test_what_takes_much_memory_says_so_before_it_does() -> None:
    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    scene = ds.scenes.drop84()
    with pytest.warns(
        UserWarning, match=r"2\.3 GB of memory: every=50 keeps .* every 50th step"
    ) as told:
        ds.simulate(scene, steps=500_000, progress=stopped)
    assert told[0].filename == __file__
    with pytest.warns(UserWarning, match="and the forces"):
        ds.World(scene).run(500_000, forces=True, progress=stopped)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ds.simulate(scene, steps=500_000, every=50, progress=stopped)
        ds.simulate(scene, steps=1000)


@pytest.mark.skipif(sys.platform != "linux", reason="counts memory as Linux does")
def test_the_estimate_is_what_a_run_takes() -> None:
    """Of 100,000 steps of 50 bodies that stand: 286 MB by the estimate."""
    code = (
        "import resource, drystone as ds\n"
        "def used(): return int(open('/proc/self/statm').read().split()[1])\n"
        "scene = ds.scenes.column(50)\n"
        "ds.simulate(scene, steps=10)\n"
        "before = used()\n"
        "run = ds.simulate(scene, steps=100_000)\n"
        "print((used() - before) * resource.getpagesize())\n"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    estimate = 100_000 * (50 * (48 + 2) + 400)
    assert 0.6 * estimate < int(ran.stdout) < 1.5 * estimate


@pytest.mark.parametrize("every", [0, -1, 1.5, "2"])
def test_an_every_that_is_none(every: int) -> None:
    with pytest.raises((ds.SimulationError, TypeError), match="every"):
        ds.simulate(ds.scenes.column(2), steps=1, every=every)
    with pytest.raises((ds.SimulationError, TypeError), match="every"):
        ds.World(ds.scenes.column(2)).run(1, every=every)
