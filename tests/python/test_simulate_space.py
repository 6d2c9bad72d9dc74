"""Simulation in space from Python: shapes of arrays, pushes, new bodies, files, pages, errors."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh

import drystone as ds
from conftest import Ran

Cli = Callable[..., Ran]


@pytest.fixture
def tower() -> ds.Scene:
    """Three cubes on the ground."""
    scene = ds.Scene(dimension=3, friction=0.5)
    scene.add_box((0, 0, -0.5), (9, 9, 1), name="ground", fixed=True)
    for level in range(3):
        scene.add_box((0, 0, level + 0.5), (1, 1, 1), name=f"cube{level}")
    return scene


def test_shapes_and_forces(tower: ds.Scene) -> None:
    run = ds.simulate(tower, steps=12, forces=True)
    assert run.finished
    assert run.moving == ()
    assert run.poses.shape == (13, 4, 7)
    assert run.velocities.shape == (13, 4, 6)
    assert np.array_equal(run.poses[-1], run.poses[0])
    assert run.force_points.shape[1] == run.forces.shape[1] == 3
    for first, last in zip(run.force_starts, run.force_starts[1:], strict=False):
        on_ground = (run.force_bodies[first:last] == (0, 1)).all(axis=1)
        total = run.forces[first:last][on_ground].sum(axis=0)
        assert total == pytest.approx((0, 0, 3 * 9.81), abs=1e-9)
    assert (run.solves[0], run.solves[1:].max()) == (1, 0)


def test_a_push_has_force_and_moment(tower: ds.Scene) -> None:
    """Against rigid-body mechanics, free of contacts for the length of a step."""
    weightless = ds.Scene(dimension=3, gravity=(0, 0, 0))
    weightless.add_box((0, 0, 0), (1, 2, 3), name="brick", orientation=(0.8, 0, 0.6, 0), density=2)
    inertia = np.asarray(weightless.body("brick").inertia)
    world = ds.World(weightless, dt=0.01)
    force, at, moment = np.array([1.0, 2.0, -1.0]), np.array([0.5, 0.1, 0.2]), np.array([0.3, 0, 1])
    world.apply_force("brick", force, at=at, moment=moment)
    world.step()
    expected = 0.01 * np.linalg.solve(inertia, np.cross(at, force) + moment)
    assert world.velocities[0, :3] == pytest.approx(0.01 * force / 12, abs=1e-15)
    # The body has turned since by what it turns in a step.
    assert world.velocities[0, 3:] == pytest.approx(expected, abs=1e-6)
    twin = ds.World(weightless, dt=0.01)
    twin.apply_impulse("brick", 0.01 * force, at=at, moment=0.01 * moment)
    assert twin.velocities[0, 3:] == pytest.approx(expected, abs=1e-15)
    assert twin.velocities[0, :3] == pytest.approx(0.01 * force / 12, abs=1e-15)


def test_bodies_come_and_go(tower: ds.Scene) -> None:
    world = ds.World(tower)
    assert world.dimension == 3
    world.step()
    assert world.add_box((0, 0, 3.5), (1, 1, 1), name="top") == "top"
    record = world.step()
    assert record.motionless.all()
    assert record.rows_reused > 0
    prism = [(3, 0, 0), (4, 0, 0), (3, 1, 0), (3, 0, 1)]
    assert world.add(lambda scene: scene.add_polyhedron(prism, name="prism")) == "prism"
    assert world.step().motionless.all()
    with pytest.raises(ds.SceneError, match="overlap"):
        world.add_box((0, 0, 4.0), (1, 1, 1))
    assert len(world.names) == 6
    world.remove("cube1")
    world.run(150)
    assert world.poses[world.names.index("cube2"), 2] == pytest.approx(1.5, abs=1e-9)
    assert len(world.forces[0].point) == 3


def test_states_go_on_bit_for_bit(tower: ds.Scene) -> None:
    world = ds.World(tower, facets=6, cone="circumscribed")
    world.step()
    world.set_velocity("cube2", (2, 1, 0, 0, 0, 4))
    world.run(30)
    twin = ds.World.restore(world.snapshot())
    assert twin.state_hash() == world.state_hash()
    assert np.array_equal(twin.run(50).poses, world.run(50).poses)


def test_files_and_pages(tower: ds.Scene, tmp_path: Path, cli: Cli) -> None:
    run = ds.simulate(tower, steps=30, velocities={"cube2": (3, 0, 0, 0, 0, 0)})
    run.save(tmp_path / "run.npz")
    again = ds.Run.load(tmp_path / "run.npz")
    assert np.array_equal(again.poses, run.poses)
    assert again.scene.dimension == 3
    assert repr(run.view()) == "<Page: run, 31 frames of 4 bodies>"
    tower.save(tmp_path / "tower.json")
    file = tmp_path / "run.html"
    ran = cli("simulate", tmp_path / "tower.json", "--steps", "5", "--facets", "6", "-o", file)
    assert ran.status == 0
    assert "Nothing moves at the end" in ran.out
    assert file.read_text().startswith("<!doctype html>")
    ran = cli("simulate", tmp_path / "tower.json", "--steps", "5", "--json")
    assert len(json.loads(ran.out)["poses"]["cube2"]) == 7


def test_what_is_refused(tower: ds.Scene, tmp_path: Path, cli: Cli) -> None:
    with pytest.raises(ds.SimulationError, match='in space give "velocity"'):
        ds.simulate(tower, formulation="acceleration")
    with pytest.raises(ds.SceneError, match="3 to 1000"):
        ds.simulate(tower, facets=2)
    with pytest.raises(ds.SimulationError, match="six numbers"):
        ds.simulate(tower, velocities={"cube0": (1, 0, 0)})
    world = ds.World(tower)
    with pytest.raises(ds.SimulationError, match="moment must be three numbers"):
        world.apply_force("cube0", (1, 0, 0), moment=2.0)  # type: ignore[arg-type]
    with pytest.raises(ds.SimulationError, match="force must be three numbers"):
        world.apply_force("cube0", (1, 0))
    with pytest.raises(ds.SimulationError, match="fixed"):
        world.apply_impulse("ground", (1, 0, 0))
    with pytest.raises(ds.SimulationError, match="begin with the world's bodies"):
        world.add(_moved)
    tower.save(tmp_path / "tower.json")
    ran = cli("simulate", tmp_path / "tower.json", "--formulation", "acceleration")
    assert ran.status == 2
    assert "velocity" in ran.err


def _moved(scene: ds.Scene) -> str:
    """Puts another scene's bodies in the place of the world's."""
    other = ds.Scene(dimension=3)
    name = other.add_box((0, 0, 9), (1, 1, 1))
    scene._core = other._core
    return name


@pytest.mark.parametrize("degrees", [0, 10, 22.5, 30])
def test_a_plate_thrown_along_a_floor_stops_on_a_straight_line(degrees: float) -> None:
    """Coulomb: it loses mu g of its speed a second, against its motion, whatever its direction."""
    speed, friction, dt = 4.0, 0.5, 1 / 240
    scene = ds.Scene(dimension=3, friction=friction)
    scene.add_box((0, 0, -0.5), (100, 100, 1), name="floor", fixed=True)
    scene.add_box((0, 0, 0.05), (1, 1, 0.1), name="plate")
    way = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    start = {"plate": (*(speed * way), 0, 0, 0, 0)}
    run = ds.simulate(scene, steps=240, velocities=start)
    x, y = run.poses[-1, 1, :2]
    assert np.arctan2(y, x) == pytest.approx(np.radians(degrees), abs=1e-9)
    # Each step goes as far as its speed at the end says: half a step's way less than v^2 / 2 mu g.
    assert np.hypot(x, y) == pytest.approx(
        speed**2 / (2 * friction * 9.81) - speed * dt / 2, abs=1e-3
    )
    assert (run.moving, run.not_exact) == ((), 0)


def test_a_plank_pushed_out_of_a_tower_leaves_the_others_where_they_are() -> None:
    """Faces on faces have many corners that say the same: a step takes few pivots all the same."""
    scene = ds.Scene(dimension=3, friction=0.3)
    scene.add_box((0, 0, -0.5), (6, 6, 1), name="table", fixed=True)
    for layer in range(6):
        for k in (-1.01, 0, 1.01):
            along = layer % 2 == 0
            place, size = ((0, k), (3.03, 1)) if along else ((k, 0), (1, 3.03))
            scene.add_box((*place, 0.6 * layer + 0.3), (*size, 0.6), name=f"{layer} {k}")
    world = ds.World(scene)
    pushed = world.names.index("3 0")
    weight = scene.body("3 0").mass * 9.81
    # It bears the six planks above it at most: friction is 0.3 (6 + 7) times its weight at most.
    for _ in range(60):
        world.apply_force("3 0", (0, 4.0 * weight, 0))
        record = world.step()
        assert record.rows > 1000
        assert record.pivots < 200
        assert record.exact
        assert np.flatnonzero(~record.motionless).tolist() == [pushed]
    assert world.velocities[pushed, 1] > 0.1 * 9.81 * 60 / 240


def test_a_top_precesses_as_theory_says() -> None:
    """A symmetric top on its tip: I3 w3 W - I1 W^2 cos(tilt) = m g l, its tilt stays.

    Goldstein, Classical Mechanics, 5.7: I1 about the tip, W the slower of two roots. The integrator
    is of first order, and so is what it is off.
    """
    spin, tilt, seconds, rim = 60.0, 0.2, 0.25, 2 * np.pi * np.arange(24) / 24
    corners = np.column_stack([0.15 * np.cos(rim), 0.15 * np.sin(rim), np.full(24, 0.06)])
    solid = trimesh.convex.convex_hull(np.vstack([[0, 0, 0], corners, [0, 0, 0.08]]))
    mass, height = solid.volume, solid.center_mass[2]
    inertia = np.diagonal(solid.moment_inertia)
    about_tip = (inertia[0] + mass * height**2) * np.cos(tilt)
    moment = inertia[2] * spin
    root = np.sqrt(moment**2 - 4 * about_tip * mass * 9.81 * height)
    rate = (moment - root) / (2 * about_tip)
    axis = np.array([np.sin(tilt), 0, np.cos(tilt)])
    turning = (spin - rate * np.cos(tilt)) * axis + np.array([0, 0, rate])
    solid.apply_transform(trimesh.transformations.rotation_matrix(tilt, [0, 1, 0]))
    scene = ds.Scene(dimension=3, friction=5.0)
    scene.add_box((0, 0, -0.5), (4, 4, 1), name="ground", fixed=True)
    scene.add_mesh(solid, name="top", density=1.0)

    off = []
    for dt in (1 / 1000, 1 / 2000):
        start = {"top": (*np.cross(turning, height * axis), *turning)}
        run = ds.simulate(scene, dt, round(seconds / dt), velocities=start)
        x, y, z = run.poses[-1, 1, :3]
        off.append(np.arctan2(y, x) / seconds / rate - 1)
        assert np.arctan2(np.hypot(x, y), z) == pytest.approx(tilt, abs=0.01)
    assert abs(off[1]) < 0.006
    assert off[0] / off[1] == pytest.approx(2, abs=0.3)


def test_a_run_says_how_many_steps_are_not_exact(tower: ds.Scene) -> None:
    run = ds.simulate(tower, steps=3, velocities={"cube2": (1, 0.3, 0, 0, 0, 1)})
    assert (run.status, run.not_exact, run.exact.shape) == ("finished", 0, (3,))
    assert run.to_dict()["steps_not_exact"] == 0
    told = dataclasses.replace(
        run,
        status="finished, 1 step not exact",
        exact=np.array([True, False, True]),
        friction_error=np.array([0, 2e-6, 0]),
    )
    assert told.finished
    assert told.not_exact == 1
    assert "1 step not exact: up to 2e-06 m/s off Coulomb's law." in str(told)
