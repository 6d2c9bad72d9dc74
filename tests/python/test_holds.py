"""`plan(hold=)`: with blocks held for a while there is an order where there was none."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import drystone as ds
from conftest import ROOT, orderless
from drystone.cli.app import app


def stands(scene: ds.Scene, keep: tuple[str, ...], held: tuple[str, ...]) -> bool:
    """By a fresh check of what is there, with the held blocks fixed."""
    part = ds.Scene(gravity=scene.gravity, friction=scene.friction)
    for body in scene.bodies:
        if body.fixed or body.name in keep:
            part.add_polygon(
                body.vertices,
                name=body.name,
                density=body.density,
                friction=body.friction,
                fixed=body.fixed or body.name in held,
            )
    return ds.check(part).stable


def verify(plan: ds.Plan, hands: int) -> None:
    """Every structure on the way stands with what is held, and the steps lead to the holds."""
    assert plan.found
    held: set[str] = set()
    steps = plan.hold_steps
    for k, name in enumerate(plan.order):
        assert held == set(plan.holds[k])
        assert stands(plan.scene, plan.order[k:], plan.holds[k])
        for action, block, before in steps:
            if before == k and action == "hold":
                assert block in plan.order[k + 1 :]
                assert block not in held
                held.add(block)
                assert len(held - {name}) <= hands
        for action, block, before in steps:
            if before == k and action == "release":
                held.remove(block)
        assert name not in held
    assert not held
    assert len(plan.holds) == len(plan.order)
    assert not plan.holds[0]


@pytest.mark.parametrize("voussoirs", [5, 8, 20])
def test_an_arch_comes_down_with_one_hand(voussoirs: int) -> None:
    scene = ds.scenes.arch(voussoirs)
    assert ds.plan(scene).status == "no_order"
    plan = ds.plan(scene, hold=1)
    verify(plan, 1)
    assert plan.hold_steps
    assert max(map(len, plan.holds)) == 1
    more = ds.plan(scene, hold=2)
    verify(more, 2)


def dome(rings: int) -> ds.Scene:
    sys.path.insert(0, str(ROOT / "benchmarks"))
    try:
        import cold_scenes
    finally:
        sys.path.pop(0)
    return cold_scenes.dome(rings, 0.7)


def test_a_dome_is_checked_without_pivots() -> None:
    """They are 2,262 by Dantzig's method."""
    verdict = ds.check(dome(6))
    assert verdict.stable
    assert verdict.pivots == 0
    assert verdict.iterations < 15


def test_a_dome_comes_down_ring_by_ring() -> None:
    """An open ring couples all its voussoirs: pivots alone would make some 60,000 here."""
    scene = dome(4)
    plan = ds.plan(scene, hold=1)
    assert plan.found
    assert plan.pivots < 10_000
    rings = [int(name.split("-")[0]) for name in plan.order]
    assert rings == sorted(rings, reverse=True)
    content = json.loads(scene.to_json())
    for k, held in list(enumerate(plan.holds))[::7]:
        there, fixed = set(plan.order[k:]), set(held)
        bodies = [body for body in content["bodies"] if body.get("fixed") or body["name"] in there]
        part = [
            {**body, "fixed": bool(body.get("fixed")) or body["name"] in fixed} for body in bodies
        ]
        assert ds.check(ds.Scene.from_json(json.dumps({**content, "bodies": part}))).stable


def test_a_plank_is_held_until_its_counterweight_is_there() -> None:
    plan = ds.plan(orderless(2), hold=1)
    verify(plan, 1)
    assert [step[:2] for step in plan.hold_steps] == [("hold", "plank"), ("release", "plank")]
    assert "1 hold, at most 1 at a time" in str(plan)


def test_nothing_is_held_without_need() -> None:
    scene = ds.scenes.five_blocks()
    bare, held = ds.plan(scene), ds.plan(scene, hold=3)
    assert (bare.order, bare.tests, bare.pivots) == (held.order, held.tests, held.pivots)
    assert not any(held.holds)
    assert held.hold_steps == []


def test_without_an_order_it_says_what_was_held() -> None:
    plan = ds.plan(ds.scenes.arch(9), hold=1, node_limit=14)
    assert plan.status == "test_limit"
    assert len(plan.holds) == len(plan.reached) > 0
    for k, held in enumerate(plan.holds):
        assert stands(plan.scene, plan.reached[: len(plan.reached) - k], held)
    assert plan.hold_steps[0] == ("hold", plan.holds[0][0], 0)


@pytest.mark.parametrize("hold", [-1, 9])
def test_a_number_of_hands_that_is_none_is_an_error(hold: int, block: ds.Scene) -> None:
    with pytest.raises(ValueError, match="hold"):
        ds.plan(block, hold=hold)


def test_the_command_line_tells_the_steps() -> None:
    run = CliRunner().invoke(app, ["plan", "arch:5", "--hold", "1"], standalone_mode=False)
    assert run.return_value == 0
    assert "hold and release" in run.output
    assert "hold 3" in run.output
    run = CliRunner().invoke(app, ["plan", "arch:5", "--hold", "1", "--json"])
    answer = json.loads(run.output)
    plan = ds.plan(ds.scenes.arch(5), hold=1)
    assert answer["holds"] == [list(held) for held in plan.holds]
    assert answer["hold_steps"] == [list(step) for step in plan.hold_steps]


def test_the_page_says_what_hands_do() -> None:
    from drystone.recording.of_plan import plan_recording

    plan = ds.plan(ds.scenes.arch(5), hold=1, clear_path=True)
    captions = [text for _, text in plan_recording(plan).captions]
    assert captions[0].endswith("Next: hold 3, then take away 4 towards (-0.309, 0.951).")
    assert "Held: 3. The hand on 3 bears " in captions[1]
    assert " N. Next: hold 2, then take away 3 towards" in captions[1]


@pytest.mark.parametrize("space", [False, True])
def test_hands_bear_what_contacts_do_not(space: bool) -> None:
    """On every structure on the way hands and ground together carry the weight."""
    scene = ds.scenes.arch(7)
    if space:
        scene = scene.extruded(0.3)
    plan = ds.plan(scene, hold=1)
    assert plan.assembly_order == plan.order[::-1]
    assert plan.to_dict()["assembly_order"] == list(plan.assembly_order)
    hands = plan.hand_forces()
    assert [tuple(of) for of in hands] == list(plan.holds)
    assert any(hands)
    forces = plan.view().recording.forces
    assert forces is not None
    fixed = [k for k, body in enumerate(scene.bodies) if body.fixed]
    mass = {body.name: body.mass for body in scene.bodies}
    up = scene.dimension - 1
    for step, wrenches in enumerate(hands):
        span = slice(*np.asarray(forces.offsets)[step : step + 2])
        on_ground = np.isin(np.asarray(forces.bodies)[span, 0], fixed)
        borne = np.asarray(forces.vectors)[span][on_ground, up].sum()
        held = sum(wrench[up] for wrench in wrenches.values())
        weight = 9.81 * sum(mass[name] for name in plan.order[step:])
        assert borne + held == pytest.approx(weight, rel=1e-6)
        assert all(len(wrench) == 3 * scene.dimension - 3 for wrench in wrenches.values())


def test_the_command_line_says_what_hands_bear(cli: Callable[..., Any]) -> None:
    ran = cli("plan", "arch:7", "--hold", "1")
    assert "put up, in this order  1 " in ran.out
    assert re.search(r"hands bear at most +5: [\d.]+ N, ", ran.out)
