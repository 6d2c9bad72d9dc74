"""Scenes as users build them, and what they are told when one cannot be built."""

from __future__ import annotations

import _thread
import copy
import pickle
import signal
import threading
from pathlib import Path

import numpy as np
import pytest

import drystone as ds


def test_a_box_has_the_mass_and_inertia_of_a_rectangle(block: ds.Scene) -> None:
    body = block.body("block")
    assert (body.mass, body.inertia) == pytest.approx((2.0, 2.0 * (1 + 1) / 12))
    assert body.centroid == pytest.approx((0, 0.5))
    assert not body.fixed
    assert body.vertices == pytest.approx(np.array([[-0.5, 0], [0.5, 0], [0.5, 1], [-0.5, 1]]))


def test_a_triangle_has_the_centroid_of_its_corners() -> None:
    scene = ds.Scene()
    scene.add_polygon([(0, 0), (3, 0), (0, 3)], name="t", density=4.0)
    assert scene.body("t").centroid == pytest.approx((1, 1))
    assert scene.body("t").mass == pytest.approx(4 * 4.5)


def test_a_face_contact_has_both_ends_of_the_shared_segment(block: ds.Scene) -> None:
    contacts = block.contacts
    assert sorted(contact.point for contact in contacts) == [(-0.5, 0.0), (0.5, 0.0)]
    for contact in contacts:
        assert {contact.a, contact.b} == {"ground", "block"}
        up = 1.0 if contact.b == "block" else -1.0
        assert contact.normal == pytest.approx((0.0, up))
        assert contact.gap == pytest.approx(0.0, abs=1e-12)
        assert contact.friction == 0.5
    assert len({contact.feature for contact in contacts}) == 2


def test_numbers_may_come_from_lists_and_arrays() -> None:
    scene = ds.Scene(gravity=[0, -1.62], friction=0)
    assert scene.add_box(np.array([0.0, 0.5]), [1, 1], name="box") == "box"
    scene.add_polygon(np.array([[2.0, 0.0], [3.0, 0.0], [2.5, 1.0]]), name="roof")
    assert scene.names == ["box", "roof"]
    assert (scene.gravity, scene.friction, len(scene)) == ((0.0, -1.62), 0.0, 2)


def test_a_box_turned_by_a_quarter_swaps_its_sides() -> None:
    scene = ds.Scene()
    scene.add_box((0, 0), (4, 2), angle=np.pi / 2, name="b")
    assert np.ptp(scene.body("b").vertices, axis=0) == pytest.approx([2, 4])


def test_unnamed_bodies_get_different_names() -> None:
    scene = ds.Scene()
    names = [scene.add_box((2 * i, 0), (1, 1)) for i in range(3)]
    assert len(set(names)) == 3
    assert scene.names == names


def test_a_saved_scene_is_the_same_scene(tmp_path: Path, block: ds.Scene) -> None:
    block.save(tmp_path / "scene.json")
    loaded = ds.Scene.load(tmp_path / "scene.json")
    assert loaded.to_json() == block.to_json() == (tmp_path / "scene.json").read_text()
    assert loaded.contacts == block.contacts
    assert pickle.loads(pickle.dumps(block)).to_json() == block.to_json()
    assert copy.deepcopy(block).to_json() == block.to_json()


def _ground(scene: ds.Scene) -> ds.Scene:
    scene.add_box((0, -0.5), (4, 1), name="ground", fixed=True)
    return scene


NAN = float("nan")
# What is done to a scene with a body "ground", and what the one-line error must say: the name of
# the thing, and what to do.
BAD = {
    "no such dimension": (lambda s: ds.Scene(dimension=4), ["dimension", "2", "3"]),
    "gravity that is not a number": (lambda s: ds.Scene(gravity=(0, NAN)), ["gravity"]),
    "negative friction": (lambda s: ds.Scene(friction=-1), ["friction", "-1"]),
    "center of three": (lambda s: s.add_box((0, 0, 0), (1, 1)), ["center", "two numbers"]),
    "nan center": (lambda s: s.add_box((NAN, 0), (1, 1), name="x"), ["x", "finite"]),
    "infinite size": (lambda s: s.add_box((0, 0), (np.inf, 1), name="x"), ["x", "finite"]),
    "negative size": (lambda s: s.add_box((0, 0), (1, -1), name="x"), ["x", "greater than zero"]),
    "no density": (
        lambda s: s.add_box((0, 2), (1, 1), name="x", density=0),
        ["x", "density", "greater than zero"],
    ),
    "a body's negative friction": (
        lambda s: s.add_box((0, 2), (1, 1), name="x", friction=-0.1),
        ["x", "friction"],
    ),
    "the same name": (lambda s: s.add_box((0, 2), (1, 1), name="ground"), ["ground", "differ"]),
    "empty name": (lambda s: s.add_box((0, 2), (1, 1), name=""), ["name", "empty"]),
    "two corners": (lambda s: s.add_polygon([(0, 0), (1, 0)], name="x"), ["x", "at least three"]),
    "not convex": (
        lambda s: s.add_polygon([(0, 2), (4, 2), (2, 2.5), (2, 6)], name="x"),
        ["x", "convex"],
    ),
    "no area": (lambda s: s.add_polygon([(0, 2), (1, 2), (2, 2)], name="x"), ["x", "area"]),
    "bow tie": (
        lambda s: s.add_polygon([(0, 2), (1, 3), (1, 2), (0, 3)], name="x"),
        ["x", "in order round the block"],
    ),
    "nan corner": (lambda s: s.add_polygon([(0, 2), (1, 2), (1, NAN)], name="x"), ["x"]),
    "unknown body": (lambda s: s.body("grund"), ["grund", "ground"]),
    "unknown block": (lambda s: ds.check(s, ["grund"]), ["grund", "ground"]),
    "overlap": (
        lambda s: (s.add_box((0, 0.4), (1, 1), name="x"), ds.check(s)),
        ["ground", "x", "overlap", "move them apart"],
    ),
    "unknown parameter": (
        lambda s: ds.scenes._built("column", m=3),
        ["column", "no parameter", "n"],
    ),
    "fraction of a block": (lambda s: ds.scenes.column(2.5), ["column", "whole number"]),
    "negative count": (lambda s: ds.scenes.pyramid(-3), ["pyramid", "rows"]),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_clear_error(case: str) -> None:
    provoke, parts = BAD[case]
    with pytest.raises(ds.SceneError) as caught:
        provoke(_ground(ds.Scene()))
    message = str(caught.value)
    assert "\n" not in message
    for part in parts:
        assert part in message
    assert isinstance(caught.value, ds.DrystoneError)
    assert isinstance(caught.value, ValueError)


def test_a_body_refused_leaves_the_scene_as_it_was(block: ds.Scene) -> None:
    before = block.to_json()
    with pytest.raises(ds.SceneError):
        block.add_box((5, 5), (1, -1))
    with pytest.raises(ds.SceneError):
        block.add_box((5, 5), (1, 1), name="block")
    assert block.to_json() == before


def _damage(text: str) -> dict[str, str]:
    return {
        "empty": "",
        "truncated": text[: len(text) // 2],
        "not a scene": "[1, 2, 3]",
        "another version": text.replace('"version": 1', '"version": 99'),
        "a key too many": text.replace('"version": 1', '"version": 1, "colour": "red"'),
    }


@pytest.mark.parametrize("case", _damage(""))
def test_a_damaged_file_is_one_error_that_names_it(
    case: str, block: ds.Scene, tmp_path: Path
) -> None:
    text = _damage(block.to_json())[case]
    assert text != block.to_json()
    path = tmp_path / "damaged.json"
    path.write_text(text)
    with pytest.raises(ds.SceneError, match=r"damaged\.json"):
        ds.Scene.load(path)


def test_a_missing_file_is_an_error_that_names_it(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"nowhere\.json"):
        ds.Scene.load(tmp_path / "nowhere.json")


def test_the_scenes_have_the_defaults_of_the_core() -> None:
    from drystone import _core

    assert [name for name, _, _ in _core.catalogue()] == ds.scenes.__all__
    for name in ds.scenes.__all__:
        assert getattr(ds.scenes, name)().to_json() == _core.Scene.built_in(name, {}).to_json()


def test_building_a_stack_lets_other_threads_run_and_can_be_interrupted() -> None:
    """A second or more of work, stopped by a thread that could not run beside it otherwise."""
    timer = threading.Timer(0.1, _thread.interrupt_main)
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            ds.scenes.random_stack(1000, seed=2)
    finally:
        timer.join()
        signal.signal(signal.SIGINT, handler)


def test_the_same_seed_gives_the_same_stack() -> None:
    first, again = ds.scenes.random_stack(20, seed=3), ds.scenes.random_stack(20, seed=3)
    assert first.to_json() == again.to_json()
    assert first.to_json() != ds.scenes.random_stack(20, seed=4).to_json()
