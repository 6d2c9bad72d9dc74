"""`plan`: orders that never collapse, or the truth that there is none."""

from __future__ import annotations

import json
import time

import numpy as np
import pytest

import drystone as ds
from conftest import dropped, orderless
from drystone.planning.search import TESTS

SCENES = {
    "column": lambda: ds.scenes.column(6),
    "pyramid": lambda: ds.scenes.pyramid(4),
    "random": lambda: ds.scenes.random_stack(12),
    "five": ds.scenes.five_blocks,
    "arch": lambda: ds.scenes.arch(5),
    "diamond": lambda: ds.scenes.diamond(3),
    "wall": lambda: ds.scenes.wall(3, 3),
    "orderless": lambda: orderless(2),
}


@pytest.mark.parametrize("name", SCENES)
def test_every_structure_on_the_way_stands(name: str) -> None:
    scene = SCENES[name]()
    plan = ds.plan(scene)
    if not plan.found:
        assert name in ("arch", "diamond", "orderless")
        return
    movable = {body.name for body in scene.bodies if not body.fixed}
    assert set(plan.order) == movable
    assert len(plan.order) == len(movable)
    for taken in range(len(plan.order)):
        assert ds.check(scene, plan.order[taken:]).stable


@pytest.mark.parametrize("name", SCENES)
def test_all_tests_lead_to_the_same_search(name: str) -> None:
    scene = SCENES[name]()
    plans = {test: ds.plan(scene, test, shortcuts=False) for test in TESTS}
    visited = {
        test: [(record.size, record.stable) for record in plan.records]
        for test, plan in plans.items()
    }
    for test in TESTS:
        assert visited[test] == visited["lcp"]
        assert plans[test].order == plans["lcp"].order
        assert plans[test].status == plans["lcp"].status
        assert plans[test].tests == len(plans[test].records)
        assert plans[test].pivots == sum(record.pivots for record in plans[test].records)


def test_one_thousand_random_assemblies() -> None:
    """lp, lp-warm, lcp and reuse visit the same sub-assemblies with the same verdicts.

    The whole assembly's verdict is compared as well, by asking the linear program about it. No
    structure drawn from a continuum balances on an edge: none is excepted.
    """
    from drystone import statics

    rng = np.random.default_rng(20060515)
    stands = 0
    for _ in range(1000):
        # Small ones are the most, but every size up to 60 is there.
        blocks = int(2 + 59 * rng.uniform() ** 2)
        scene = dropped(rng, blocks, friction=float(rng.uniform()))
        verdict = ds.check(scene)
        program = statics.ColdProgram(statics.Equilibrium.of(scene))
        assert program(list(range(blocks)), blocks - 1)[0] == verdict.stable
        stands += verdict.stable
        searches = [
            [(r.size, r.stable) for r in ds.plan(scene, test, 40, shortcuts=False).records]
            for test in TESTS
        ]
        assert all(search == searches[0] for search in searches)
    assert 100 < stands < 900


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("test", ["reuse", "reuse-dantzig", "lcp"])
def test_shortcuts_spare_tests_and_change_no_answer(name: str, test: str) -> None:
    scene = SCENES[name]()
    short, full = ds.plan(scene, test), ds.plan(scene, test, shortcuts=False)
    assert (short.status, short.order) == (full.status, full.order)
    assert short.tests <= full.tests
    assert full.shortcuts == 0


def test_reuse_needs_fewer_pivots() -> None:
    scene = ds.scenes.random_stack(30)
    assert 3 * ds.plan(scene, "reuse").pivots < ds.plan(scene, "lcp").pivots


def test_no_order_is_an_answer_that_shows_how_far_one_gets() -> None:
    plan = ds.plan(orderless(0))
    assert (plan.found, plan.status, plan.order) == (False, "no_order", ())
    assert plan.whole is not None
    assert plan.whole.stable
    assert plan.reached == ("pier",)
    assert plan.falls_next == ("plank",)
    assert "No stable order exists" in str(plan)


def test_where_no_order_exists_a_hold_is_named_that_may_help() -> None:
    scene = orderless(0)
    plan = ds.plan(scene)
    assert (plan.hold, plan.next_hold, plan.to_dict()["hold"]) == (0, 1, 0)
    assert str(plan).endswith("\nIf blocks may be held there may be an order: hold=1.")
    held = ds.plan(scene, hold=1)
    assert (held.found, held.hold, held.next_hold) == (True, 1, None)
    assert ds.plan(scene, strong=True).next_hold is None
    assert ds.plan(scene, margin=0.01).next_hold is None
    counted = ds.plan(scene, hold=np.int64(1), time_limit=np.inf)
    assert json.loads(json.dumps(counted.to_dict()))["hold"] == 1
    assert ds.plan(scene, node_limit=0).next_hold is None, "it may have an order"


def test_an_assembly_that_falls_has_no_order(leaning: ds.Scene) -> None:
    plan = ds.plan(leaning)
    assert (plan.found, plan.status) == (False, "whole_falls")
    assert plan.whole is not None
    assert plan.whole.falling == ("plank",)


def test_limits_hand_back_the_best_so_far() -> None:
    scene = orderless(12)
    few = ds.plan(scene, node_limit=5)
    assert (few.status, few.tests, few.found) == ("test_limit", 5, False)
    assert 0 < len(few.reached) <= 5
    assert ds.check(scene, few.reached).stable
    brief = ds.plan(scene, time_limit=0.0)
    assert (brief.status, brief.found, brief.whole) == ("time_limit", False, None)
    assert "the time was up" in str(brief)


def test_progress_is_told() -> None:
    calls: list[tuple[int, int, int]] = []
    plan = ds.plan(
        orderless(18),
        time_limit=0.5,
        progress=lambda *told: calls.append(told),
        shortcuts=False,
    )
    assert calls
    for tests, placed, total in calls:
        assert 0 <= tests <= plan.tests
        assert 0 <= placed <= total == 21


def test_an_interrupt_is_a_status() -> None:
    def interrupt(tests: int, placed: int, total: int) -> None:
        raise KeyboardInterrupt

    try:
        plan = ds.plan(orderless(18), progress=interrupt, shortcuts=False)
    except KeyboardInterrupt:
        pytest.fail("the best so far was lost")
    assert (plan.status, plan.found) == ("interrupted", False)


def falls_slowly() -> ds.Scene:
    """A structure that falls. Its check takes ten times as long as its contacts."""
    return ds.scenes.diamond(90)


@pytest.mark.parametrize("threads", [1, 2])
def test_the_check_of_the_whole_tells_and_can_be_stopped(threads: int) -> None:
    scene = falls_slowly()
    begin = time.monotonic()
    ds.Structure(scene)
    # Long enough to be told of something, on this machine, at this moment.
    limit = 0.3 + 4 * (time.monotonic() - begin)
    calls: list[tuple[int, ...]] = []

    def note(*told: int) -> None:
        if not calls:
            time.sleep(limit)  # so the time is up
        calls.append(told)

    plan = ds.plan(scene, time_limit=limit, progress=note, threads=threads)
    assert (plan.status, plan.whole) == ("time_limit", None)
    assert (threads == 1) == (plan.tests == 0)  # on two, the search has begun
    assert calls
    assert all(0 <= placed <= total for _, placed, total in calls)

    def interrupt(*told: int) -> None:
        raise KeyboardInterrupt

    plan = ds.plan(scene, progress=interrupt, threads=threads)
    assert (plan.status, plan.whole) == ("interrupted", None)


def test_an_error_in_progress_reaches_the_caller() -> None:
    def fail(tests: int, placed: int, total: int) -> None:
        raise RuntimeError("from the callback")

    with pytest.raises(RuntimeError, match="from the callback"):
        ds.plan(orderless(18), progress=fail, shortcuts=False)


def test_the_same_plan_again() -> None:
    scene = ds.scenes.random_stack(25, seed=5)
    first, again = ds.plan(scene), ds.plan(scene)
    assert first.order == again.order
    assert [r.pivots for r in first.records] == [r.pivots for r in again.records]


@pytest.mark.parametrize("test", ["reuse", "reuse-dantzig", "lcp"])
def test_the_same_plan_on_any_number_of_threads(test: str) -> None:
    for scene in (ds.scenes.random_stack(60, seed=4), orderless(30), ds.scenes.column(220)):
        plans = [ds.plan(scene, test, node_limit=150, threads=threads) for threads in (1, 2, 8)]
        for plan in plans[1:]:
            assert (plan.status, plan.order, plan.reached) == (
                plans[0].status,
                plans[0].order,
                plans[0].reached,
            )
            assert [(r.size, r.pivots, r.stable) for r in plan.records] == [
                (r.size, r.pivots, r.stable) for r in plans[0].records
            ]


def test_no_thread_is_an_error(block: ds.Scene) -> None:
    with pytest.raises(ValueError, match="threads is 0: it must be one or more"):
        ds.plan(block, threads=0)


def test_an_unknown_test_is_an_error(block: ds.Scene) -> None:
    with pytest.raises(ValueError, match="unknown test 'simplex': choose one of reuse"):
        ds.plan(block, "simplex")


def test_a_wall_in_space_is_planned_without_a_test_by_pivots_for_each_brick() -> None:
    """Beyond a bound of work, blocks that bear by straight pressure need no pivots."""
    plan = ds.plan(ds.scenes.brick_wall(24, 30))
    assert plan.found
    assert plan.tests == len(plan.order) - 1
    without = [record for record in plan.records if record.pivots == 0]
    assert len(without) > 100
    assert all(record.stable for record in without)
    assert plan.order == tuple(reversed(plan.reached))
