"""Scenes in space: what users type, and what must follow from analysis."""

from __future__ import annotations

import math
import pickle
from pathlib import Path

import numpy as np
import pytest

import drystone as ds
from drystone import statics

CUBE = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]


def moved(i: float, k: float) -> list[tuple[float, float, float]]:
    """The unit cube, moved along x and z."""
    return [(x + i, y, z + k) for x, y, z in CUBE]


def turned(axis: tuple[float, float, float], degrees: float) -> tuple[float, float, float, float]:
    """The quaternion of a turn about an axis of length one."""
    half = math.radians(degrees) / 2
    x, y, z = (math.sin(half) * a for a in axis)
    return (math.cos(half), x, y, z)


def slope(degrees: float, friction: float, facing: float = 0.0) -> ds.Scene:
    """A box on a slope that looks where `facing` (degrees about z) says."""
    axis = (math.sin(math.radians(facing)), math.cos(math.radians(facing)), 0.0)
    orientation = turned(axis, degrees)
    scene = ds.Scene(dimension=3, friction=friction)
    normal = np.array(
        [
            math.sin(math.radians(degrees)) * axis[1],
            -math.sin(math.radians(degrees)) * axis[0],
            math.cos(math.radians(degrees)),
        ]
    )
    below, above = tuple(-0.5 * normal), tuple(0.25 * normal)
    scene.add_box(below, (4, 4, 1), name="slope", fixed=True, orientation=orientation)
    scene.add_box(above, (1, 1, 0.5), name="box", orientation=orientation)
    return scene


def test_a_block_slides_beyond_the_angle_of_friction() -> None:
    for facing in (0.0, 17.0, 111.0):
        assert ds.check(slope(39, 0.84, facing), cone="both").stable
        falls = ds.check(slope(41, 0.84, facing), cone="both")
        assert (falls.stable, falls.falling) == (False, ("box",))


def test_circumscribed_cones_never_let_fall_what_stands() -> None:
    # tan 42 degrees is 0.9004, beyond 0.84, and within the four-sided pyramid around its cone.
    scene = slope(42, 0.84)
    inner = ds.check(scene, facets=4, cone="inscribed")
    outer = ds.check(scene, facets=4, cone="circumscribed")
    both = ds.check(scene, facets=4, cone="both")
    assert (inner.stable, outer.stable, both.stable) == (False, True, False)
    assert not inner.certain
    assert not outer.certain
    assert not both.certain
    assert "undecided" in str(both)
    # More facets tell them apart.
    assert ds.check(scene, facets=16, cone="both").certain


def test_round_cones_slide_at_the_angle_of_friction_whichever_way_the_slope_looks() -> None:
    for friction in (0.1, 0.84, 1.9):
        limit = math.degrees(math.atan(friction))
        for facing in (0.0, 17.0, 22.5, 111.0):
            below = ds.check(slope(limit - 1e-5, friction, facing))
            above = ds.check(slope(limit + 1e-5, friction, facing))
            assert (below.status, below.stable, below.certain) == ("solved", True, True)
            assert (above.status, above.stable, above.certain) == ("solved", False, True)


def test_frictionless_and_planar_verdicts_are_certain() -> None:
    assert ds.check(ds.scenes.square_pyramid(3)).certain
    assert ds.check(slope(5, 0.0)).certain
    assert ds.check(ds.scenes.slope(60.0)).certain


def test_a_solid_of_pieces_has_their_mass_and_centre() -> None:
    scene = ds.Scene(dimension=3)
    cube = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    scene.add_solid(
        [cube, [(x + 1, y, z) for x, y, z in cube], [(x, y, z + 1) for x, y, z in cube]]
    )
    body = scene.bodies[0]
    assert body.mass == pytest.approx(3.0)
    assert body.position == pytest.approx((5 / 6, 1 / 2, 5 / 6))
    # Steiner: three unit cubes at (1/2, 1/2), (3/2, 1/2), (1/2, 3/2) in x and z.
    about_y = 3 / 6 + sum(
        (x - 5 / 6) ** 2 + (z - 5 / 6) ** 2 for x, z in ((0.5, 0.5), (1.5, 0.5), (0.5, 1.5))
    )
    assert body.inertia[1, 1] == pytest.approx(about_y)
    assert len(body.pieces) == 3
    assert len(body.pieces[0].faces) == 6


def test_an_l_stands_on_its_foot_and_a_gamma_falls() -> None:
    for places, stands in [
        ([(0, 0), (1, 0), (0, 1)], True),
        ([(0, 0), (0, 1), (1, 1), (2, 1), (3, 1)], False),
    ]:
        scene = ds.Scene(dimension=3)
        scene.add_box((0, 0, -0.5), (9, 9, 1), name="ground", fixed=True)
        scene.add_solid([moved(*place) for place in places], name="body")
        assert ds.check(scene).stable is stands


def test_faces_of_pieces_are_one_polygon() -> None:
    scene = ds.Scene(dimension=3)
    scene.add_box((0, 0, -0.5), (9, 9, 1), name="ground", fixed=True)
    scene.add_solid([moved(0, 0), moved(1, 0)])
    # The corners between the two pieces lie within the edge of the whole.
    points = sorted(contact.point for contact in scene.contacts)
    assert np.allclose(points, [(0, 0, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)], rtol=0, atol=1e-15)


@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_every_stability_test_plans_the_same_order(friction: float) -> None:
    for scene in (
        ds.scenes.random_stack(9, seed=3, friction=friction).extruded(0.6),
        ds.scenes.square_pyramid(2, friction=friction),
        ds.scenes.brick_wall(2, 3, friction=friction),
    ):
        plans = [
            ds.plan(scene, test) for test in ("reuse", "reuse-dantzig", "lcp", "lp", "lp-warm")
        ]
        assert {plan.status for plan in plans} == {"found"}
        assert len({plan.order for plan in plans}) == 1


def test_reuse_equals_fresh_and_highs_on_random_walks() -> None:
    random = np.random.default_rng(5)
    for seed in range(6):
        scene = ds.scenes.random_stack(10, seed=seed, friction=0.3).extruded(0.5)
        structure = ds.Structure(scene)
        names = [body.name for body in scene.bodies if not body.fixed]
        program = statics.ColdProgram(statics.Equilibrium.of(scene))
        present: set[str] = set()
        for _ in range(40):
            name = names[random.integers(len(names))]
            if name in present:
                structure.remove(name)
            else:
                structure.add(name)
            present ^= {name}
            if not present:
                continue
            stands, _ = program(sorted(names.index(one) for one in present), names.index(name))
            fresh = ds.check(scene, present)
            assert structure.stands() == fresh.stable == stands
            assert fresh.residual <= 1e-9
            assert structure.check().residual <= 1e-9


def test_forces_balance_every_block() -> None:
    scene = ds.scenes.brick_wall(4, 4)
    verdict = ds.check(scene)
    assert verdict.stable
    for body in scene.bodies:
        if body.fixed:
            continue
        force = np.array([0.0, 0.0, -9.81 * body.mass])
        moment = np.zeros(3)
        for contact in verdict.forces:
            sign = {contact.b: 1.0, contact.a: -1.0}.get(body.name, 0.0)
            push = sign * np.array(contact.force)
            force += push
            moment += np.cross(np.array(contact.point) - body.centroid, push)
            assert contact.tangential_force <= 0.6 * contact.normal_force + 1e-9
        assert np.abs(force).max() < 1e-9
        assert np.abs(moment).max() < 1e-9


def test_scenes_come_back_from_files_and_pickles(tmp_path: Path) -> None:
    scene = slope(12.5, 0.4, 33.0)
    scene.add_polyhedron([(9, 0, 0), (10, 0, 0), (9, 1, 0), (9, 0, 1)], name="corner", density=3)
    path = tmp_path / "slope.json"
    scene.save(path)
    for again in (ds.Scene.load(path), pickle.loads(pickle.dumps(scene))):
        assert again.to_json() == scene.to_json()
        assert again.dimension == 3
        assert np.array_equal(again.body("corner").vertices, scene.body("corner").vertices)


BAD = {
    "planar box": (lambda s: s.add_box((0, 0), (1, 1)), ["center", "three numbers"]),
    "angle": (lambda s: s.add_box((0, 0, 0), (1, 1, 1), 0.3), ["orientation="]),
    "orientation of three": (
        lambda s: s.add_box((0, 0, 0), (1, 1, 1), orientation=(1, 0, 0)),
        ["orientation", "quaternion"],
    ),
    "no orientation": (
        lambda s: s.add_box((0, 0, 0), (1, 1, 1), name="x", orientation=(0, 0, 0, 0)),
        ["x", "orientation is zero"],
    ),
    "flat": (
        lambda s: s.add_polyhedron([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], name="f"),
        ["f", "zero volume"],
    ),
    "too few": (lambda s: s.add_polyhedron(CUBE[:3]), ["3 vertices", "at least four"]),
    "not finite": (
        lambda s: s.add_polyhedron([*CUBE, (math.nan, 0, 0)], name="n"),
        ["n", "vertex 8", "finite"],
    ),
    "pieces overlap": (
        lambda s: s.add_solid([CUBE, [(x + 0.5, y, z) for x, y, z in CUBE]], name="p"),
        ["p", "pieces 0 and 1 overlap"],
    ),
    "no pieces": (lambda s: s.add_solid([], name="e"), ["e", "no pieces"]),
    "a polygon": (
        lambda s: s.add_polygon([(0, 0), (1, 0), (0, 1)]),
        ["in space", "add_polyhedron"],
    ),
    "facets": (lambda s: ds.check(s, facets=2), ["facets is 2", "3 to 1000"]),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_clear_error(case: str) -> None:
    provoke, parts = BAD[case]
    with pytest.raises(ds.SceneError) as caught:
        provoke(ds.Scene(dimension=3))
    for part in parts:
        assert part in str(caught.value)


def test_an_overlap_names_both_bodies_and_the_depth() -> None:
    scene = ds.Scene(dimension=3)
    scene.add_box((0, 0, 0), (1, 1, 1), name="one")
    scene.add_box((0.9, 0, 0), (1, 1, 1), name="other")
    with pytest.raises(ds.SceneError, match=r'"one" and "other" overlap by 1\.000e-1 m'):
        ds.check(scene)


def test_everything_falls_freely_where_nothing_is_fixed() -> None:
    scene = ds.Scene(dimension=3, gravity=(1.1, -2.3, -9.7), friction=0.6)
    tilted = turned((0.6, 0.0, 0.8), 23.0)
    up = np.array([0.48 * (1 - math.cos(math.radians(23))), -0.6 * math.sin(math.radians(23)), 0.0])
    up[2] = math.cos(math.radians(23)) + 0.64 * (1 - math.cos(math.radians(23)))
    for k, density in enumerate((0.37, 11.0, 3.3)):
        scene.add_box(k * up, (1, 1 - 0.1 * k, 1), density=density, orientation=tilted)
    assert len(scene.contacts) == 8
    for cone, error in (("inscribed", 1e-12), ("round", 1e-10)):  # by pivots; by the interior point
        verdict = ds.check(scene, cone=cone)
        assert (verdict.status, len(verdict.falling)) == ("solved", 3)
        assert np.allclose(verdict.accelerations[:, :3], scene.gravity, rtol=0, atol=error)
        assert np.abs(verdict.accelerations[:, 3:]).max() <= error
        assert max(force.normal_force for force in verdict.forces) <= 1e-9


def test_a_large_wall_is_told_by_straight_pressure() -> None:
    """Pivots within their bound, then the load takedown: no matrix is factored."""
    scene = ds.scenes.brick_wall(24, 30)
    verdict = ds.check(scene)
    assert verdict.stable
    assert verdict.iterations == 0
    assert verdict.forces.normal_forces.min() >= 0.0
    assert verdict.residual < 1e-12
    ground = np.array([scene.names[a] == "ground" for a, _ in verdict.forces.bodies])
    weight = sum(body.mass for body in scene.bodies if not body.fixed) * 9.81
    assert verdict.forces.vectors[ground].sum(axis=0) == pytest.approx([0, 0, weight], abs=1e-6)
    assert ds.check(scene, method="interior").stable


def test_one_loose_brick_takes_no_more_than_the_wall() -> None:
    """Only what falls is moved: pivots from nothing went through the whole wall."""
    scene = ds.scenes.brick_wall(9, 9)
    right, _, top = scene.bodies[-1].vertices.max(axis=0)
    scene.add_box((right + 0.4, 0, top + 0.25), (1.6, 0.5, 0.5), name="loose")
    verdict = ds.check(scene)
    assert verdict.falling == ("loose",)
    assert verdict.pivots < 300
    assert verdict.iterations < 40
    blocks = [body.name for body in scene.bodies if not body.fixed]
    structure = ds.Structure(scene, blocks)
    assert structure.stands() is False
    assert structure.check().falling == ("loose",)
    structure.remove("loose")
    assert structure.stands() is True
