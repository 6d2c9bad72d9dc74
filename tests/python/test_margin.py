"""How far a structure is from falling: closed forms, and verdicts on both sides."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone as ds
from conftest import Ran

Cli = Callable[..., Ran]
G = 9.81


def block(mu: float, size: tuple[float, ...] = (1.0, 1.0)) -> ds.Scene:
    if len(size) == 2:
        scene = ds.Scene(friction=mu)
        scene.add_box((0, -0.5), (9, 1), name="ground", fixed=True)
        scene.add_box((0, size[1] / 2), size, name="block")
        return scene
    scene = ds.Scene(dimension=3, friction=mu)
    scene.add_box((0, 0, -0.5), (9, 9, 1), name="ground", fixed=True)
    scene.add_box((0, 0, size[2] / 2), size, name="block")
    return scene


@pytest.mark.parametrize(("mu", "least"), [(0.5, 0.5), (2.0, 1.0)])
def test_a_block_slides_or_topples(mu: float, least: float) -> None:
    m = ds.margin(block(mu))
    assert m.status == "solved"
    assert m.acceleration == pytest.approx(least, abs=1e-12)
    assert m.tilt == pytest.approx(math.atan(least))
    assert m.boundary[:, 0] == pytest.approx((-least, least))
    assert m.friction == 0.0
    assert set(m.mechanism) == {"block"}


def test_the_weaker_side_counts() -> None:
    scene = ds.Scene(friction=5.0)
    scene.add_box((0, -0.5), (9, 1), name="ground", fixed=True)
    scene.add_polygon([(0, 0), (3, 0), (0, 3)], name="wedge")  # centroid at (1, 1)
    m = ds.margin(scene)
    assert m.acceleration == pytest.approx(1.0)
    assert m.direction == pytest.approx((-1.0, 0.0))
    assert sorted(m.boundary[:, 0]) == pytest.approx([-1.0, 2.0])


def test_round_friction_is_the_same_all_around() -> None:
    m = ds.margin(block(0.4, (1, 1, 0.2)))
    assert m.acceleration == pytest.approx(0.4, abs=1e-9)
    assert np.hypot(*m.boundary.T) == pytest.approx(0.4, abs=1e-8)
    # Between the points it is at most the tolerance outside: pi mu / n to the square, half of it.
    assert 0.4 * (1 - math.cos(math.pi / len(m.boundary))) <= 1e-3
    assert len(m.boundary) < 100


def test_a_cuboid_topples_over_its_shorter_side() -> None:
    """The accelerations that it bears are a rectangle, half-widths over half the height."""
    m = ds.margin(block(9.0, (2.0, 1.0, 4.0)))
    assert m.acceleration == pytest.approx(0.25)
    assert np.abs(m.direction) == pytest.approx((0, 1, 0), abs=1e-9)
    corners = np.abs(m.boundary).max(axis=0)
    assert corners == pytest.approx((0.5, 0.25), abs=1e-6)
    assert m.tilt == pytest.approx(math.atan(0.25))
    turned = ds.Scene(dimension=3, friction=9.0)
    turned.add_box((0, 0, -0.5), (9, 9, 1), name="ground", fixed=True)
    half = math.radians(17) / 2
    turned.add_box((0, 0, 2), (2, 1, 4), orientation=(math.cos(half), 0, 0, math.sin(half)))
    m = ds.margin(turned, tolerance=1e-6)
    assert m.acceleration == pytest.approx(0.25, abs=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_verdicts_change_at_the_boundary(seed: int) -> None:
    scene = ds.scenes.random_stack(8, seed=seed, friction=0.6).extruded(0.5)
    m = ds.margin(scene, tolerance=1e-3)
    random = np.random.default_rng(seed)
    if m.acceleration == 0.0:
        assert not ds.check(scene).stable
        return
    toward = np.asarray(m.axes)
    for angle in random.uniform(0, 2 * math.pi, 6):
        way = math.cos(angle) * toward[0] + math.sin(angle) * toward[1]
        lim = ds.limit(scene, gravity=tuple(G * way))
        assert lim.factor >= m.acceleration - 2e-3
    there = tuple(G * np.asarray(m.direction))
    assert ds.limit(scene, gravity=there).factor <= m.acceleration + 1e-6


def test_what_falls_has_no_margin_and_says_how() -> None:
    for scene in (ds.scenes.slope(20, friction=0.2), ds.scenes.slope(20, friction=0.2).extruded()):
        m = ds.margin(scene)
        assert (m.acceleration, m.tilt) == (0.0, 0.0)
        assert set(m.mechanism) == {"1"}
        assert m.forces is None
        assert m.friction == pytest.approx(math.tan(math.radians(20)) / 0.2, rel=1e-8)
        assert "falls" in str(m)


def test_friction_that_is_needed() -> None:
    """A block on a slope needs its tangent; an arch what verdicts on either side say."""
    scene = ds.scenes.slope(20, friction=0.9)
    assert ds.margin(scene).friction == pytest.approx(math.tan(math.radians(20)) / 0.9, rel=1e-8)
    arch = ds.scenes.arch(9, thickness=0.3, friction=0.7)
    least = ds.margin(arch).friction
    assert 0.0 < least < 1.0
    for step, stands in ((1e-5, True), (-1e-5, False)):
        scaled = ds.scenes.arch(9, thickness=0.3, friction=0.7 * least * (1 + step))
        assert ds.check(scaled).stable == stands
    hanging = ds.Scene(friction=0.5)
    hanging.add_box((0, 5), (1, 1))
    assert ds.margin(hanging).friction == math.inf


def test_a_tilt_with_loads_that_stay_or_turn() -> None:
    """A block with a weight P on its middle: as weights both lift the centre of mass alone; a force
    that stays square to the ground holds it: W sin h/2 = (W cos + P) b/2."""
    scene = block(9.0, (1.0, 3.0))
    weight = scene.body("block").mass * G
    scene.add_load("block", (0.0, -weight), at=(0.0, 3.0))
    turn = ds.margin(scene, loads="turn")
    # The whole weighs 2 W, at (1.5 + 3) / 2 of height.
    assert turn.acceleration == pytest.approx(0.5 / 2.25)
    assert turn.tilt == pytest.approx(math.atan(0.5 / 2.25))
    stay = ds.margin(scene)
    assert stay.acceleration == pytest.approx(2 * 0.5 / 1.5)
    assert stay.tilt is not None
    assert 1.5 * math.sin(stay.tilt) == pytest.approx(0.5 * (math.cos(stay.tilt) + 1.0))
    space = scene.extruded(1.0)
    assert ds.margin(space, loads="turn").acceleration == pytest.approx(0.5 / 2.25)
    assert ds.margin(space).tilt is None
    scene.add_load("block", (1.0, 0.0), name="wind")
    with pytest.raises(ds.SceneError, match="wind"):
        ds.margin(scene, loads="turn")


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"blocks": ["blok"]}, "block"),
        ({"tolerance": 0.0}, "tolerance"),
        ({"tolerance": math.nan}, "tolerance"),
        ({"facets": 2}, "facets"),
    ],
)
def test_what_is_wrong_is_said(wrong: dict[str, Any], says: str) -> None:
    with pytest.raises(ds.SceneError, match=says):
        ds.margin(block(0.5), **wrong)


def test_other_wrong_input() -> None:
    with pytest.raises(ValueError, match="fall"):
        ds.margin(block(0.5), loads="fall")
    with pytest.raises(ds.SceneError, match="no gravity"):
        ds.margin(block(0.5).with_gravity((0, 0)))


def test_the_command_line_and_a_picture(cli: Cli, tmp_path: Path) -> None:
    ran = cli("margin", "column:11,friction=2", "-o", tmp_path / "a.svg")
    assert (ran.status, ran.err) == (0, "")
    assert "0.1 g" in ran.out
    assert "m/s" in (tmp_path / "a.svg").read_text()
    found = json.loads(cli("margin", "column:11,friction=2", "--json").out)
    assert found["acceleration"] == pytest.approx(0.1)
    assert cli("margin", "slope:20,friction=0.1").status == 1


def test_between_which_densities_it_stands() -> None:
    """A beam that overhangs by 1.5 of its 4 m, with a counterweight on its short end and a load on
    the long one: moments about the edge of the foot. Weights are areas times densities."""
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, -0.5), (1, 1), name="foot", fixed=True)
    scene.add_box((1, 0.1), (4, 0.2), name="beam")  # from -1 to 3
    scene.add_box((-0.75, 0.45), (0.5, 0.5), name="counterweight", density=3.0)
    low, high = ds.margin(scene).density("counterweight") or (0.0, 0.0)
    beam, size = 4 * 0.2, 0.25
    # The beam turns about the right edge, x = .5, its middle is at 1: .5 beam = 1.25 w.
    assert low == pytest.approx(0.5 * beam / (1.25 * size))
    # About the left edge, x = -.5: 1.5 beam = .25 w.
    assert high == pytest.approx(1.5 * beam / (0.25 * size))
    alone = ds.scenes.column(3)
    assert ds.margin(alone).density("1") == (0.0, float("inf"))


def test_no_density_holds_what_falls_anyway() -> None:
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, -0.5), (1, 1), name="foot", fixed=True)
    scene.add_box((0, 0.5), (1, 1), name="block")
    scene.add_box((5, 5), (1, 1), name="aloft")
    assert ds.margin(scene).density("block") is None
    with pytest.raises(ds.SceneError):
        ds.margin(scene).density("blok")


def test_the_answer_is_known_better_than_the_boundary() -> None:
    """Ten courses of .5 m, .5 m thick: a tenth of g across. The boundary is within its tolerance of
    the load factors that are the answer of `limit`, and inside."""
    scene = ds.scenes.brick_wall(10, 10)
    m = ds.margin(scene, tolerance=1e-3)
    assert m.acceleration == pytest.approx(0.1, abs=1e-9)
    assert m.direction == pytest.approx((0.0, 1.0, 0.0), abs=1e-9)
    for x, y in m.boundary[:4]:
        far = float(np.hypot(x, y))
        most = ds.limit(scene, gravity=(9.81 * x / far, 9.81 * y / far, 0.0)).upper.factor
        assert -1e-8 < most - far < 1e-5


@pytest.mark.parametrize(
    ("rows", "columns", "mu"), [(3, 3, 0.7), (4, 4, 0.5), (5, 5, 0.7), (6, 6, 0.3), (8, 8, 0.7)]
)
@pytest.mark.parametrize("cone", ["round", "inscribed", "circumscribed"])
def test_walls_of_bricks_topple_across_their_thickness(
    rows: int, columns: int, mu: float, cone: Any
) -> None:
    """The wall as a whole about its front edge: half its thickness over the height of its middle.

    Bricks that lie on two halves and touch side by side bear in many ways, and pushes askew to
    the wall are where the interior-point method has the fewest digits.
    """
    size = (0.2, 0.1, 0.1)
    scene = ds.Scene(3, friction=mu)
    scene.add_box((0, 0, -0.5), (9, 9, 1), name="ground", fixed=True)
    heights = []
    for row in range(rows):
        for column in range(columns - row % 2):
            middle = (size[0] * (column + 0.5 + 0.5 * (row % 2)), 0, size[2] * (row + 0.5))
            scene.add_box(middle, size)
            heights.append(middle[2])
    m = ds.margin(scene, cone=cone, facets=16)
    assert m.status == "solved"
    assert m.acceleration == pytest.approx(0.05 / np.mean(heights), abs=1e-5)
    assert abs(m.direction[1]) == pytest.approx(1.0)
    assert len(m.mechanism) == len(heights)
