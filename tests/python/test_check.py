"""`check` against answers derived by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

import drystone as ds

G = 9.81


def test_each_end_of_a_face_carries_half_the_weight(block: ds.Scene) -> None:
    verdict = ds.check(block)
    assert verdict.stable
    assert verdict.status == "solved"
    assert verdict.falling == ()
    assert verdict.residual <= 1e-9
    assert verdict.accelerations == pytest.approx(np.zeros((1, 3)), abs=1e-9)
    # 2 kg, symmetric: the moments balance only with equal forces at the two ends.
    assert [force.normal_force for force in verdict.forces] == pytest.approx([G, G])
    assert sum(force.tangential_force for force in verdict.forces) == pytest.approx(0, abs=1e-9)


def test_the_force_is_what_a_exerts_on_b(block: ds.Scene) -> None:
    for force in ds.check(block).forces:
        normal = np.array(force.normal)
        tangent = np.array([-normal[1], normal[0]])
        total = force.normal_force * normal + force.tangential_force * tangent
        assert total == pytest.approx(np.array(force.force))
        assert force.force[1] == pytest.approx(G if force.b == "block" else -G)


def test_a_body_with_nothing_below_falls_freely() -> None:
    scene = ds.Scene()
    scene.add_box((0, 5), (1, 1), name="b")
    verdict = ds.check(scene)
    assert not verdict.stable
    assert verdict.falling == ("b",)
    assert verdict.acceleration("b") == pytest.approx([0, -G, 0])


def test_the_leaning_plank_turns_about_the_edge_of_its_pier(leaning: ds.Scene) -> None:
    verdict = ds.check(leaning)
    assert not verdict.stable
    assert verdict.falling == ("plank",)
    # About the edge (0.5, 1): the centre of mass is at (0.1, 0.1) from it, mass 0.4 kg,
    # inertia 0.4 (2^2 + 0.2^2) / 12 about the centroid. Friction .5 holds the edge in place.
    mass, inertia = 0.4, 0.4 * (4 + 0.04) / 12
    turn = -mass * G * 0.1 / (inertia + mass * (0.1**2 + 0.1**2))
    expected = [-turn * 0.1, turn * 0.1, turn]
    assert verdict.acceleration("plank") == pytest.approx(expected)


@pytest.mark.parametrize("mu", [0.0, 0.3])
def test_a_sliding_block_accelerates_as_the_convex_model_says(mu: float) -> None:
    """Without friction g sin a, along the slope. With it, the acceleration nearest to free fall
    among those that the cone's edge does not oppose: g sin(a - phi), tan phi = mu, and turned by
    phi out of the slope. (Coulomb's law keeps it on the slope: g (sin a - mu cos a).)
    """
    angle, phi = math.radians(30), math.atan(mu)
    verdict = ds.check(ds.scenes.slope(30, friction=mu, width=2))
    assert not verdict.stable
    moves = verdict.acceleration(verdict.names[0])
    assert np.hypot(*moves[:2]) == pytest.approx(G * math.sin(angle - phi))
    assert math.atan2(-moves[1], -moves[0]) == pytest.approx(angle - phi)
    assert moves[2] == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("mu", [0.2, 0.5, 0.9])
def test_a_block_on_a_slope_holds_up_to_the_angle_of_friction(mu: float) -> None:
    limit = math.degrees(math.atan(mu))
    assert ds.check(ds.scenes.slope(limit - 1e-3, friction=mu, width=3)).stable
    assert not ds.check(ds.scenes.slope(limit + 1e-3, friction=mu, width=3)).stable


def test_a_block_on_a_slope_topples_where_its_centre_leaves_its_base() -> None:
    limit = math.degrees(math.atan(0.5))
    assert ds.check(ds.scenes.slope(limit - 1e-3, friction=2, width=1, height=2)).stable
    assert not ds.check(ds.scenes.slope(limit + 1e-3, friction=2, width=1, height=2)).stable


def test_diamonds_up_to_four_stand() -> None:
    """Paterson and Zwick, "Overhang" (2009), section 2."""
    stands = [ds.check(ds.scenes.diamond(m)).stable for m in range(1, 6)]
    assert stands == [True, True, True, True, False]


def test_the_harmonic_stack_reaches_its_limit_and_no_further() -> None:
    for n in (1, 3, 10, 30):
        assert ds.check(ds.scenes.harmonic_stack(n)).stable
        assert not ds.check(ds.scenes.harmonic_stack(n, 1.001)).stable


def test_inverted_triangles_fall_from_three_rows_on() -> None:
    assert ds.check(ds.scenes.inverted_triangle(2)).stable
    assert not ds.check(ds.scenes.inverted_triangle(3)).stable


def _least(holds: object, low: float, high: float, width: float) -> float:
    """Bisection: the least value for which `holds`."""
    assert callable(holds)
    assert holds(high)
    assert not holds(low)
    while high - low > width:
        middle = (low + high) / 2
        low, high = (low, middle) if holds(middle) else (middle, high)
    return high


def test_the_least_thickness_of_an_arch() -> None:
    """Milankovitch (1907): 0.1075 of the mean radius; 0.1073 with 41 voussoirs."""
    least = _least(lambda t: ds.check(ds.scenes.arch(41, t, friction=10.0)).stable, 0.05, 0.2, 1e-5)
    assert least == pytest.approx(0.1073, abs=1e-3)


def test_the_least_friction_of_a_thick_arch() -> None:
    """About .31, whatever the thickness; .3092 with 41 voussoirs."""
    least = _least(lambda mu: ds.check(ds.scenes.arch(41, 0.2, friction=mu)).stable, 0.1, 0.7, 1e-5)
    assert 0.309 < least < 0.315


def test_a_sub_assembly_is_checked_without_the_rest() -> None:
    scene = ds.scenes.five_blocks()
    assert ds.check(scene, ["1", "3", "5"]).stable
    verdict = ds.check(scene, ["1", "3"])
    assert not verdict.stable
    assert verdict.names == ("1", "3")
    assert verdict.falling == ("3",)
    assert not ds.check(scene, ["1", "3", "4", "5"]).stable


def test_nothing_stands() -> None:
    verdict = ds.check(ds.scenes.five_blocks(), [])
    assert verdict.stable
    assert (verdict.names, verdict.forces, verdict.pivots) == ((), (), 0)


def test_forces_balance_every_block() -> None:
    scene = ds.scenes.wall(6, 5, seed=2)
    verdict = ds.check(scene)
    assert verdict.stable
    for body in scene.bodies:
        if body.fixed:
            continue
        total, moment = np.array([0.0, -G * body.mass]), 0.0
        for force in verdict.forces:
            if body.name in (force.a, force.b):
                push = np.array(force.force) * (1 if force.b == body.name else -1)
                arm = np.array(force.point) - body.centroid
                total += push
                moment += arm[0] * push[1] - arm[1] * push[0]
        assert total == pytest.approx(np.zeros(2), abs=1e-7)
        assert moment == pytest.approx(0, abs=1e-7)


def test_the_verdict_can_be_read(block: ds.Scene, leaning: ds.Scene) -> None:
    assert str(ds.check(block)).startswith("Stands: 1 block, 2 contact points; ")
    assert str(ds.check(leaning)).startswith("Falls: 1 of 1 block (plank); ")


def test_the_accelerations_of_an_unknown_body_are_an_error(block: ds.Scene) -> None:
    with pytest.raises(ds.SceneError, match="ground"):
        ds.check(block).acceleration("ground")
