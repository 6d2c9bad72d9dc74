"""Plans whose structures bear a horizontal acceleration, and the order that bears most."""

from __future__ import annotations

from dataclasses import replace

import pytest

import drystone as ds
from drystone.planning.robust import robust


def margin_of(scene: ds.Scene, blocks: frozenset[str]) -> float:
    return ds.margin(scene, sorted(blocks)).acceleration


def best_smallest_margin(scene: ds.Scene) -> float:
    """By all orders: of every sub-assembly the largest smallest margin on a way up to it."""
    names = [body.name for body in scene.bodies if not body.fixed]
    reached = {frozenset[str](): float("inf")}
    for _ in names:
        grown: dict[frozenset[str], float] = {}
        for blocks, least in reached.items():
            for name in names:
                more = blocks | {name}
                if len(more) == len(blocks):
                    continue
                value = min(least, margin_of(scene, more)) if least > grown.get(more, 0.0) else 0.0
                if value > grown.get(more, 0.0):
                    grown[more] = value
        reached = grown
    return reached.get(frozenset(names), 0.0)


def test_every_structure_bears_the_margin() -> None:
    tower = ds.scenes.column(11, friction=2.0)  # .1 as a whole, more with fewer blocks
    plan = ds.plan(tower, margin=0.09)
    assert plan.found
    assert plan.margins == pytest.approx([1 / n for n in range(10, 0, -1)])
    assert "each bearing 0.09 g sideways" in str(plan)
    for scene in (ds.scenes.pyramid(4), ds.scenes.wall(rows=3, columns=3)):
        bound = ds.margin(scene).acceleration
        some = ds.plan(scene, margin=0.9 * bound)
        assert some.found
        assert min(some.margins) >= 0.9 * bound
        assert some.margins[0] == pytest.approx(bound)


def test_what_has_not_the_margin_is_said() -> None:
    plan = ds.plan(ds.scenes.column(11, friction=2.0), margin=0.11)
    assert plan.status == "whole_falls"
    assert str(plan).startswith(
        "With a margin of 0.11 g: no order: the complete assembly does not bear it; "
    )


def test_an_order_may_have_to_be_another_one() -> None:
    """Two feet and a beam on them: on one foot alone the beam has a margin of next to nothing."""
    scene = ds.Scene(friction=2.0)
    scene.add_box((0, -0.5), (8, 1), name="ground", fixed=True)
    scene.add_box((0, 0.5), (2, 1), name="foot")
    scene.add_box((1.95, 0.5), (0.4, 1), name="thin")
    scene.add_box((0.8, 1.5), (3, 1), name="beam")
    plain = ds.plan(scene, margin=0.3)
    assert plain.found
    assert min(plain.margins) >= 0.3
    for margin in (0.25, 0.35):
        plan = ds.plan(scene, margin=margin)
        assert plan.found == (best_smallest_margin(scene) >= margin)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_robust_orders_beside_all_orders(seed: int) -> None:
    scene = ds.scenes.random_stack(6, seed=seed, friction=0.5)
    plain, most = ds.plan(scene), ds.plan(scene, order="robust")
    assert plain.found
    assert most.found
    best = best_smallest_margin(scene)
    smallest = min(most.margins)
    assert smallest <= best + 1e-9
    assert smallest >= best - max(1e-3 * best, 1e-4) - 1e-9
    assert smallest >= min(plain.margins) - 1e-9
    assert most.margin == pytest.approx(smallest)


def test_ctrl_c_ends_a_search_for_the_most_robust_order_with_the_best_so_far() -> None:
    plain = ds.plan(ds.scenes.random_stack(6, seed=2, friction=0.5))
    assert min(plain.margins) < 0.9 * plain.margins[0]
    asked: list[float] = []

    def planned(margin: float) -> ds.Plan:
        asked.append(margin)
        first = len(asked) == 1
        return replace(plain, found=first, status="found" if first else "interrupted", _margins=[])

    plan = robust(planned, 0.0)
    assert (plan.found, plan.status, len(asked)) == (True, "interrupted", 2)
    assert plan.margin == pytest.approx(min(plain.margins))
    assert "interrupted: another may bear more" in str(plan)


def test_margins_that_were_cut_short_are_not_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    plan = ds.plan(ds.scenes.column(4))
    left = iter([ds.margin(ds.scenes.column(2))])

    def cut_short(*_: object, **__: object) -> ds.Margin:
        found = next(left, None)
        if found is None:
            raise KeyboardInterrupt
        return found

    with monkeypatch.context() as patched:
        patched.setattr("drystone.planning.answer.margin", cut_short)
        with pytest.raises(KeyboardInterrupt):
            _ = plan.margins
    assert not plan.margins_are_known
    assert len(plan.margins) == len(plan.order)


def test_in_space() -> None:
    scene = ds.scenes.square_pyramid(2)
    bound = ds.margin(scene, cone="inscribed").acceleration
    plan = ds.plan(scene, margin=0.9 * bound)
    assert plan.found
    assert min(plan.margins) >= 0.9 * bound


def test_what_does_not_go_together() -> None:
    scene = ds.scenes.column(3)
    for wrong in ({"margin": -1.0}, {"margin": 0.1, "hold": 1}, {"margin": 0.1, "test": "lcp"}):
        with pytest.raises(ValueError, match="margin"):
            ds.plan(scene, **wrong)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="order"):
        ds.plan(scene, order="best")
    with pytest.raises(ds.SceneError, match="gravity"):
        ds.plan(scene.with_gravity((0, 0)), margin=0.1)
