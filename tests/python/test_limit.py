"""How much of a push a structure bears: closed forms, linear programs, verdicts on both sides."""

from __future__ import annotations

import copy
import json
import math
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone as ds
from conftest import Ran
from limit_programs import Standing, factors, push_of
from published_walls import PUBLISHED, published_wall

Cli = Callable[..., Ran]

G = 9.81


def block(mu: float, *, height: float = 1.0, space: bool = False) -> ds.Scene:
    """A block of width 1 on the ground."""
    if space:
        scene = ds.Scene(dimension=3, friction=mu)
        scene.add_box((0, 0, -0.5), (4, 4, 1), name="ground", fixed=True)
        scene.add_box((0, 0, height / 2), (1, 1, height), name="block")
        return scene
    scene = ds.Scene(friction=mu)
    scene.add_box((0, -0.5), (4, 1), name="ground", fixed=True)
    scene.add_box((0, height / 2), (1, height), name="block")
    return scene


@pytest.mark.parametrize(("mu", "factor", "turns"), [(0.5, 0.5, 0.0), (2.0, 1.0, -1.0)])
def test_a_block_slides_at_mu_or_topples_at_width_over_height(
    mu: float, factor: float, turns: float
) -> None:
    lim = ds.limit(block(mu), gravity=(G, 0))
    assert lim.status == "solved"
    assert lim.bounds == pytest.approx((-factor, factor), abs=1e-12)
    (motion,) = lim.mechanism.values()
    assert np.sign(round(motion[2], 9)) == turns
    if turns:  # about its lower right corner, the centre of mass at 1 m/s
        assert motion == pytest.approx(np.array([0.5, 0.5, -1.0]) / math.sqrt(0.5))
    else:  # along the edge of the cone: it opens by the angle of friction
        assert motion[1] / motion[0] == pytest.approx(mu)


def test_a_column_pushed_at_its_top_overturns_when_moments_balance() -> None:
    """P h = W b / 2 about the lower right corner."""
    scene = block(1.0, height=4.0)
    weight = scene.body("block").mass * G
    # At the centroid, and lifted to the top by a moment of P (h - h / 2).
    lim = ds.limit(scene, push={"block": (1.0, 0.0, -2.0)})
    assert lim.factor == pytest.approx(weight * 0.5 / 4.0)
    assert -lim.bounds[0] == pytest.approx(lim.factor)


def test_published_and_known_factors() -> None:
    tower = ds.scenes.column(11, friction=2.0)
    assert ds.limit(tower, gravity=(G, 0)).factor == pytest.approx(0.1, abs=1e-12)
    arch = ds.scenes.arch(20, thickness=0.2, friction=0.7)
    assert ds.limit(arch, gravity=(G, 0)).factor == pytest.approx(0.285646, abs=5e-7)
    wall = ds.scenes.wall(10, 10, friction=0.5)
    assert ds.limit(wall, gravity=(G, 0)).factor == pytest.approx(0.495746, abs=5e-7)


@pytest.mark.parametrize("wall", range(1, 7))
def test_the_walls_of_ferris_and_tin_loi(wall: int) -> None:
    """Associated flow: what was published, and HiGHS on the same cones."""
    scene = published_wall(wall)
    lim = ds.limit(scene, gravity=(G, 0))
    if wall in PUBLISHED:
        assert lim.factor == pytest.approx(PUBLISHED[wall], abs=5e-3)
    assert lim.bounds == pytest.approx(factors(scene, push_of(scene, (G, 0))), abs=1e-7)


@pytest.mark.parametrize("mu", [0.0, 0.2, 0.6])
def test_a_block_on_a_slope_slides_when_the_angle_is_that_of_friction(mu: float) -> None:
    """Gravity (-t, -1) g on level ground is a slope of angle atan t."""
    lim = ds.limit(block(mu, height=0.5), gravity=(G, 0))
    assert lim.bounds == pytest.approx((-mu, mu), abs=1e-12)


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.0, 2.5])
def test_round_cones_slide_alike_in_every_direction(angle: float) -> None:
    pull = (G * math.cos(angle), G * math.sin(angle), 0.0)
    scene = block(0.4, height=0.2, space=True)
    lim = ds.limit(scene, gravity=pull)
    assert lim.bounds == pytest.approx((-0.4, 0.4), abs=1e-9)
    assert lim.mechanism["block"][:2] == pytest.approx(
        np.array(pull[:2]) / G * np.hypot(*lim.mechanism["block"][:2]), abs=1e-6
    )
    inner = ds.limit(scene, gravity=pull, cone="inscribed", facets=16).factor
    outer = ds.limit(scene, gravity=pull, cone="circumscribed", facets=16).factor
    assert inner <= 0.4 + 1e-12 <= outer + 2e-12
    assert outer <= inner / math.cos(math.pi / 16) ** 2 + 1e-12


def test_a_twist_about_the_normal_is_held_by_friction_at_the_corners() -> None:
    """Four corners bear a quarter of the weight each, at sqrt(1/2) from the axis."""
    scene = block(0.4, height=0.2, space=True)
    lim = ds.limit(scene, push={"block": (0, 0, 0, 0, 0, 1.0)})
    assert lim.factor == pytest.approx(0.4 * 0.2 * G * math.sqrt(0.5))


def test_nothing_limits_a_push_that_the_ground_bears() -> None:
    for space in (False, True):
        down = (0.0, 0.0, -1.0) if space else (0.0, -1.0)
        lim = ds.limit(block(0.5, space=space), push={"block": down})
        assert lim.factor == math.inf
        assert lim.bounds[0] == pytest.approx(-G)
        assert lim.mechanism == {}
        assert lim.forces is None
        assert "nothing limits" in str(lim)
        assert json.dumps(lim.to_dict(), allow_nan=False)
        # Within the cone of friction too, on its edge, and beyond it.
        for share, most in [(0.49, math.inf), (0.51, 0.5 * G / 0.01)]:
            sideways = (share, 0.0, -1.0) if space else (share, -1.0)
            found = ds.limit(block(0.5, space=space), push={"block": sideways})
            assert found.factor == pytest.approx(most)


def test_what_falls_may_stand_under_a_push_or_under_none() -> None:
    slope = ds.scenes.slope(20, friction=0.2)
    lim = ds.limit(slope, gravity=(G, 0))
    # Down the slope at tan 20 - .2, up it at + .2, in terms of the turned gravity.
    angles = [math.tan(math.radians(20) - sign * math.atan(0.2)) for sign in (1, -1)]
    assert lim.bounds == pytest.approx(tuple(angles))
    scene = block(0.5)
    scene.add_box((3.0, 5.0), (1, 1), name="floating")
    lim = ds.limit(scene, gravity=(G, 0))
    assert lim.status == "no_solution"
    assert math.isnan(lim.factor)
    assert set(lim.mechanism) == {"floating"}
    assert "falls" in str(lim)
    held = ds.limit(scene, push={"floating": (0, 1)})
    assert held.bounds == pytest.approx((G, G))
    assert ds.limit(scene, gravity=(G, 0), blocks=["block"]).factor == pytest.approx(0.5)


def test_forces_and_mechanism_prove_the_factor() -> None:
    """By the public numbers alone: balance of every block, and Coulomb's law; contacts that do not
    close, and loads that do no work."""
    scene = ds.scenes.wall(6, 4, friction=0.5)
    lim = ds.limit(scene, gravity=(G, 0))
    t = lim.factor
    left = {b.name: np.array([t * G * b.mass, -G * b.mass, 0.0]) for b in scene.bodies}
    center = {b.name: np.array(b.center_of_mass) for b in scene.bodies}
    assert lim.forces is not None
    for force in lim.forces:
        assert abs(force.tangential_force) <= 0.5 * force.normal_force + 1e-9
        for name, sign in ((force.a, -1.0), (force.b, 1.0)):
            (x, y), (rx, ry) = force.force, np.array(force.point) - center[name]
            left[name] += sign * np.array([x, y, rx * y - ry * x])
    movable = [b for b in scene.bodies if not b.fixed]
    assert max(np.abs(left[b.name]).max() / (G * b.mass) for b in movable) < 1e-11
    velocity = {b.name: lim.mechanism.get(b.name, np.zeros(3)) for b in scene.bodies}

    def at(name: str, point: tuple[float, ...]) -> np.ndarray:
        (x, y, w), r = velocity[name], np.array(point) - center[name]
        return np.array([x - w * r[1], y + w * r[0]])

    for contact in scene.contacts:
        apart = at(contact.b, contact.point) - at(contact.a, contact.point)
        normal = np.array(contact.normal)
        along = apart @ np.array([-normal[1], normal[0]])
        assert apart @ normal >= 0.5 * abs(along) - 1e-11
    work = sum(b.mass * G * (t * velocity[b.name][0] - velocity[b.name][1]) for b in movable)
    assert work == pytest.approx(0.0, abs=1e-11 * sum(b.mass * G for b in movable))
    assert lim.upper.bound == pytest.approx(t, rel=1e-12)


def stack(
    seed: int, *, space: bool = False
) -> tuple[ds.Scene, tuple[float, ...], np.random.Generator]:
    random = np.random.default_rng(seed)
    mu = float(random.choice([0.0, 0.3, 0.6, 1.5]))
    scene = ds.scenes.random_stack(int(random.integers(4, 14)), seed=seed, friction=mu)
    angle = random.uniform(0, 2 * math.pi)
    pull: tuple[float, ...] = (G * math.cos(angle), G * math.sin(angle))
    if space:
        scene = scene.extruded(1.0)
        pull = (pull[0], float(random.uniform(-3, 3)), pull[1])
    return scene, pull, random


def loaded(scene: ds.Scene, t: float, pull: tuple[float, ...]) -> ds.Scene:
    """By loads and not by gravity, which would turn the edges of pyramids."""
    more = copy.copy(scene)
    for body in scene.bodies:
        more.add_load(body.name, t * body.mass * np.asarray(pull), at=body.center_of_mass)
    return more


@pytest.mark.parametrize("seed", range(12))
def test_random_structures_against_a_linear_program_and_verdicts(seed: int) -> None:
    space = seed % 3 == 2
    scene, pull, random = stack(seed, space=space)
    options: dict[str, Any] = {"cone": "inscribed", "facets": 6} if space else {}
    if seed % 2:  # of the loads too
        names = [body.name for body in scene.bodies if not body.fixed]
        force = random.uniform(-0.2, 0.2, scene.dimension)
        scene.add_load(str(random.choice(names)), tuple(force * G))
    lim = ds.limit(scene, gravity=pull, **options)
    least, most = factors(scene, push_of(scene, pull), (6, "inscribed") if space else None)
    if math.isnan(most):
        assert lim.status == "no_solution"
        return
    assert lim.status == "solved"
    assert lim.bounds == pytest.approx((least, most), rel=1e-7, abs=1e-7)
    for end, sign in ((most, 1.0), (least, -1.0)):
        for step, stands in ((-1e-6, True), (1e-6, False)):
            if math.isinf(end) or lim.bounds[1] - lim.bounds[0] < 1e-5:
                continue
            t = end + sign * step
            assert ds.check(loaded(scene, t, pull), **options).stable == stands


@pytest.mark.parametrize("seed", range(4))
def test_verdicts_under_gravity_in_all_directions_beside_a_linear_program(seed: int) -> None:
    scene = ds.scenes.random_stack(4 + 2 * seed, seed=seed, friction=0.3 + 0.2 * seed)
    program, random = Standing(scene), np.random.default_rng(seed)
    angles = -0.5 * math.pi + random.normal(0.0, 0.4, 50)
    directions = [(G * math.cos(angle), G * math.sin(angle)) for angle in angles]
    verdicts = [ds.check(scene.with_gravity(gravity)).stable for gravity in directions]
    assert verdicts == [program.stands(gravity) for gravity in directions]
    assert 0 < sum(verdicts) < len(verdicts)


def test_pivots_and_the_interior_point_find_the_same() -> None:
    """Few blocks go by pivots, many by the interior-point method: across the border."""
    for rows in (3, 5, 8):
        scene = ds.scenes.wall(rows, 4, friction=0.4)
        scene.add_load("1", (3.0, -2.0))
        lim = ds.limit(scene, gravity=(G, 0))
        structure = ds.Structure(scene, lim.names)
        assert structure.limit(gravity=(G, 0)).bounds == pytest.approx(lim.bounds, rel=1e-10)
        extruded = ds.limit(scene.extruded(0.5), gravity=(G, 0, 0))
        assert extruded.bounds == pytest.approx(lim.bounds, rel=1e-8)


def test_a_structure_answers_from_what_it_has() -> None:
    scene = ds.scenes.wall(6, 5, friction=0.5)
    names = [body.name for body in scene.bodies if not body.fixed]
    structure = ds.Structure(scene, names[:-1])
    top = names[-2]
    for push in ({top: (1.0, 0.0)}, {top: (1.0, 0.0, 0.3)}, {names[0]: (0.0, 1.0)}):
        alone = ds.limit(scene, push=push, blocks=names[:-1])
        assert structure.limit(push=push).bounds == pytest.approx(alone.bounds, rel=1e-9)
    twin = copy.copy(structure)
    before = structure.check()
    assert structure.check().forces == before.forces  # the question has changed nothing
    twin.add(names[-1])
    assert twin.limit(push={names[-1]: (1.0, 0.0)}).status == "solved"
    with pytest.raises(ds.SceneError, match="not among the blocks"):
        structure.limit(push={names[-1]: (1.0, 0.0)})


def test_the_answer_is_the_same_to_the_bit_and_goes_through_pickle() -> None:
    scene = ds.scenes.wall(8, 6, friction=0.5)
    one, two = (ds.limit(scene, gravity=(G, 0)) for _ in "ab")
    again = pickle.loads(pickle.dumps(one))
    for other in (two, again, copy.copy(one)):
        assert other.bounds == one.bounds
        assert other.forces == one.forces
        assert all(np.array_equal(other.mechanism[k], v) for k, v in one.mechanism.items())


def test_units_and_places_change_nothing() -> None:
    """The same wall a million times larger or smaller, and at map coordinates."""
    reference = None
    for size, (x, y) in ((1.0, (0, 0)), (1e-6, (0, 0)), (1e6, (0, 0)), (1.0, (4e6, 5e6))):
        scene = ds.Scene(friction=0.6)
        scene.add_box((x, y - 0.5 * size), (9 * size, size), name="ground", fixed=True)
        for row in range(4):
            for k in range(3):
                left = x + size * (k - 1.5 + 0.5 * (row % 2))
                scene.add_box((left, y + size * (row + 0.5)), (size, size))
        factor = ds.limit(scene, gravity=(G, 0)).factor
        reference = reference or factor
        assert factor == pytest.approx(reference, rel=1e-6)


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({}, "give push= .* or gravity="),
        ({"push": {"blok": (1, 0)}}, 'did you mean "block"'),
        ({"push": {"ground": (1, 0)}}, "fixed"),
        ({"push": {"block": (1,)}}, "2 numbers of force"),
        ({"push": {"block": (1, 0, 0, 0)}}, "2 numbers of force"),
        ({"push": {"block": (math.nan, 0)}}, "finite"),
        ({"push": {"block": (1e99, 0)}}, "must be from"),
        ({"gravity": (1, 0, 0)}, "two numbers"),
        ({"gravity": (math.inf, 0)}, "finite"),
        ({"gravity": (1, 0), "blocks": ["blok"]}, "block"),
        ({"gravity": (1, 0), "facets": 2}, "facets"),
    ],
)
def test_what_is_wrong_is_said(wrong: dict[str, Any], says: str) -> None:
    with pytest.raises(ds.SceneError, match=says):
        ds.limit(block(0.5), **wrong)


def test_an_unknown_cone_is_a_value_error() -> None:
    with pytest.raises(ValueError, match="both"):
        ds.limit(block(0.5), gravity=(1, 0), cone="both")


def test_a_push_of_nothing_has_no_limit() -> None:
    assert ds.limit(block(0.5), gravity=(0, 0)).bounds == (-math.inf, math.inf)
    empty = ds.Scene()
    empty.add_box((0, 0), (1, 1), fixed=True)
    assert ds.limit(empty, gravity=(1, 0)).bounds == (-math.inf, math.inf)


def test_pictures_and_the_command_line(cli: Cli, tmp_path: Path) -> None:
    for space in (False, True):
        lim = ds.limit(block(2.0, space=space), push={"block": (1.0, *(0.0,) * (1 + space))})
        lim.draw(tmp_path / "limit.svg")
        assert "N load" in (tmp_path / "limit.svg").read_text()
        assert "m/s" in lim._repr_svg_()
    ds.limit(block(0.5), push={"block": (0, -1)}).draw(tmp_path / "unlimited.svg")
    ran = cli("limit", "column:11,friction=2", "--gravity", "9.81,0", "-o", tmp_path / "a.svg")
    assert ran.status == 0
    assert "-0.1 to 0.1" in ran.out
    assert (tmp_path / "a.svg").exists()
    ran = cli("limit", "column:3,friction=1", "--push", "2:1,0", "--json")
    assert ran.status == 0
    assert json.loads(ran.out)["factor"] == pytest.approx(G * 2 / 3)
    assert "give --push" in cli("limit", "column:3").err
    assert cli("limit", "column:3", "--push", "2=1,0").status == 2
    assert cli("limit", "column:3", "--push", "2:1,x").status == 2
    assert cli("limit", "column:3", "--push", "7:1,0").status == 2
    assert cli("limit", "column:3").status == 2
    assert cli("limit", "column:3", "--gravity", "1,0", "--blocks", "2").status == 1


@pytest.mark.parametrize("mu", [0.3, 0.5, 0.7])
@pytest.mark.parametrize(("rows", "columns"), [(3, 3), (3, 4), (5, 5), (6, 6)])
def test_a_push_askew_to_a_wall_of_bricks_has_an_answer(rows: int, columns: int, mu: float) -> None:
    """Many contacts are at the border of their round cones at once there. The answer is proved on
    both sides, and between those of pyramids."""
    size = (0.2, 0.1, 0.1)
    scene = ds.Scene(3, friction=mu)
    scene.add_box((0, 0, -0.5), (9, 9, 1), name="ground", fixed=True)
    for row in range(rows):
        for column in range(columns - row % 2):
            middle = (size[0] * (column + 0.5 + 0.5 * (row % 2)), 0, size[2] * (row + 0.5))
            scene.add_box(middle, size, density=2400)
    for angle in (0.1, 0.26, 4.0, 5.74):
        gravity = (G * math.cos(angle), G * math.sin(angle), 0.0)
        found = ds.limit(scene, gravity=gravity)
        assert found.status == "solved"
        within, around = (
            ds.limit(scene, gravity=gravity, cone=cone, facets=32).bounds
            for cone in ("inscribed", "circumscribed")
        )
        assert around[0] - 1e-6 < found.bounds[0] < within[0] + 1e-6
        assert within[1] - 1e-6 < found.bounds[1] < around[1] + 1e-6
        for end in (found.lower, found.upper):
            assert abs(end.bound - end.factor) <= 1e-8
            assert end.imbalance <= 1e-7
            assert end.closing <= 1e-9
