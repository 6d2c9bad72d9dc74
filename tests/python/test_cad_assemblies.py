"""Small CAD assemblies come apart in the orders and along the ways that are known of them."""

from __future__ import annotations

import sys

import numpy as np
import pytest

import drystone as ds
from conftest import ROOT

BENCHMARKS = str(ROOT / "benchmarks")
sys.path.insert(0, BENCHMARKS)

from cad_assemblies import ASSEMBLIES, Assembly, box, piston, screws  # noqa: E402

sys.path.remove(BENCHMARKS)


@pytest.mark.parametrize("name", ASSEMBLIES)
def test_it_comes_apart_as_is_known_of_it(name: str) -> None:
    assembly = ASSEMBLIES[name]()
    plan = assembly.plan()
    assert plan.status == assembly.status
    if plan.found:
        comes_apart(assembly, plan)
    if assembly.without is not None:
        assert assembly.plan(asked=False).status == assembly.without


def comes_apart(assembly: Assembly, plan: ds.Plan) -> None:
    assert sorted(plan.order) == sorted(assembly.parts.keys() - set(assembly.fixed))
    place = {part: k for k, part in enumerate(plan.order)}
    for first, later in assembly.before:
        assert place[first] < place[later], (first, later)
    for part, way in zip(plan.order, plan.directions, strict=True):
        if part in assembly.ways:
            assert max(np.dot(way, known) for known in assembly.ways[part]) > 1 - 1e-6, (part, way)


@pytest.mark.parametrize("clearance", ["peg", "peg-loose"])
def test_the_way_to_freedom_is_as_long_as_the_hole_is_deep(clearance: str) -> None:
    (moves,) = ASSEMBLIES[clearance]().plan().moves
    assert len(moves) == 1
    assert moves[0].length == pytest.approx(0.020, abs=3e-6)


def test_round_the_corner_both_moves_are_told() -> None:
    plan = ASSEMBLIES["corner"]().plan()
    back, up = plan.moves[0]
    # Anything from 40 to 50 mm would do: the shaft is as wide as the slider.
    assert back.direction == pytest.approx((-1, 0, 0))
    assert back.length == pytest.approx(0.050, abs=3e-6)
    assert up.direction == pytest.approx((0, 0, 1))
    assert up.length == pytest.approx(0.035, abs=3e-6)


def test_out_of_the_middle_of_a_slot() -> None:
    """The exit is as wide as the slider, and neither end of the slot is under it."""
    case = box(-50, 50, -15, 15, 0, 40) - box(-45, 45, -8, 8, 5, 20) - box(-7, 13, -8, 8, 10, 41)
    slider = box(25, 45, -8, 8, 5, 20)
    assembly = Assembly("T", {"case": case, "slider": slider}, fixed=("case",))
    plan = ds.plan(assembly.scene(), clear_path=True, moves=2)
    along, up = plan.moves[0]
    assert along.direction == pytest.approx((-1, 0, 0))
    assert along.length == pytest.approx(0.032, abs=3e-6)
    assert up.direction == pytest.approx((0, 0, 1))
    assert ds.plan(assembly.scene(), clear_path=True).status == "locked"


def test_what_leaves_together_stays_together_in_the_order() -> None:
    plan = piston().plan()
    assert [sorted(group) for group in plan.groups] == [["pin", "piston", "rod"]]
    assert len(set(plan.directions)) == 1
    assert "Together leave" in str(plan)
    two = ds.plan(piston().scene(), clear_path=True, together=2)
    assert two.status == "locked"
    assert {one.name for one in two.blocked} == {"pin", "piston", "rod"}


def test_a_group_stands_before_it_leaves_and_what_remains_after() -> None:
    """A drawer with a thing in it below a shelf: the lid on the shelf leaves at any time."""
    assembly = ASSEMBLIES["drawers"]()
    scene = assembly.scene()
    plan = assembly.plan()
    ends = [k for k, part in enumerate(plan.order) if part not in plan.groups[0][:-1]]
    for k in ends:
        assert ds.check(scene, plan.order[k + 1 :]).stable


def test_hands_hold_where_a_group_leaves() -> None:
    """A plank that a locked pair on its tail keeps level tips over when the pair is gone."""
    base, plank = box(-10, 10, -10, 10, 0, 20), box(-40, 80, -10, 10, 20, 24)
    weight = box(-40, -20, -10, 10, 24, 44) - box(-35, -25, -5, 5, 29, 40)
    inside = box(-35, -25, -5, 5, 29, 38)
    parts = {"base": base, "plank": plank, "weight": weight, "inside": inside}
    assembly = Assembly("Plank", parts, fixed=("base",))
    scene = assembly.scene()
    assert ds.check(scene).stable
    options = {"clear_path": True, "together": 2}
    assert ds.plan(scene, **options).status == "no_order"
    plan = ds.plan(scene, hold=1, **options)
    assert plan.found
    assert plan.order[-1] == "plank"
    assert plan.holds[-1] == ("plank",)


def test_an_obstacle_is_in_the_way_and_bears_nothing() -> None:
    assembly = ASSEMBLIES["fixture"]()
    assert assembly.plan(asked=False).directions == ((0, 0, 1),)
    scene, lid = assembly.scene(), ds.Scene(dimension=3)
    lid.add_box((0, 0, 0.05), (0.2, 0.2, 0.01), name="lid", fixed=True)
    for x in (-1, 1):
        lid.add_box((0, 0.025 * x, 0.02), (0.1, 0.01, 0.02), name=f"wall {x}", fixed=True)
    plan = ds.plan(scene, clear_path=True, obstacles=lid)
    assert plan.status == "locked"
    assert set(plan.blocked[0].by) == {"vice", "lid", "wall -1", "wall 1"}


def test_more_screws_come_before_the_cover_in_any_order_of_parts() -> None:
    assembly = screws()
    parts = dict(reversed(assembly.parts.items()))
    plan = ds.plan(Assembly("", parts, assembly.fixed).scene(), clear_path=True)
    assert plan.order[-1] == "cover"


def test_what_is_asked_of_ways_is_checked() -> None:
    scene = ds.scenes.column(2)
    for options, words in [
        ({"moves": 3, "clear_path": True}, "moves is 3"),
        ({"together": 0, "clear_path": True}, "together is 0"),
        ({"moves": 2}, "give clear_path=True"),
        ({"together": 2}, "give clear_path=True"),
        ({"obstacles": scene}, "give clear_path=True"),
        ({"obstacles": ds.Scene(dimension=3), "clear_path": True}, "dimension 3"),
    ]:
        with pytest.raises(ValueError, match=words):
            ds.plan(scene, **options)
