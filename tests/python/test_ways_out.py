"""Sliders in slots leave along straight lines, however all is turned and whatever the clearance."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import drystone as ds

Pieces = list[Any]


def cuboid(x0: float, x1: float, y0: float, y1: float, z0: float, z1: float) -> Any:
    return np.array([(x, y, z) for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)], float)


def prism(section: list[tuple[float, float]], x0: float, x1: float) -> Any:
    return np.array([(x, y, z) for x in (x0, x1) for y, z in section], float)


def tee(e: float) -> tuple[Pieces, Pieces]:
    rail = [cuboid(-5, 5, -3, 3, -1, 0), cuboid(-5, 5, -3, -2, 0, 2), cuboid(-5, 5, 2, 3, 0, 2)]
    rail += [cuboid(-5, 5, -3, -1, 2, 3), cuboid(-5, 5, 1, 3, 2, 3)]
    return rail, [cuboid(-1, 1, e - 2, 2 - e, 0, 2 - e), cuboid(-1, 1, e - 1, 1 - e, 2 - e, 4)]


def dovetail(e: float) -> tuple[Pieces, Pieces]:
    rail = [cuboid(-5, 5, -4, 4, -1, 0), prism([(-4, 0), (-2, 0), (-1, 2), (-4, 2)], -5, 5)]
    rail += [prism([(4, 0), (2, 0), (1, 2), (4, 2)], -5, 5)]
    e *= 1.2
    return rail, [prism([(e - 2, 0), (2 - e, 0), (1 - e, 2), (e - 1, 2)], -1, 1)]


def peg(e: float) -> tuple[Pieces, Pieces]:
    block = [cuboid(-3, 3, -3, 3, -1, 0), cuboid(-3, -1, -3, 3, 0, 2), cuboid(1, 3, -3, 3, 0, 2)]
    block += [cuboid(-1, 1, -3, -1, 0, 2), cuboid(-1, 1, 1, 3, 0, 2)]
    return block, [cuboid(e - 1, 1 - e, e - 1, 1 - e, 0, 3)]


def drawer(e: float) -> tuple[Pieces, Pieces]:
    case = [cuboid(-3, 3, -3, 3, -1, 0), cuboid(-3, 3, -3, -1, 0, 2), cuboid(-3, 3, 1, 3, 0, 2)]
    case += [cuboid(-3, -2, -1, 1, 0, 2), cuboid(-3, 3, -3, 3, 2, 3)]
    return case, [cuboid(e - 2, 3, e - 1, 1 - e, 0, 2 - e)]


def hook(e: float) -> tuple[Pieces, Pieces]:
    frame = [cuboid(-3, 3, -2, 2, -1, 0), cuboid(-3, -1, -2, 2, 0, 3), cuboid(1, 3, -2, 2, 0, 1)]
    frame += [cuboid(2, 3, -2, 2, 1, 3), cuboid(-1, 3, -2, 2, 3, 4)]
    return frame, [cuboid(e - 1, 1 - e, -2, 2, 0, 3 - e), cuboid(1 - e, 2 - e, -2, 2, 1, 3 - e)]


WAYS = {
    tee: ((1, 0, 0), (-1, 0, 0)),
    dovetail: ((1, 0, 0), (-1, 0, 0)),
    peg: ((0, 0, 1),),
    drawer: ((1, 0, 0),),
    hook: ((0, 1, 0), (0, -1, 0)),
}
"""Sliders that have one way out, or one and its opposite, before they are turned."""


@pytest.mark.parametrize("slider", WAYS)
@pytest.mark.parametrize("clearance", [0.0, 1e-6, 1e-4, 1e-2])
@pytest.mark.parametrize("upright", [True, False])
def test_a_slider_leaves_its_slot(slider: Any, clearance: float, upright: bool) -> None:
    for seed in range(3):
        angle = 0.3 + 0.5 * seed
        turn = Rotation.from_euler("z", angle) if upright else Rotation.random(random_state=seed)
        fixed, free = slider(clearance)
        scene = ds.Scene(dimension=3, gravity=tuple(turn.apply([0, 0, -9.81])))
        scene.add_solid([turn.apply(piece) for piece in fixed], name="rail", fixed=True)
        scene.add_solid([turn.apply(piece) for piece in free], name="slider")
        plan = ds.plan(scene, clear_path=True)
        assert plan.found
        along = turn.inv().apply(plan.directions[0])
        assert max(np.dot(along, way) for way in WAYS[slider]) > 1 - 1e-6


@pytest.mark.parametrize("clearance", [0.0, 1e-4, 1e-2])
def test_a_tongue_leaves_its_slot_in_the_plane(clearance: float) -> None:
    for angle in np.linspace(0.1, 3, 5):
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        scene = ds.Scene(gravity=tuple(turn @ [0, -9.81]))
        for x0, x1, y0, y1 in ((-3, 3, -1, 0), (-3, 3, 1, 2), (-3, -2, 0, 1)):
            scene.add_polygon(
                np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)]) @ turn.T, fixed=True
            )
        x, y = clearance - 2, 1 - clearance
        scene.add_polygon(np.array([(x, 0), (4, 0), (4, y), (x, y)]) @ turn.T, name="tongue")
        plan = ds.plan(scene, clear_path=True)
        assert plan.found
        assert plan.directions[0] == pytest.approx(turn @ [1, 0])


def test_what_is_shut_in_stays_locked_and_every_way_says_why() -> None:
    turn = Rotation.random(random_state=1)
    case = [*drawer(0.0)[0], cuboid(2, 3, -1, 1, 0, 2)]
    scene = ds.Scene(dimension=3, gravity=tuple(turn.apply([0, 0, -9.81])))
    scene.add_solid([turn.apply(piece) for piece in case], fixed=True, name="case")
    scene.add_solid([turn.apply(cuboid(-1, 1, -0.5, 0.5, 0, 1))], name="inside")
    plan = ds.plan(scene, clear_path=True)
    assert (plan.status, plan.blocked[0].by) == ("locked", ("case",))
    assert 6 <= len(plan.blocked[0].ways) <= 300
    assert all(by == ("case",) for _, by in plan.blocked[0].ways)


def test_a_second_search_where_the_first_finds_no_order() -> None:
    # Whatever falls, the post may go first, and then the lid downward: nothing is locked. But the
    # lid falls without the post. Beside it, it has to slide along grooves that it does not touch.
    turn, e = Rotation.from_euler("z", 0.3), 0.01
    walls = [cuboid(3, 9, -1, 1, 0, 1)]
    walls += [cuboid(-4, 4, 2, 3, 2, 3), cuboid(-4, 4, -3, -2, 2, 3)]
    walls += [cuboid(-4, 4, 1, 3, 3, 4), cuboid(-4, 4, -3, -1, 3, 4)]
    scene = ds.Scene(dimension=3, friction=0.5)
    scene.add_solid([turn.apply(piece) for piece in walls], name="walls", fixed=True)
    post = [cuboid(-1, 9, -1, 1, 1, 2), cuboid(5, 9, -1, 1, 2, 5)]
    scene.add_solid([turn.apply(piece) for piece in post], name="post")
    scene.add_solid([turn.apply(cuboid(-1, 1, e - 2, 2 - e, 2, 3 - e))], name="lid")
    plan = ds.plan(scene, clear_path=True)
    assert plan.order == ("lid", "post")
    assert abs(turn.inv().apply(plan.directions[0])) == pytest.approx((1, 0, 0))
    again = ds.plan(scene, clear_path=True, threads=1)
    assert (again.order, again.directions) == (plan.order, plan.directions)
