"""`simulate` and `World` as users type them."""

from __future__ import annotations

import importlib
import io
import json
import os
import signal
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

import drystone as ds
from at_work import MANY_TIMES_ENOUGH, at_work
from conftest import Ran

Cli = Callable[..., Ran]


@pytest.fixture(scope="module")
def run() -> ds.Run:
    return ds.simulate(ds.scenes.fall7(), steps=200, forces=True)


def test_shapes_and_types(run: ds.Run) -> None:
    assert (run.status, run.reason, run.steps, run.finished) == ("finished", None, 200, True)
    assert run.names == ("ground", "1", "2", "3", "4", "5", "6", "7")
    assert run.poses.shape == run.velocities.shape == (201, 8, 3)
    assert run.motionless.shape == (200, 8)
    assert run.motionless.dtype == np.bool_
    per_step = (run.pivots, run.solves, run.rows, run.solve_seconds, run.penetration, run.residual)
    assert all(values.shape == (200,) for values in per_step)
    assert (run.pivots == run.major_cycles + run.minor_cycles).all()
    assert run.moving == ("6", "7")


def test_places_follow_velocities(run: ds.Run) -> None:
    """x+ = x + h v+, but for overlaps taken back; motionless bodies keep theirs to the bit."""
    moved = run.poses[:-1] + run.dt * run.velocities[1:]
    free = run.projections == 0
    assert np.abs(moved - run.poses[1:])[free].max() < 1e-12
    assert (run.poses[1:] == run.poses[:-1])[run.motionless].all()
    assert not run.velocities[1:][run.motionless].any()


def test_forces_carry_the_weight(run: ds.Run) -> None:
    """The ground's force is the change of all momentum less gravity, in every step."""
    masses = np.array([0.0, *(run.scene.body(name).mass for name in run.names[1:])])
    momentum = run.velocities[:, :, :2] * masses[:, None]
    for step in range(run.steps):
        rows = slice(run.force_starts[step], run.force_starts[step + 1])
        on_ground = run.force_bodies[rows, 0] == 0
        lift = run.forces[rows][on_ground].sum(axis=0)
        change = (momentum[step + 1] - momentum[step]).sum(axis=0) / run.dt
        weight = np.array([0, 9.81 * masses.sum()])
        assert lift - weight == pytest.approx(change, abs=1e-6)


def test_forces_are_recorded_on_demand_only() -> None:
    run = ds.simulate(ds.scenes.column(3), steps=3)
    assert run.force_starts.tolist() == [0]
    assert run.forces.shape == (0, 2)


def test_reuse_does_not_change_the_motion() -> None:
    runs = [ds.simulate(ds.scenes.falling_column(), steps=300, reuse=r) for r in ("none", "full")]
    assert np.abs(runs[0].poses - runs[1].poses).max() < 1e-9
    assert 10 * runs[1].pivots.sum() < runs[0].pivots.sum()


def rod() -> ds.Scene:
    """Painlevé's: thin, tan(angle) = 2, friction 2, to be thrown to the left."""
    scene = ds.Scene(friction=2.0)
    scene.add_box((0, -0.5), (20, 1), name="ground", fixed=True)
    angle = np.arctan(2)
    height = np.sin(angle) + 0.0005 * np.cos(angle)
    scene.add_box((0, height), (2, 0.001), angle=angle, name="rod")
    return scene


def test_a_rod_without_forces_goes_by_impulses(tmp_path: Path) -> None:
    thrown = {"rod": (-3.0, 0.0, 0.0)}
    run = ds.simulate(rod(), 1e-3, 500, formulation="acceleration", velocities=thrown)
    assert run.finished
    assert run.formulation == "acceleration"
    assert run.inconsistent.shape == (500, 2)
    assert run.inconsistent[0].tolist() == [0, 1]
    assert run.by_impulses == int((run.inconsistent >= 0).all(axis=1).sum()) >= 1
    assert f"Impulses in place of forces in {run.by_impulses} step" in str(run)
    assert run.to_dict()["steps_by_impulses"] == run.by_impulses
    run.save(tmp_path / "rod.npz")
    again = ds.Run.load(tmp_path / "rod.npz")
    assert again.formulation == run.formulation
    assert np.array_equal(again.inconsistent, run.inconsistent)
    by_velocity = ds.simulate(rod(), 1e-3, 500, velocities=thrown)
    assert (by_velocity.formulation, by_velocity.by_impulses) == ("velocity", 0)


def test_the_record_of_a_step_names_the_contact() -> None:
    world = ds.World(rod(), 1e-3, formulation="acceleration")
    world.set_velocity("rod", (-3, 0, 0))
    assert world.formulation == "acceleration"
    record = world.step()
    assert record.fallback == "no_solution"
    assert record.inconsistent == ("ground", "rod", "a:face 2 / b:corner 0")
    assert ds.World.restore(world.snapshot()).formulation == "acceleration"
    still = ds.World(ds.scenes.column(3), formulation="acceleration").step()
    assert (still.fallback, still.inconsistent, still.collisions) == (None, None, 0)


def test_runs_written_before_there_was_a_choice_are_read(run: ds.Run, tmp_path: Path) -> None:
    run.save(tmp_path / "new.npz")
    with np.load(tmp_path / "new.npz") as archive:
        arrays = {name: archive[name] for name in archive.files}
    about = json.loads(str(arrays.pop("about")))
    del about["formulation"], arrays["collisions"], arrays["inconsistent"]
    np.savez(tmp_path / "old.npz", about=np.array(json.dumps(about)), **arrays)
    assert ds.Run.load(tmp_path / "old.npz").to_dict() == run.to_dict()


def test_saved_and_loaded(run: ds.Run, tmp_path: Path) -> None:
    run.save(tmp_path / "run.npz")
    again = ds.Run.load(tmp_path / "run.npz")
    assert again.scene.to_json() == run.scene.to_json()
    for field in fields(run):
        mine, theirs = getattr(run, field.name), getattr(again, field.name)
        if field.name != "scene":
            assert np.array_equal(mine, theirs), field.name
    assert again.to_dict() == run.to_dict()
    assert [path.name for path in tmp_path.iterdir()] == ["run.npz"]


def test_what_is_no_run_is_refused(run: ds.Run, tmp_path: Path) -> None:
    run.save(tmp_path / "run.npz")
    whole = (tmp_path / "run.npz").read_bytes()
    (tmp_path / "short.npz").write_bytes(whole[: len(whole) // 2])
    (tmp_path / "text.npz").write_text("hello")
    np.savez(tmp_path / "other.npz", x=np.zeros(3))
    for name in ("short", "text", "other"):
        with pytest.raises(ds.SimulationError, match=f"{name}.npz"):
            ds.Run.load(tmp_path / f"{name}.npz")
    with pytest.raises(FileNotFoundError):
        ds.Run.load(tmp_path / "missing.npz")
    with pytest.raises(FileNotFoundError):
        run.save(tmp_path / "nowhere" / "run.npz")


@pytest.mark.parametrize("dt", [0.0, -1.0, float("nan"), float("inf")])
def test_bad_steps(dt: float) -> None:
    with pytest.raises(ds.SimulationError, match="dt is"):
        ds.simulate(ds.scenes.column(3), dt)


def test_bad_input() -> None:
    scene = ds.scenes.column(3)
    with pytest.raises(ds.SimulationError, match="steps is -1"):
        ds.simulate(scene, steps=-1)
    with pytest.raises(ds.SimulationError, match="restitution is 2"):
        ds.simulate(scene, restitution=2)
    with pytest.raises(ValueError, match='unknown reuse "some"'):
        ds.simulate(scene, reuse="some")
    with pytest.raises(ValueError, match='unknown formulation "force"'):
        ds.simulate(scene, formulation="force")
    with pytest.raises(ds.SimulationError, match='block "1": velocity must be three numbers'):
        ds.simulate(scene, velocities={"1": (1, 2)})
    with pytest.raises(ds.SceneError, match="no block is named"):
        ds.simulate(scene, velocities={"x": (1, 2, 3)})
    world = ds.World(scene)
    with pytest.raises(ds.SimulationError, match='block "1": force is NaN'):
        world.apply_force("1", (float("nan"), 0))
    with pytest.raises(ds.SimulationError, match='block "1": at is NaN'):
        world.apply_force("1", (1, 0), at=(0, float("nan")))
    with pytest.raises(ds.SimulationError, match="fixed"):
        world.apply_impulse("ground", (1, 0))
    overlapping = ds.Scene()
    overlapping.add_box((0, 0), (1, 1))
    overlapping.add_box((0.5, 0), (1, 1))
    with pytest.raises(ds.SceneError, match="overlap"):
        ds.simulate(overlapping)


def test_a_step_too_fast_ends_the_run_and_keeps_it() -> None:
    scene = ds.Scene(gravity=(0, 0))
    scene.add_box((10, 0), (4, 4), name="wall", fixed=True)
    scene.add_box((0, 0), (1, 1), name="block")
    run = ds.simulate(scene, steps=10, velocities={"block": (300, 0, 2.4e6)})
    assert (run.status, run.finished) == ("too_fast", False)
    assert 0 < run.steps < 10
    assert '"block" turns' in str(run)
    world = ds.World(scene)
    world.set_velocity("block", (300, 0, 2.4e6))
    world.run(run.steps)
    before = world.state_hash()
    with pytest.raises(ds.StepError, match="more than a thousand radians"):
        world.step()
    assert world.state_hash() == before


def test_what_turns_fast_is_stepped_in_parts() -> None:
    """A game's step, and a block that turns by more than a radian in it on the ground."""
    scene = ds.Scene(dimension=3, friction=0.5)
    scene.add_box((0, 0, -0.5), (20, 20, 1), name="ground", fixed=True)
    scene.add_box((0, 0, 0.2), (0.4, 0.4, 0.4), name="block")
    run = ds.simulate(scene, 1 / 60, 60, velocities={"block": (0, 0, 0, 0, 0, 70)})
    assert run.finished
    assert np.abs(run.velocities[-1, 1]).max() < 70
    assert run.penetration.max() < 1e-6


def test_which_steps_count_as_exact_can_be_asked_for() -> None:
    scene = ds.scenes.slope(35, friction=0.5, width=0.7)
    usual = ds.simulate(scene, steps=50)
    assert usual.status == "finished"
    strict = ds.simulate(scene, steps=50, coulomb_tolerance=1e-300)
    np.testing.assert_array_equal(usual.poses, strict.poses)
    coarse = ds.simulate(scene, steps=50, coulomb_tolerance=0.5)
    assert coarse.solves.sum() < usual.solves.sum()
    for wrong in (0, -1, 2, float("nan")):
        with pytest.raises(ds.SimulationError, match="coulomb_tolerance is"):
            ds.World(scene, coulomb_tolerance=wrong)


def test_a_world_goes_on_from_its_bytes() -> None:
    world = ds.World(ds.scenes.drop84(), reuse="full")
    world.run(120)
    state = world.snapshot()
    hashes = []
    for _ in range(2):
        world = ds.World.restore(state)
        world.apply_impulse("1", (1, 0))
        world.run(60)
        hashes.append(world.state_hash())
    assert hashes[0] == hashes[1]
    with pytest.raises(ds.SimulationError, match="no snapshot"):
        ds.World.restore(state[:-10])


def test_bodies_come_and_go() -> None:
    world = ds.World(ds.scenes.column(3, friction=0.5))
    assert world.add_polygon([(-0.5, 2), (0.5, 2), (0, 3)], name="roof") == "roof"
    assert world.add_box((3, 0.5), (1, 1), name="beside", fixed=True) == "beside"
    record = world.step()
    assert record.motionless.all()
    assert {force.b for force in world.forces} >= {"1", "2", "roof"}
    world.remove("1")
    run = world.run(200)
    assert run.names == ("ground", "2", "roof", "beside")
    assert run.poses[-1, 1, 1] == pytest.approx(0.5, abs=1e-9)
    assert world.scene.names == list(run.names)
    assert repr(world) == "<World: 4 bodies after 201 steps of 0.004167 s>"


def test_progress_is_told_and_can_stop_it() -> None:
    told: list[tuple[int, int]] = []

    def progress(made: int, total: int) -> None:
        told.append((made, total))
        raise KeyboardInterrupt

    run = ds.simulate(ds.scenes.wall84(), steps=100_000, reuse="none", progress=progress)
    assert run.status == "interrupted"
    assert told == [(run.steps, 100_000)]


def test_the_command_line(cli: Cli, tmp_path: Path) -> None:
    ran = cli("simulate", "col20", "--steps", "20", "-o", tmp_path / "run.npz")
    assert ran.status == 0
    assert ran.out.startswith("Finished: 20 steps of 4.167 ms, 0 pivots")
    assert "Nothing moves at the end" in ran.out
    assert ds.Run.load(tmp_path / "run.npz").steps == 20
    ran = cli("simulate", "fall7", "--steps", "9", "--dt", "0.001", "--reuse", "none", "--json")
    answer = json.loads(ran.out)
    assert (answer["steps"], answer["dt"], answer["reuse"]) == (9, 0.001, "none")
    assert answer["moving"] == ["6", "7"]


def test_the_command_line_chooses_the_formulation(cli: Cli) -> None:
    arguments = ("simulate", "fall7", "--steps", "20", "--formulation", "acceleration")
    answer = json.loads(cli(*arguments, "--json").out)
    assert (answer["formulation"], answer["steps_by_impulses"]) == ("acceleration", 0)
    ran = cli(*arguments)
    assert ran.status == 0
    assert "steps with collisions" in ran.out


def test_a_page_plays_the_run(run: ds.Run, cli: Cli, tmp_path: Path) -> None:
    assert repr(run.view()) == "<Page: run, 201 frames of 8 bodies>"
    still = ds.simulate(ds.scenes.column(3), steps=0)
    assert "of 3 bodies" in repr(still.view())
    ran = cli("simulate", "fall7", "--steps", "30", "-o", tmp_path / "run.html")
    assert ran.status == 0
    assert (tmp_path / "run.html").read_text().startswith("<!doctype html>")


def test_the_command_line_refuses(cli: Cli, tmp_path: Path) -> None:
    for arguments, message in (
        (["col20", "-o", tmp_path / "run.txt"], ".html, .gif, .mp4 or .npz"),
        (["col20", "--dt", "0"], "dt is 0"),
        (["col20", "-o", tmp_path / "nowhere" / "run.npz", "--steps", "1"], "nowhere"),
    ):
        ran = cli("simulate", *arguments)
        assert (ran.status, ran.out) == (2, "")
        assert message in ran.err


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_ctrl_c_keeps_what_is_done(tmp_path: Path) -> None:
    path = tmp_path / "run.npz"
    endless = ("simulate", "wall84", "--reuse", "none", "--steps", "100000", "-o", str(path))
    process = at_work(tmp_path / "flag", "RunProgress", *endless)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=MANY_TIMES_ENOUGH)
    assert process.returncode == 130
    assert out.startswith("Interrupted")
    assert 0 < ds.Run.load(path).steps < 100_000


def test_a_heap_that_tumbles_obeys_the_law_in_every_step() -> None:
    # By pivots alone 15 of these steps end off Coulomb's law, by up to 3 mm/s.
    run = ds.simulate(ds.scenes.drop84(friction=0.5), steps=1200)
    assert run.not_exact == 0
    assert run.friction_error.max() < 1e-6
    assert run.penetration.max() < 1e-6


def test_a_wall_that_is_hit_is_not_left_to_pivots() -> None:
    # By pivots alone a step took 67,000 of them, for 1,150 rows.
    scene = ds.scenes.wall(10, friction=0.6)
    scene.add_box((-1, 2.25), (1, 1), density=4000, name="thrown")
    run = ds.simulate(scene, steps=40, velocities={"thrown": (15, 0, 0)})
    assert run.finished
    assert (run.pivots * run.rows).max() < 4e6
    assert not run.motionless[-1].all()


def test_writing_a_run_says_so(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    said = io.StringIO()
    command = importlib.import_module("drystone.cli.simulate")
    monkeypatch.setattr(command, "console", lambda **_: Console(file=said, force_terminal=True))
    assert cli("simulate", "fall7", "--steps", "2", "-o", tmp_path / "run.npz").status == 0
    assert "writing " in said.getvalue()
