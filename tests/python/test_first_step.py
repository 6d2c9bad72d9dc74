"""The first step of a world takes about as long as a check: work is counted, not timed."""

from __future__ import annotations

import drystone as ds


def test_what_bears_straight_down_takes_no_pivot() -> None:
    scene = ds.scenes.brick_wall(rows=20, columns=25)
    world = ds.World(scene)
    record = world.step()
    assert all(record.motionless)
    assert (record.pivots, record.exact) == (0, True)
    assert record.friction_error < 1e-12


def test_the_next_step_goes_on_from_it() -> None:
    """Impulses straight across the joints are no basis; one is found when something moves."""
    world = ds.World(ds.scenes.pyramid(20, friction=0.6))
    first = world.step()
    assert all(first.motionless)
    top = world.scene.bodies[-1].name
    world.apply_force(top, (30, 0))
    second = world.step()
    moved = [k for k, still in enumerate(second.motionless) if not still]
    assert moved == [len(world.scene.bodies) - 1]
    assert second.rows_reused > 500
    assert second.exact


def test_many_blocks_that_fall_at_once_take_few_pivots() -> None:
    scene = ds.scenes.brick_wall(5, 5).with_gravity((0, 12, -9.81))
    record = ds.World(scene).step()
    assert record.rows > 1000
    assert sum(record.motionless) == 1
    assert record.pivots < 300
    assert record.exact


def test_a_loose_brick_on_a_wall_that_stands_takes_few_pivots() -> None:
    """What falls at once need not be much: pivots from nothing took seconds."""
    scene = ds.scenes.brick_wall(8, 8)
    right, _, top = scene.bodies[-1].vertices.max(axis=0)
    scene.add_box((right + 0.4, 0, top + 0.25), (1.6, 0.5, 0.5), name="loose")
    world = ds.World(scene)
    records = [world.step() for _ in range(10)]
    assert records[0].rows > 4000
    assert records[0].pivots < 600
    assert all(record.exact for record in records)
    still = dict(zip(world.names, records[-1].motionless, strict=True))
    assert [name for name, still in still.items() if not still] == ["loose"]


def test_what_arrives_in_a_step_by_little_is_an_impact_too() -> None:
    """A cube at 9 m/s has a few cm/s more than its gap takes in a step: pivots took 30,946."""
    world = ds.World(ds.scenes.brick_wall(6, 4))
    world.add_box((2, -4, 1.5), (0.6, 0.6, 0.6), name="thrown", density=3)
    world.set_velocity("thrown", (0, 9, 0, 0, 0, 0))
    records = [world.step() for _ in range(100)]
    assert max(record.pivots for record in records) < 500
    assert sum(not still for still in records[-1].motionless) > 20
