"""Pages of answers: how blocks follow a settlement, how they begin to fall or to collapse."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import drystone as ds
from conftest import Ran
from drystone.recording.contract import ABSENT, FALLING, PRESENT
from test_settlement import beam

Cli = Callable[..., Ran]


@pytest.mark.parametrize("space", [False, True])
def test_a_settlement_is_played_enlarged_from_the_forces_before_to_those_after(space: bool) -> None:
    """A beam of 4 m whose right support sinks by 1 cm turns about the left one's edge."""
    scene = beam(space=space)
    verdict = ds.check(scene)
    settled = verdict.settled
    assert settled is not None
    shown = verdict.view().recording
    assert (shown.kind, shown.dimension) == ("motion", scene.dimension)
    assert shown.poses is not None
    assert shown.forces is not None
    d = scene.dimension
    first, last = shown.poses[0], shown.poses[-1]
    own = np.array([body.center_of_mass for body in scene.bodies])
    assert first[:, :d] == pytest.approx(own)
    moved = dict(zip(scene.names, last[:, :d] - own, strict=True))
    factor = moved["right"][d - 1] / -0.01
    assert factor >= 5
    assert moved["left"] == pytest.approx(0)
    assert moved["beam"] == pytest.approx(factor * settled.displacement("beam")[:d])
    assert f"displacements {factor:g} times as large" in shown.captions[1][1]
    if space:
        assert np.linalg.norm(shown.poses[:, :, 3:], axis=2) == pytest.approx(1)
    else:
        assert last[2, 2] == pytest.approx(factor * settled.displacement("beam")[2])
    count = len(verdict.forces)
    vectors, points = np.asarray(shown.forces.vectors), np.asarray(shown.forces.points)
    assert settled.forces is not None
    assert vectors[:count] == pytest.approx(verdict.forces.vectors)
    assert points[:count] == pytest.approx(verdict.forces.points)
    assert vectors[-count:] == pytest.approx(settled.forces.vectors)
    assert any("beam" in note and "opens by" in note for note in shown.notes)
    alone = settled.view().recording
    assert np.array_equal(np.asarray(alone.poses), shown.poses)
    assert alone.forces is not None
    assert np.asarray(alone.forces.offsets)[1] == 0, "forces before it are the verdict's to know"


def test_supports_that_squeeze_a_block_are_one_frame_with_that_block_in_red() -> None:
    scene = ds.Scene(friction=0.5)
    for name, x in (("left", -1), ("right", 1)):
        scene.add_box((x, 0.5), (1, 1), name=name, fixed=True)
    scene.add_box((0, 0.5), (1, 1), name="between")
    scene.add_box((0, -0.5), (3, 1), name="ground", fixed=True)
    scene.add_settlement("right", (-0.01, 0))
    shown = ds.check(scene).view().recording
    assert shown.states.tolist() == [[PRESENT, PRESENT, FALLING, PRESENT]]
    assert "squeezed" in shown.captions[0][1]


def test_what_falls_begins_to_move_in_red_from_a_frame_with_forces() -> None:
    scene = ds.scenes.inverted_triangle(3)
    verdict = ds.check(scene, ["1", "2", "3", "4", "6"])
    assert not verdict.stable
    shown = verdict.view().recording
    assert shown.poses is not None
    assert shown.forces is not None
    states = dict(zip(scene.names, shown.states[-1].tolist(), strict=True))
    assert {name for name, state in states.items() if state == FALLING} == set(verdict.falling)
    assert states["5"] == ABSENT
    away = shown.poses[-1] - shown.poses[0]
    rows = {name: away[scene.names.index(name)] for name in verdict.names}
    largest = max(verdict.falling, key=lambda name: np.abs(verdict.acceleration(name)).max())
    factor = np.linalg.norm(rows[largest]) / np.linalg.norm(verdict.acceleration(largest))
    for name, row in rows.items():
        assert row == pytest.approx(factor * verdict.acceleration(name), abs=1e-12)
    assert np.diff(np.asarray(shown.forces.offsets)).tolist() == [
        len(verdict.forces),
        *[0] * (len(shown.states) - 1),
    ]


def test_every_answer_has_a_page(tmp_path: Path) -> None:
    tower = ds.scenes.column(4, friction=0.6)
    hung = ds.Scene(friction=1.0)
    for name, x in (("left", -1.0), ("right", 1.0)):
        hung.add_box((x, 0.0), (1, 3), name=name, fixed=True)
    hung.add_box((0.0, 0.0), (1, 1), name="block")
    escape = ds.check(hung, strong=True).escape
    assert escape is not None
    answers = {
        "stands": (ds.check(tower), False),
        "limit": (ds.limit(tower, gravity=(9.81, 0)), True),
        "margin": (ds.margin(tower), True),
        "structure": (ds.Structure(tower, ["1"]), False),
        "escape": (escape, True),
    }
    for name, (answer, moves) in answers.items():
        path = tmp_path / f"{name}.html"
        answer.draw(path)
        assert path.read_text(encoding="utf-8").startswith("<!doctype html>")
        frames = len(answer.view().recording.states)
        assert (frames > 1) == moves, name


def test_the_page_of_a_limit_has_the_push_as_a_load() -> None:
    limit = ds.limit(ds.scenes.column(4, friction=0.6), push={"3": (1.0, 0.0)})
    (load,) = limit.view().recording.loads
    assert (load.body, *load.force) == ("3", limit.factor, 0.0)


def test_commands_write_pages(cli: Cli, tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    scene = tmp_path / "beam.json"
    beam().without_settlements().save(scene)
    for command in (
        ("check", str(scene), "--settle", "right:0,-0.01"),
        ("limit", "column:4,friction=0.6", "--gravity", "9.81,0"),
        ("margin", "column:4,friction=0.6"),
    ):
        path.unlink(missing_ok=True)
        ran = cli(*command, "-o", str(path))
        assert ran.status == 0, ran
        assert "page" in ran.out
        assert '"kind":"motion"' in path.read_text(encoding="utf-8")
