"""Falling blocks that bear on nothing: what they would have to reach, and how far it is."""

import json

import pytest

import drystone as ds


def tower(gap: float, dimension: int) -> ds.Scene:
    """Two unit blocks on the ground, and a third that hangs over them by `gap`."""
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, -0.5), (4, 1), fixed=True, name="ground")
    scene.add_box((0, 0.5), (1, 1), name="1")
    scene.add_box((0, 1.5), (1, 1), name="2")
    scene.add_box((0, 2.5 + gap), (1, 1), name="3")
    return scene if dimension == 2 else scene.extruded(1.0)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_block_that_touches_nothing_is_named_with_what_is_nearest(dimension: int) -> None:
    verdict = ds.check(tower(0.25, dimension))
    assert verdict.falling == ("3",)
    (block,) = verdict.unsupported
    assert (block.name, block.touches, block.nearest) == ("3", (), "2")
    assert block.distance == pytest.approx(0.25, abs=1e-12)
    assert verdict.near_misses == ()
    assert 'Block "3" touches nothing; "2" is 0.25 m away.' in str(verdict)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_gap_within_ten_tolerances_says_which_tolerance_would_do(dimension: int) -> None:
    scene = tower(4e-6, dimension)
    verdict = ds.check(scene)
    (miss,) = verdict.near_misses
    assert (miss.a, miss.b) == ("2", "3")
    assert miss.gap == pytest.approx(4e-6, rel=1e-6)
    assert miss.contact_tolerance == pytest.approx(1e-5)
    said = 'With contact_tolerance=1e-05 "2" would touch "3": gap 4e-06 m.'
    assert said in str(verdict)
    # And it is so.
    loose = json.loads(scene.to_json()) | {"contact_tolerance": 1e-5}
    assert ds.check(ds.Scene.from_json(json.dumps(loose))).stable
    plan = ds.plan(scene)
    assert plan.status == "whole_falls"
    assert said in str(plan)
    assert said in str(ds.Structure(scene, ["1", "2", "3"]).check())
    # Twenty tolerances are a gap that is meant.
    assert ds.check(tower(2e-5, dimension)).near_misses == ()


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_block_that_only_leans_on_a_wall_bears_on_nothing(dimension: int) -> None:
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, 0), (1, 4), fixed=True, name="wall")
    scene.add_box((1, 0), (1, 1), name="1")
    verdict = ds.check(scene if dimension == 2 else scene.extruded(1.0))
    (block,) = verdict.unsupported
    assert (block.touches, block.nearest, block.distance) == (("wall",), None, None)
    assert 'Block "1" touches "wall" only, not from above.' in str(verdict)


def test_only_bodies_that_are_there_count_and_what_stands_says_nothing() -> None:
    scene = tower(0.25, 2)
    (block,) = ds.check(scene, ["1", "3"]).unsupported
    assert (block.nearest, block.distance) == ("1", pytest.approx(1.25))
    standing = ds.check(scene, ["1", "2"])
    assert (standing.unsupported, standing.near_misses) == ((), ())
    toppling = ds.check(ds.scenes.harmonic_stack(overhang_factor=1.2))
    assert toppling.falling
    assert toppling.unsupported == ()


def test_verdicts_as_json_say_it_too() -> None:
    found = json.loads(json.dumps(ds.check(tower(4e-6, 2)).to_dict()))
    assert [block["name"] for block in found["unsupported"]] == ["3"]
    assert found["near_misses"][0]["b"] == "3"
