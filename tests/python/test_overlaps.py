"""Scenes whose bodies overlap have no contacts, but can be looked at."""

from collections.abc import Callable
from pathlib import Path

import pytest

import drystone as ds
from conftest import Ran
from drystone.recording.contract import FALLING, PRESENT


def overlapping(dimension: int) -> ds.Scene:
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, -0.5), (6, 1), fixed=True, name="ground")
    scene.add_box((0, 0.4), (1, 1), name="deep")
    scene.add_box((0.75, 0.5), (1, 1), name="beside")
    scene.add_box((-2, 0.5), (1, 1), name="fine")
    return scene if dimension == 2 else scene.extruded(1.0)


@pytest.mark.parametrize("dimension", [2, 3])
def test_every_pair_is_listed_with_its_depth(dimension: int) -> None:
    found = overlapping(dimension).overlaps
    assert [(pair.a, pair.b) for pair in found] == [("ground", "deep"), ("deep", "beside")]
    assert [pair.depth for pair in found] == pytest.approx([0.1, 0.25])
    assert ds.scenes.column(4).overlaps == []


@pytest.mark.parametrize("dimension", [2, 3])
def test_pictures_and_pages_show_them_in_red(dimension: int, tmp_path: Path) -> None:
    scene = overlapping(dimension)
    with pytest.raises(ds.SceneError, match=r"overlap by .*scene\.draw"):
        ds.check(scene)
    picture = scene._repr_svg_()
    assert "3 blocks, 2 overlaps" in picture
    assert "deep and beside: 0.25 m deep" in picture
    assert picture.count("#b8321a") >= 2
    if dimension == 2:
        assert "0.25 m<" in picture
        assert "0.1 m<" in picture
    scene.draw(tmp_path / "scene.png")
    scene.draw(tmp_path / "scene.html")
    assert "0.25 m deep" in (tmp_path / "scene.html").read_text(encoding="utf-8")
    page = scene.view()
    states = dict(zip(scene.names, page.recording.states[0].tolist(), strict=True))
    assert states == {"ground": FALLING, "deep": FALLING, "beside": FALLING, "fine": PRESENT}
    page.save_frames(tmp_path)


def test_a_scene_without_overlaps_looks_as_before() -> None:
    assert "3 blocks, 6 contact points" in ds.scenes.column(4)._repr_svg_()


def test_the_command_line_draws_a_file(cli: Callable[..., Ran], tmp_path: Path) -> None:
    file = tmp_path / "scene.json"
    overlapping(2).save(file)
    for name in ("a.svg", "a.png", "a.html"):
        assert cli("scene", file, "-o", tmp_path / name).status == 0
        assert (tmp_path / name).stat().st_size > 1000
    assert cli("scene", "draw", "column:3", "-o", tmp_path / "b.svg").status == 0
    assert cli("scene", "column", "--n", "3", "-o", tmp_path / "c.svg").status == 0
    assert (tmp_path / "c.svg").read_text(encoding="utf-8").startswith("<?xml")
    missing = cli("scene", "missing.json", "-o", tmp_path / "d.svg")
    assert missing.status == 2
    assert "missing.json" in missing.err


@pytest.mark.parametrize("dimension", [2, 3])
def test_they_are_taken_back(dimension: int) -> None:
    scene = overlapping(dimension)
    parted = scene.parted()
    assert parted.overlaps == []
    assert len(scene.overlaps) == 2
    assert ds.simulate(parted, steps=1).finished
    assert parted.parted().to_json() == parted.to_json()


def test_what_cannot_part_is_an_overlap() -> None:
    scene = ds.Scene(friction=0.5)
    for x in (-1, 1):
        scene.add_box((x, 0), (1, 20), fixed=True)
    scene.add_box((0, 0), (1.2, 1), name="jammed")
    with pytest.raises(ds.SceneError, match="overlap by"):
        scene.parted()
