"""A live structure answers as `check` does, whatever came and went before."""

from __future__ import annotations

import random

import numpy as np
import pytest

import drystone as ds


def stacks() -> list[ds.Scene]:
    return [
        ds.scenes.pyramid(5),
        ds.scenes.wall(5, 4, seed=2, friction=0.6),
        ds.scenes.arch(9, thickness=0.25, friction=0.8),
        ds.scenes.random_stack(25, seed=4),
        ds.scenes.random_stack(25, seed=5, friction=0.5),
    ]


@pytest.mark.parametrize("scene", stacks(), ids=("pyramid", "wall", "arch", "stack", "rough stack"))
def test_it_answers_as_a_fresh_check(scene: ds.Scene) -> None:
    draw = random.Random(1)
    structure = ds.Structure(scene)
    movable = [body.name for body in scene.bodies if not body.fixed]
    seen = {True: 0, False: 0}
    for _ in range(120):
        missing = [name for name in movable if name not in structure.blocks]
        if missing and draw.random() < 0.75:
            structure.add(draw.choice(missing[:3] if draw.random() < 0.9 else missing))
        elif structure.blocks:
            last = structure.blocks[-3:] if draw.random() < 0.7 else structure.blocks
            structure.remove(draw.choice(last))
        fresh = ds.check(scene, blocks=structure.blocks)
        assert structure.stands() == fresh.stable
        seen[fresh.stable] += 1
        if draw.random() < 0.3:
            verdict = structure.check()
            assert (verdict.stable, verdict.falling) == (fresh.stable, fresh.falling)
            assert verdict.residual <= 1e-9
            assert verdict.names == fresh.names
            np.testing.assert_allclose(verdict.accelerations, fresh.accelerations, atol=1e-6)
    assert seen[True] > 10


def test_work_of_one_block_more_does_not_grow_with_the_height() -> None:
    pivots = []
    for n in (20, 200):
        scene = ds.scenes.column(n)
        structure = ds.Structure(scene, [str(k) for k in range(1, n - 1)])
        assert structure.stands()
        before = structure.pivots
        structure.add(str(n - 1))
        assert structure.stands()
        pivots.append(structure.pivots - before)
    assert pivots == [2, 2]


def test_the_scene_may_change_afterwards() -> None:
    scene = ds.scenes.column(3)
    structure = ds.Structure(scene, ["1"])
    scene.add_box((10.0, 10.0), (1.0, 1.0), name="late")
    assert structure.stands()
    assert structure.check().names == ("1",)
    with pytest.raises(ds.SceneError, match="late"):
        structure.add("late")


def test_names() -> None:
    scene = ds.scenes.five_blocks()
    structure = ds.Structure(scene)
    structure.add("1", "1")
    structure.remove("2")
    assert structure.blocks == ("1",)
    assert repr(structure) == "<Structure: 1 of 5 blocks>"
    with pytest.raises(ds.SceneError, match='"7"'):
        structure.add("7")
    with pytest.raises(ds.SceneError, match=r"ground.*fixed"):
        structure.remove("ground")
    assert structure.blocks == ("1",)
