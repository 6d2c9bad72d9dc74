"""Numbers near the ends of what a scene may hold: refused by name, or the right verdict."""

import math
from collections.abc import Callable

import pytest

import drystone as ds


def stack(dimension: int, density: float = 1.0) -> ds.Scene:
    """Two unit blocks on the ground; the lower one has this density."""
    level = (0.0,) * (dimension - 1)
    scene = ds.Scene(dimension=dimension, friction=0.5)
    scene.add_box((*level, -0.5), (1,) * dimension, fixed=True, name="ground")
    scene.add_box((*level, 0.5), (1,) * dimension, name="1", density=density)
    scene.add_box((*level, 1.5), (1,) * dimension, name="2")
    return scene


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("density", [1e308, 1e200, 1e100, 1e25, 1e-25, 1e-100, 1e-308, 1e-320])
def test_masses_near_the_ends_of_the_floats_are_refused(dimension: int, density: float) -> None:
    with pytest.raises(ds.SceneError, match=r'block "1": mass is .* kg'):
        stack(dimension, density)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_heavy_block_within_the_bounds_stands(dimension: int) -> None:
    scene = stack(dimension, 1e16)
    assert ds.check(scene).stable
    assert ds.plan(scene).status == "found"
    assert ds.simulate(scene, steps=3).status == "finished"


def slope(mu: float) -> ds.Scene:
    """Two blocks on top of each other that lean by 20 degrees, and do not tip over."""
    lean = math.radians(20)
    scene = ds.Scene(friction=mu)
    scene.add_box((0, 0), (20, 1), angle=lean, fixed=True)
    for k in range(2):
        place = (-math.sin(lean) * (1 + k), math.cos(lean) * (1 + k))
        scene.add_box(place, (1, 1), angle=lean, name=str(k + 1))
    return scene


def beside_a_wall(mu: float) -> ds.Scene:
    """A block that only touches a wall: without a normal force there is no friction."""
    scene = ds.Scene(friction=mu)
    scene.add_box((0, 0), (1, 4), fixed=True)
    scene.add_box((1, 0), (1, 1), name="1")
    return scene


FAMILIES: dict[str, tuple[Callable[[float], ds.Scene], bool]] = {
    "slope": (slope, True),
    "beside a wall": (beside_a_wall, False),
    "column": (lambda mu: ds.scenes.column(12, mu), True),
    "pyramid": (lambda mu: ds.scenes.pyramid(5, mu), True),
    "arch": (lambda mu: ds.scenes.arch(15, 0.2, mu), True),
}


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("mu", [1e3, 1e6])
@pytest.mark.parametrize("family", FAMILIES)
def test_with_great_friction_nothing_slides(family: str, mu: float, dimension: int) -> None:
    make, stands = FAMILIES[family]
    scene = make(mu) if dimension == 2 else make(mu).extruded(0.8)
    assert ds.check(scene).stable is stands
    solved = ds.check(scene, method="lcp")
    # In space the complementarity problem may end without an answer; never with a wrong one.
    assert solved.stable is stands or (dimension == 3 and solved.status != "solved")
    blocks = [body.name for body in scene.bodies if not body.fixed]
    assert ds.Structure(scene, blocks).stands() is stands
    assert (ds.plan(scene).status == "whole_falls") is not stands
    run = ds.simulate(scene, steps=10)
    assert run.status == "finished"
    assert (run.moving == ()) is stands


@pytest.mark.parametrize("mu", [1e7, 1e100, 1e308, math.inf])
def test_greater_friction_is_refused(mu: float) -> None:
    with pytest.raises(ds.SceneError, match="friction is"):
        ds.scenes.column(3, mu)
    scene = ds.Scene()
    with pytest.raises(ds.SceneError, match='block "a": friction is'):
        scene.add_box((0, 0), (1, 1), name="a", friction=mu)


def test_a_run_ends_where_a_block_leaves_the_bounds() -> None:
    scene = ds.Scene()
    scene.add_box((0, 0), (1, 1), name="thrown")
    run = ds.simulate(scene, dt=1.0, steps=9, velocities={"thrown": (4e11, 0, 0)})
    assert (run.status, len(run.pivots)) == ("out_of_bounds", 2)
    assert run.reason is not None
    assert '"thrown"' in run.reason
    for push in ({"force": (1e40, 0)}, {"force": (0, 0), "moment": 1e40}):
        with pytest.raises(ds.SimulationError, match='block "thrown": force has 1e40'):
            ds.World(scene).apply_force("thrown", **push)


def test_what_is_asked_for_is_bounded_too() -> None:
    scene = ds.scenes.column(3, 0.5)
    with pytest.raises(ds.SceneError, match="3 to 1000"):
        ds.check(scene.extruded(1.0), facets=10**9)
    with pytest.raises(ds.SimulationError, match="steps is"):
        ds.simulate(scene, steps=2**63)
    with pytest.raises(ds.SimulationError, match="dt is 1e300"):
        ds.simulate(scene, dt=1e300)
    with pytest.raises(TypeError, match="by name"):
        ds.simulate(scene, velocities=3)  # type: ignore[arg-type]
