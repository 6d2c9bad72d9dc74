"""`plan(clear_path=True)`: blocks that leave along straight lines, past those that remain."""

from __future__ import annotations

import json

import numpy as np
import pytest
from typer.testing import CliRunner

import drystone as ds
from drystone.cli.app import app


def passes(scene: ds.Scene, name: str, others: tuple[str, ...], way: tuple[float, float]) -> bool:
    """Whether a body moved step by step overlaps none of the others, by the contacts of a scene."""
    bodies = {body.name: body for body in scene.bodies}
    there = [body for body in scene.bodies if body.fixed or body.name in others]
    corners = np.concatenate([body.vertices for body in scene.bodies])
    far = float(np.linalg.norm(np.ptp(corners, axis=0)))
    step = 0.1 * float(np.min(np.ptp(bodies[name].vertices, axis=0)))
    for distance in np.arange(0.0, far, step):
        part = ds.Scene(gravity=scene.gravity, friction=0.5)
        for body in there:
            part.add_polygon(body.vertices, name=body.name, fixed=True)
        moved = bodies[name].vertices + distance * np.asarray(way)
        part.add_polygon(moved, name=name)
        try:
            part.contacts  # noqa: B018
        except ds.SceneError:
            return False
    return True


def verify(plan: ds.Plan) -> None:
    assert plan.found
    assert len(plan.directions) == len(plan.order)
    for k, (name, way) in enumerate(zip(plan.order, plan.directions, strict=True)):
        assert np.hypot(*way) == pytest.approx(1.0)
        assert passes(plan.scene, name, plan.order[k + 1 :], way), (name, way)
        assert ds.check(plan.scene, plan.order[k:]).stable or plan.holds[k]


def dovetail(jaw_fixed: bool) -> ds.Scene:
    """A block that is wider below, between two jaws that lean over it."""
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, -0.5), (8, 1), name="floor", fixed=True)
    scene.add_polygon([(-3, 0), (-1, 0), (-0.5, 1), (-3, 1)], name="wall", fixed=True)
    scene.add_polygon([(1, 0), (3, 0), (3, 0.5), (0.75, 0.5)], name="jaw", fixed=jaw_fixed)
    scene.add_polygon([(-1, 0), (1, 0), (0.5, 1), (-0.5, 1)], name="tongue")
    return scene


@pytest.mark.parametrize(
    "scene",
    [
        ds.scenes.wall(3, 3),
        ds.scenes.five_blocks(),
        ds.scenes.pyramid(4),
        ds.scenes.random_stack(14),
        ds.scenes.random_stack(14, seed=3),
    ],
)
def test_every_block_leaves_along_its_line(scene: ds.Scene) -> None:
    verify(ds.plan(scene, clear_path=True))


def test_an_arch_comes_down_by_lines_and_a_hand() -> None:
    plan = ds.plan(ds.scenes.arch(7), hold=1, clear_path=True)
    verify(plan)
    assert plan.directions[0][1] > 0.5


def test_a_tongue_between_fixed_jaws_is_locked() -> None:
    plan = ds.plan(dovetail(True), clear_path=True)
    assert (plan.status, plan.order, plan.tests) == ("locked", (), 0)
    (blocked,) = plan.blocked
    assert blocked.name == "tongue"
    assert set(blocked.by) == {"floor", "wall", "jaw"}
    for way, by in blocked.ways:
        assert by
        assert not passes(plan.scene, "tongue", (), way)
    assert "tongue (blocked by" in str(plan)
    assert ds.plan(dovetail(True)).found


def test_a_jaw_leaves_before_the_tongue() -> None:
    scene = dovetail(False)
    assert ds.plan(scene).order == ("tongue", "jaw")
    for shortcuts in (True, False):
        plan = ds.plan(scene, clear_path=True, shortcuts=shortcuts)
        assert plan.order == ("jaw", "tongue")
        verify(plan)


def test_blocks_lock_one_another_in() -> None:
    """Either half of a tongue could leave along its jaw, were it not for the other."""
    scene = ds.Scene(friction=0.5)
    for body in dovetail(True).bodies:
        if body.fixed:
            scene.add_polygon(body.vertices, name=body.name, fixed=True)
    scene.add_polygon([(-1, 0), (0, 0), (0, 1), (-0.5, 1)], name="left")
    scene.add_polygon([(0, 0), (1, 0), (0.5, 1), (0, 1)], name="right")
    plan = ds.plan(scene, clear_path=True)
    assert plan.status == "locked"
    left, right = plan.blocked
    assert "right" in left.by
    assert "left" in right.by
    for one, other in ((left, "right"), (right, "left")):
        alone = [way for way, by in one.ways if by == (other,)]
        assert alone
        assert all(passes(scene, one.name, (), way) for way in alone)


def test_given_directions_come_first() -> None:
    scene = ds.scenes.column(3)
    plan = ds.plan(scene, clear_path=True, directions=[(3.0, 4.0)])
    assert np.allclose(plan.directions, [(0.6, 0.8)] * 2)
    plan = ds.plan(scene, clear_path=True, directions=[(0, -1)])
    assert plan.directions == ((0.0, 1.0),) * 2


def test_bad_directions_are_errors(block: ds.Scene) -> None:
    for bad in [(0.0, 0.0), (float("nan"), 1.0), (float("inf"), 1.0)]:
        with pytest.raises(ds.SceneError, match="directions"):
            ds.plan(block, clear_path=True, directions=[bad])
    with pytest.raises(ValueError, match="clear_path"):
        ds.plan(block, directions=[(1, 0)])


def test_the_command_line_tells_the_directions(tmp_path: object) -> None:
    run = CliRunner().invoke(app, ["plan", "column:4", "--clear-path"], standalone_mode=False)
    assert run.return_value == 0
    assert "leaving towards" in run.output
    assert "3 x (0,1)" in run.output
    run = CliRunner().invoke(app, ["plan", "column:4", "--clear-path", "--json"])
    assert json.loads(run.output)["directions"] == [[0.0, 1.0]] * 3


def test_in_space_a_plank_is_held_and_blocks_leave_upward() -> None:
    scene = ds.Scene(dimension=3, friction=0.5)
    scene.add_box((0, 0, 0.5), (1, 1, 1), fixed=True, name="pier")
    scene.add_box((0.6, 0, 1.1), (2, 1, 0.2), name="plank")
    scene.add_box((0, 0, 1.6), (0.8, 0.8, 0.8), name="weight")
    assert ds.plan(scene, clear_path=True).status == "no_order"
    plan = ds.plan(scene, hold=1, clear_path=True, directions=[(0, 0, 2)])
    assert (plan.order, plan.holds) == (("weight", "plank"), ((), ("plank",)))
    assert plan.directions == ((0.0, 0.0, 1.0),) * 2
    with pytest.raises(ValueError, match="three numbers"):
        ds.plan(scene, clear_path=True, directions=[(0, 1)])
