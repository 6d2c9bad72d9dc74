"""Supports that settle: linear programs on the same cones, closed forms, files and pictures."""

from __future__ import annotations

import copy
import itertools
import json
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import highspy
import numpy as np
import pytest
from numpy.typing import NDArray

import drystone as ds
from conftest import Ran
from drystone import _core
from drystone.statics import QuietHighs

Cli = Callable[..., Ran]


def beam(*, space: bool = False) -> ds.Scene:
    """A beam of 4 m on two supports, half a metre of it on each; the right one sinks by 1 cm."""
    scene = ds.Scene(friction=0.5)
    for name, x in (("left", -2.0), ("right", 2.0)):
        scene.add_box((x, -0.5), (1, 1), name=name, fixed=True)
    scene.add_box((0, 0.2), (4, 0.4), name="beam")
    scene.add_settlement("right", (0, -0.01))
    return scene.extruded(1.0) if space else scene


def on_supports(whole: ds.Scene, joints: list[float], friction: float) -> ds.Scene:
    """A planar scene on one ground, with that ground cut into supports "s0", "s1", ..."""
    scene = ds.Scene(friction=friction)
    (ground,) = (body for body in whole.bodies if body.fixed)
    (left, bottom), (right, top) = ground.vertices.min(axis=0), ground.vertices.max(axis=0)
    ends = [left, *joints, right]
    for k, (a, b) in enumerate(itertools.pairwise(ends)):
        scene.add_polygon([(a, bottom), (b, bottom), (b, top), (a, top)], f"s{k}", fixed=True)
    for body in whole.bodies:
        if not body.fixed:
            assert isinstance(body, ds.Body)
            scene.add_polygon(body.vertices, body.name, mass=body.mass)
    return scene


def by_highs(scene: ds.Scene, cones: tuple[int, str] = (8, "inscribed")) -> float | None:
    """Most work of the loads over G' u + c >= 0 by HiGHS; None if there is no such u.

    c is taken from the scene in which the supports that settle are movable: their rows of G times
    their displacements.
    """
    document = json.loads(scene.to_json())
    moved: dict[str, NDArray[np.float64]] = {}
    for body in document["bodies"]:
        for settlement in body.pop("settlements", []):
            none = [0.0] if scene.dimension == 2 else [0.0] * 3
            turn = np.atleast_1d(settlement.get("rotation", none))
            assert not np.any(settlement["at"])
            body["fixed"] = False
            row = np.concatenate([settlement["displacement"], turn])
            moved[body["name"]] = moved.get(body["name"], np.zeros(len(row))) + row
    g = _core.generators(ds.Scene.from_json(json.dumps(document))._core, cones)
    size = len(g.applied) // len(g.names)
    u_s = np.concatenate([moved.get(name, np.zeros(size)) for name in g.names])
    c = np.add.reduceat(g.data * u_s[g.indices], g.indptr[:-1])
    free = np.repeat([name not in moved for name in g.names], size)
    ours = free[g.indices]
    of = np.repeat(np.arange(len(c)), np.diff(g.indptr))[ours]
    rows, starts = np.unique(of, return_index=True)
    columns = (np.cumsum(free) - 1)[g.indices[ours]]
    unit = np.abs(c).max(initial=0.0) or 1.0
    highs = QuietHighs()
    highs.setOptionValue("threads", 1)  # as everywhere: HiGHS has one pool for a process
    load, infinite = g.applied[free], np.full(max(len(c), len(g.applied)), highspy.kHighsInf)
    nothing, no_starts = np.zeros(0, dtype=np.int32), np.zeros(len(load), dtype=np.int32)
    bounds = (-infinite[: len(load)], infinite[: len(load)])
    highs.addCols(len(load), -load, *bounds, 0, no_starts, nothing, np.zeros(0))
    where = (starts.astype(np.int32), columns.astype(np.int32))
    lower = -c[rows] / unit
    highs.addRows(len(rows), lower, infinite[: len(rows)], len(columns), *where, g.data[ours])
    highs.run()
    status = highs.getModelStatus()
    if status == highspy.HighsModelStatus.kInfeasible:
        return None
    assert status == highspy.HighsModelStatus.kOptimal
    return -unit * float(highs.getInfo().objective_function_value)


def obeys(settled: ds.Settled) -> None:
    """The proofs of an answer: no contact closes, the forces hold, and work and bound agree."""
    assert settled.status == "solved"
    assert settled.closing < 1e-7
    assert settled.imbalance < 1e-7
    assert settled.bound == pytest.approx(settled.work, rel=1e-7, abs=1e-12)


def test_linear_programs_agree() -> None:
    rng = np.random.default_rng(14)
    solved = squeezed = 0
    for k in range(60):
        friction = float(rng.choice([0.0, 0.4, 0.7]))
        if k % 3 == 0 and friction > 0.5:
            whole = ds.scenes.arch(int(rng.integers(5, 16)), thickness=0.25, friction=friction)
            joints = [0.0]
        else:
            whole = ds.scenes.wall(int(rng.integers(2, 6)), 4, friction=friction, seed=k)
            joints = sorted(rng.uniform(0.2, 3.8, size=2).tolist())
        scene = on_supports(whole, joints, friction)
        if k % 4 == 1:  # a wall between two others, of which one comes nearer or goes away
            ends = np.concatenate([b.vertices for b in scene.bodies if not b.fixed])[:, 0]
            for name, x in (("before", ends.min() - 0.5), ("behind", ends.max() + 0.5)):
                scene.add_box((x, 1.5), (1, 3), name=name, fixed=True)
            scene.add_settlement("behind", (0.02 * rng.uniform(-1, 1), 0))
        for name in ("s0", "s1"):
            move = 0.02 * rng.uniform(-1, 1, size=2)
            scene.add_settlement(name, move.tolist(), float(0.02 * rng.uniform(-1, 1)))
        settled = ds.check(scene).settled
        assert settled is not None
        most = by_highs(scene)
        if most is None:
            assert settled.status == "no_solution"
            assert settled.squeezed
            squeezed += 1
        else:
            obeys(settled)
            assert settled.work == pytest.approx(most, rel=1e-6, abs=1e-8)
            solved += 1
    assert solved >= 20
    assert squeezed >= 3


@pytest.mark.parametrize("cone", ["round", "inscribed"])
def test_in_space_too(cone: Any) -> None:
    rng = np.random.default_rng(15)
    for _ in range(6):
        flat = on_supports(ds.scenes.wall(3, 3, friction=0.6), [1.3], 0.6)
        scene = flat.extruded(0.5)
        scene.add_settlement("s1", 0.01 * rng.uniform(-1, 1, size=3) + (0.01, 0.0, -0.01))
        settled = ds.check(scene, cone=cone).settled
        assert settled is not None
        obeys(settled)
        assert settled.forces is not None
        most = by_highs(scene)
        assert most is not None
        if cone == "inscribed":
            assert settled.work == pytest.approx(most, rel=1e-6)
            assert settled.forces.kind == "canonical"
        else:  # round cones bear more, and what slides opens in more directions: less work
            assert most - 0.1 * abs(most) < settled.work <= most + 1e-6 * abs(most)


def test_a_settlement_twice_as_large_moves_twice_as_far_under_the_same_forces() -> None:
    once, twice = beam(), beam()
    twice.add_settlement("right", (0, -0.01))
    a, b = ds.check(once).settled, ds.check(twice).settled
    assert a is not None
    assert b is not None
    assert a.forces is not None
    assert b.forces is not None
    assert 2 * a.displacements == pytest.approx(b.displacements, abs=1e-12)
    assert a.forces.vectors == pytest.approx(b.forces.vectors, abs=1e-9)


def test_tiny_settlements_have_as_many_digits() -> None:
    settled = {}
    for size in (1e-9, 1e-2):
        scene = on_supports(ds.scenes.wall(4, 4, friction=0.5), [1.7], 0.5)
        scene.add_settlement("s1", (0.3 * size, -size))
        found = ds.check(scene).settled
        assert found is not None
        obeys(found)
        settled[size] = found
    small, large = settled.values()
    assert 1e7 * small.displacements == pytest.approx(large.displacements, abs=1e-9)
    assert [j.opening for j in small.joints] == [j.opening for j in large.joints]


def test_the_forces_before_are_those_without_the_settlement() -> None:
    scene = beam()
    verdict, plain = ds.check(scene), ds.check(scene.without_settlements())
    assert plain.settled is None
    assert (verdict.forces.vectors == plain.forces.vectors).all()
    assert (
        ds.limit(scene, gravity=(9.81, 0)).bounds
        == ds.limit(scene.without_settlements(), gravity=(9.81, 0)).bounds
    )
    assert ds.plan(scene).order == ds.plan(scene.without_settlements()).order


def test_what_falls_has_no_settlement() -> None:
    scene = beam()
    scene.add_box((5, 5), (1, 1), name="loose")
    assert ds.check(scene).settled is None
    settled = ds.check(scene, ["beam"]).settled
    assert settled is not None
    assert settled.names == ("beam",)


def test_a_scene_keeps_its_settlements(tmp_path: Path) -> None:
    for scene in (beam(), beam(space=True)):
        scene.save(tmp_path / "scene.json")
        for other in (
            ds.Scene.load(tmp_path / "scene.json"),
            copy.copy(scene),
            pickle.loads(pickle.dumps(scene)),
            scene.with_gravity(scene.gravity),
        ):
            assert other.settlements == scene.settlements
        assert scene.settlements[0].body == "right"
    assert beam().settlements[0] == ds.Settlement("right", (0.0, -0.01), 0.0, (2.0, -0.5))
    assert "1 settlement" in repr(beam())


def test_old_files_are_read() -> None:
    document = json.loads(beam().without_settlements().to_json())
    assert document["version"] == 1
    assert not ds.Scene.from_json(json.dumps({**document, "version": 2})).settlements


def test_bad_settlements_say_what_to_mend() -> None:
    scene = beam()
    for call, words in [
        (lambda: scene.add_settlement("beam", (0, 0.1)), "not fixed"),
        (lambda: scene.add_settlement("rigt", (0, 0.1)), 'did you mean "right"'),
        (lambda: scene.add_settlement("right", (0, float("nan"))), "displacement"),
        (lambda: scene.add_settlement("right", (0, 0), rotation=2.0), "radians"),
        (lambda: scene.add_settlement("right", (0, 0, 0)), "two numbers"),
    ]:
        with pytest.raises(ds.SceneError, match=words):
            call()
    with pytest.raises(TypeError, match="rotation"):
        scene.add_settlement("right", (0, 0), rotation=(1, 2))
    assert len(scene.settlements) == 1
    with pytest.raises(ds.SimulationError, match="without_settlements"):
        ds.simulate(scene, 0.1)


@pytest.mark.parametrize("space", [False, True])
def test_a_picture_shows_where_blocks_go(space: bool, tmp_path: Path) -> None:
    settled = ds.check(beam(space=space)).settled
    assert settled is not None
    settled.draw(tmp_path / "settled.svg")
    picture = (tmp_path / "settled.svg").read_text()
    assert "2 hinges" in picture
    assert "times as large" in picture


def test_a_picture_of_what_cannot_follow(tmp_path: Path) -> None:
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, -0.5), (3, 1), name="floor", fixed=True)
    scene.add_box((0, 0.5), (1, 1), name="between")
    scene.add_box((-1, 0.5), (1, 1), name="left", fixed=True)
    scene.add_box((1, 0.5), (1, 1), name="right", fixed=True)
    scene.add_settlement("right", (-0.01, 0))
    for given in (scene, scene.extruded(1.0)):
        settled = ds.check(given).settled
        assert settled is not None
        assert settled.status == "no_solution"
        assert settled.squeezed == ("between", "left", "right")
        assert settled.to_dict()["work"] is None
        settled.draw(tmp_path / "squeezed.svg")


def test_on_the_command_line(cli: Cli, tmp_path: Path) -> None:
    path = tmp_path / "beam.json"
    beam().without_settlements().save(path)
    ran = cli("check", path, "--settle", "right:0,-0.01", "-o", tmp_path / "beam.svg")
    assert ran.status == 0
    assert "2 hinges" in ran.out
    ran = cli("check", path, "--settle", "right:0,-0.01,0.001", "--json")
    found = json.loads(ran.out)["settled"]
    assert found["status"] == "solved"
    assert found["settlements"][0]["rotation"] == 0.001
    for text, words in [("right:0", "2 numbers"), ("right:0,x", "numbers"), ("rigt:0,0", "right")]:
        ran = cli("check", path, "--settle", text)
        assert ran.status == 2
        assert words in ran.err


def test_what_moves_as_a_whole_does_no_work_and_opens_no_joint() -> None:
    arch = ds.scenes.arch(voussoirs=15, thickness=0.3)
    arch.add_settlement("ground", (0.02, 0))
    settled = ds.check(arch).settled
    assert settled is not None
    assert settled.joints == ()
    assert "0 joints open (0 hinges); the loads do 0 J;" in str(settled)


def test_millimetres_are_warned_of() -> None:
    scene = beam().without_settlements()
    with pytest.warns(UserWarning, match="displacement is 10 m, .* in metres"):
        scene.add_settlement("right", (0, -10))
