"""Permanent loads, gravity and the friction of pairs: part of the scene in every question."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone as ds


def scene_of(*, mu: float = 0.5, space: bool = False) -> ds.Scene:
    """A unit block of 1 kg on the ground."""
    if not space:
        scene = ds.Scene(friction=mu)
        scene.add_box((0, -0.5), (4, 1), name="ground", fixed=True)
        scene.add_box((0, 0.5), (1, 1), name="block")
        return scene
    scene = ds.Scene(dimension=3, friction=mu)
    scene.add_box((0, 0, -0.5), (4, 4, 1), name="ground", fixed=True)
    scene.add_box((0, 0, 0.5), (1, 1, 1), name="block")
    return scene


def ahead(x: float, space: bool) -> tuple[float, ...]:
    return (x, 0.0, 0.0) if space else (x, 0.0)


@pytest.mark.parametrize("space", [False, True])
def test_a_push_at_the_side_slides_at_mu_times_the_weight(space: bool) -> None:
    for push, stands in [(0.499, True), (0.501, False)]:
        scene = scene_of(space=space)
        scene.add_load("block", ahead(push * 9.81, space))
        assert ds.check(scene).stable == stands
        assert ds.check(scene, method="lcp").stable == stands
        assert ds.check(scene, method="interior").stable == stands


def test_a_push_at_the_top_topples_at_half_the_weight() -> None:
    """About its lower right edge: P h = W b / 2, P = .5 W with h = b = 1 at the top."""
    for push, stands in [(0.499, True), (0.501, False)]:
        scene = scene_of(mu=2.0)
        scene.add_load("block", (push * 9.81, 0.0), at=(0.3, 1.0))
        assert ds.check(scene).stable == stands
    for moment, stands in [(-0.499, True), (-0.501, False), (0.499, True), (0.501, False)]:
        scene = scene_of(mu=2.0)
        scene.add_load("block", moment=moment * 9.81)
        assert ds.check(scene).stable == stands


def test_forces_carry_the_load() -> None:
    scene = scene_of(space=True)
    scene.add_load("block", (1.0, -2.0, -30.0))
    verdict = ds.check(scene)
    sums = np.sum([force.force for force in verdict.forces], axis=0)
    assert sums == pytest.approx((-1.0, 2.0, 39.81))


def test_a_load_on_a_light_block_is_its_own_load() -> None:
    """1e6 times the weight: what rounding leaves of it is no fall, and its fall is no rounding."""
    for push, stands in [((0.49e7, -1e7), True), ((0.51e7, -1e7), False)]:
        scene = scene_of()
        scene.add_load("block", push, at=(0.0, 0.1))
        assert ds.check(scene).stable == stands


def test_without_gravity_loads_are_all_there_is() -> None:
    scene = scene_of().with_gravity((0, 0))
    scene.add_load("block", (1e-3, -1.0))
    assert ds.check(scene).stable
    scene.add_load("block", (0.0, 2.0))
    assert ds.check(scene).falling == ("block",)
    assert ds.check(scene).acceleration("block") == pytest.approx((1e-3, 1.0, 0.0))


def test_the_first_motion_is_that_of_the_load() -> None:
    scene = scene_of(mu=0.0)
    scene.add_load("block", (3.0, 0.0))
    for method in ("equilibrium", "lcp", "interior"):
        assert ds.check(scene, method=method).acceleration("block") == pytest.approx((3, 0, 0))
    assert ds.check(scene).acceleration("block")[0] == pytest.approx(3.0 / scene.body("block").mass)


def test_plans_and_structures_know_loads() -> None:
    """A cantilever that only a weight on its tail holds; with the weight too far out it falls."""
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, -0.5), (1, 1), name="ground", fixed=True)
    scene.add_box((0.6, 0.1), (2, 0.2), name="beam")
    assert not ds.check(scene).stable
    scene.add_load("beam", (0.0, -5.0), at=(-0.4, 0.2), name="weight")
    assert ds.check(scene).stable
    structure = ds.Structure(scene, ["beam"])
    assert structure.stands() is True
    assert ds.plan(scene).order == ("beam",)
    scene.add_load("beam", (0.0, -5.0), at=(1.5, 0.2))
    assert not ds.check(scene).stable
    assert not ds.plan(scene).found


@pytest.mark.parametrize("space", [False, True])
def test_a_simulation_moves_as_the_load_says(space: bool) -> None:
    scene = scene_of(mu=0.0, space=space)
    scene.add_load("block", ahead(3.0, space))
    run = ds.simulate(scene, steps=24, dt=1 / 240)
    assert run.velocities[-1][1][0] == pytest.approx(0.3)
    held = scene_of(mu=0.5, space=space)
    held.add_load("block", ahead(3.0, space))
    run = ds.simulate(held, steps=24, dt=1 / 240)
    assert run.motionless.all()


def test_the_point_of_a_load_goes_with_the_body() -> None:
    """Free flight without gravity: a force at a point of the body, fixed in direction, turns it as
    theta'' = -d F cos(theta) / I, a pendulum about the direction of the force."""
    scene = ds.Scene(gravity=(0, 0))
    scene.add_box((0, 0), (1, 1), name="b")
    scene.add_load("b", (0.0, -1.0), at=(0.4, 0.0))
    world = ds.World(scene, dt=1e-3)
    for _ in range(1500):
        world.step()
    inertia = scene.body("b").inertia
    angle, rate, h = 0.0, 0.0, 1e-4
    for _ in range(15000):
        rate -= h * 0.4 * math.cos(angle) / inertia
        angle += h * rate
    assert world.poses[0][2] == pytest.approx(angle, abs=5e-3)
    assert world.scene.loads[0].at == pytest.approx(
        world.poses[0][:2]
        + 0.4 * np.array([math.cos(world.poses[0][2]), math.sin(world.poses[0][2])])
    )
    again = ds.World.restore(world.snapshot())
    world.step(), again.step()
    assert np.array_equal(world.poses, again.poses)


def test_pressure_acts_on_the_face_that_looks_there() -> None:
    scene = ds.Scene()
    scene.add_polygon([(0, 0), (4, 0), (4, 3)], name="wedge")
    scene.add_pressure("wedge", (-1, 1), 10.0)
    (load,) = scene.loads
    assert load.force == pytest.approx((30.0, -40.0))  # 10 N/m on 5 m, square to the slope
    assert load.at == pytest.approx((2.0, 1.5))
    with pytest.raises(ds.SceneError, match="no one face looks"):
        scene.add_pressure("wedge", (-1.0, -1.0), 1.0)
    space = scene_of(space=True)
    space.add_pressure("block", (0.1, 0, 1), 7.0, name="snow")
    assert space.loads[0].force == pytest.approx((0, 0, -7.0))
    assert space.loads[0].at == pytest.approx((0, 0, 1.0))
    turned = ds.Scene(dimension=3)
    half = math.sqrt(0.5)
    turned.add_solid(
        [
            [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)],
            [(x, y, z) for x in (1, 3) for y in (0, 1) for z in (0, 1)],
        ],
        name="bar",
        orientation=(half, 0, 0, half),
    )
    turned.add_pressure("bar", (0, 0, 1), 2.0)
    assert turned.loads[0].force == pytest.approx((0, 0, -6.0))
    assert turned.loads[0].at == pytest.approx((-0.5, 1.5, 1.0))
    turned.add_pressure("bar", (0, 1, 0), 2.0)  # the outer end, not the joint of the pieces
    assert turned.loads[1].at == pytest.approx((-0.5, 3.0, 0.5))
    with pytest.raises(ds.SceneError, match="no one face looks"):
        turned.add_pressure("bar", (0, 1, 1), 2.0)


def test_the_friction_of_a_pair_goes_before_that_of_the_bodies() -> None:
    scene = ds.scenes.slope(20, friction=0.5)
    scene.set_friction("1", "plane", 0.3)
    assert {contact.friction for contact in scene.contacts} == {0.3}
    assert not ds.check(scene).stable
    scene.set_friction("plane", "1", 0.9)
    assert scene.pair_friction == {("plane", "1"): 0.9}
    assert ds.check(scene).stable
    again = ds.Scene.from_json(scene.to_json())
    assert again.pair_friction == scene.pair_friction


def loaded(space: bool) -> ds.Scene:
    scene = scene_of(space=space)
    scene.add_load("block", ahead(1.0, space), at=ahead(0.1, space), name="wind")
    scene.add_load("block", moment=(0.1, 0.2, 0.3) if space else 0.3)
    scene.set_friction("block", "ground", 0.7)
    return scene


@pytest.mark.parametrize("space", [False, True])
def test_files_keep_loads_bit_for_bit(space: bool, tmp_path: Path) -> None:
    scene = loaded(space)
    scene.save(tmp_path / "scene.json")
    again = ds.Scene.load(tmp_path / "scene.json")
    assert again.loads == scene.loads
    assert again.to_json() == scene.to_json()
    assert json.loads(scene.to_json())["version"] == 2
    assert json.loads(scene_of().to_json())["version"] == 1
    assert "2 loads" in repr(scene)


def test_a_file_gives_the_point_in_the_frame_of_the_shape() -> None:
    text = """{"format": "drystone-scene", "version": 2, "dimension": 2, "gravity": [0, -9.81],
    "friction": 0.5, "bodies": [{"name": "a", "position": [5, 0], "angle": 1.5707963267948966,
    "polygon": {"vertices": [[0, 0], [2, 0], [2, 1], [0, 1]]},
    "loads": [{"force": [0, -1], "at": [2, 0]}, {"force": [1, 0]}]}]}"""
    first, second = ds.Scene.from_json(text).loads
    assert first.at == pytest.approx((5, 2))
    assert second.at == pytest.approx((4.5, 1.0))
    assert (first.name, second.name) == ("load 1", "load 2")


def test_a_scene_with_a_thickness_keeps_its_loads() -> None:
    flat = ds.Scene(friction=2.0)
    flat.add_box((0, -0.5), (4, 1), name="ground", fixed=True)
    flat.add_box((0, 0.5), (1, 1), name="block")
    for moment, stands in [(-4.8, True), (-5.0, False), (4.8, True), (5.0, False)]:
        scene = flat.with_gravity(flat.gravity)
        scene.add_load("block", moment=moment)
        assert ds.check(scene).stable == stands
        assert ds.check(scene.extruded(1.0)).stable == stands


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        (lambda s: s.add_load("blok", (1, 0)), 'did you mean "block"'),
        (lambda s: s.add_load("block", (1, 0, 0)), "two numbers"),
        (lambda s: s.add_load("block", (math.nan, 0)), "finite"),
        (lambda s: s.add_load("block", (1e99, 0)), "must be from"),
        (lambda s: s.add_load("block", (1, 0), at=(0, math.inf)), "finite"),
        (lambda s: s.add_load("block", (1, 0), name=""), "empty"),
        (lambda s: [s.add_load("block", (1, 0), name="x") for _ in "ab"], "must differ"),
        (lambda s: s.add_pressure("block", (0, 0), 1), "no one face"),
        (lambda s: s.add_pressure("block", (0, math.nan), 1), "finite"),
        (lambda s: s.add_pressure("block", (0, 1), math.nan), "finite"),
        (lambda s: s.set_friction("block", "block", 0.5), "twice"),
        (lambda s: s.set_friction("block", "ground", -1), "zero"),
        (lambda s: s.set_friction("block", "ground", math.nan), "finite"),
        (lambda s: s.set_friction("block", "grund", 0.5), "ground"),
        (lambda s: s.with_gravity((0, 0, -1)), "two numbers"),
        (lambda s: s.with_gravity((0, math.nan)), "finite"),
    ],
)
def test_what_is_wrong_is_said_and_nothing_changes(wrong: Any, says: str) -> None:
    scene = scene_of()
    before = scene.to_json()
    with pytest.raises(ds.SceneError, match=says):
        wrong(scene)
    assert says == "must differ" or scene.to_json() == before


@pytest.mark.parametrize(
    ("loads", "says"),
    [
        ("7", "a list of loads"),
        ('[{"force": [1]}]', "two numbers"),
        ('[{"force": [1, 0], "moment": [1, 2, 3]}]', "a number"),
        ('[{"push": [1, 0]}]', "unknown field"),
        ('[{"name": "", "force": [1, 0]}]', "empty"),
    ],
)
def test_wrong_loads_in_files_are_named(loads: str, says: str) -> None:
    text = scene_of().to_json().replace('"fixed":false', f'"fixed":false,"loads":{loads}')
    with pytest.raises(ds.SceneError, match=says):
        ds.Scene.from_json(text)


@pytest.mark.parametrize("space", [False, True])
def test_pictures_show_loads(space: bool) -> None:
    from drystone import pictures

    scene = loaded(space)
    for figure in (pictures.scene_figure(scene), pictures.verdict_figure(ds.check(scene))):
        assert "N load" in pictures.svg(figure)
        assert "N m" in pictures.svg(figure)
    assert "wind" in scene.view().html()
