"""What answers print and write: one line, a table on request, and JSON in pieces."""

from __future__ import annotations

import copy
import io
import json
import math
import pickle
import re

import numpy as np
import pytest

import drystone as ds
from drystone.common.json_text import Rows, write_json


def written(answer: ds.Verdict | ds.Plan) -> str:
    file = io.StringIO()
    answer.write_json(file)
    return file.getvalue()


ANSWERS = {
    "scene": lambda: ds.scenes.wall(5, 5),
    "stands": lambda: ds.check(ds.scenes.wall(5, 5)),
    "falls": lambda: ds.check(ds.scenes.arch(20, friction=0.0)),
    "forces": lambda: ds.check(ds.scenes.wall(5, 5)).forces,
    "plan": lambda: ds.plan(ds.scenes.wall(5, 5)),
    "run": lambda: ds.simulate(ds.scenes.fall7(), steps=60),
    "world": lambda: ds.World(ds.scenes.fall7()),
    "structure": lambda: ds.Structure(ds.scenes.wall(5, 5)),
    "body": lambda: ds.scenes.wall(5, 5).bodies[3],
    "solid": lambda: ds.scenes.brick_wall(3, 3).bodies[3],
}


@pytest.mark.parametrize("name", ANSWERS)
def test_an_answer_is_one_line_in_a_notebook(name: str) -> None:
    line = repr(ANSWERS[name]())
    assert "\n" not in line
    assert len(line) < 120


@pytest.mark.parametrize("method", ["equilibrium", "lcp", "interior"])
@pytest.mark.parametrize(
    "scene", [ds.scenes.wall(4, 4), ds.scenes.brick_wall(2, 3), ds.scenes.column(1)]
)
def test_arrays_and_objects_of_forces_are_the_same(scene: ds.Scene, method: str) -> None:
    forces = ds.check(scene, method=method).forces
    names = scene.names
    d = scene.dimension
    assert len(forces) == len(tuple(forces)) == len(forces.points)
    for k, force in enumerate(forces):
        assert [names[body] for body in forces.bodies[k]] == [force.a, force.b]
        assert tuple(forces.points[k]) == force.point
        assert tuple(forces.normals[k]) == force.normal
        assert tuple(forces.vectors[k]) == force.force
        assert forces.normal_forces[k] == force.normal_force
        assert forces.tangential_forces[k] == force.tangential_force
    assert forces.vectors.shape == (len(forces), d)
    with pytest.raises(ValueError, match="read-only"):
        forces.vectors[...] = 0.0


def test_forces_are_a_sequence() -> None:
    forces = ds.check(ds.scenes.column(3)).forces
    assert forces[-1] == forces[len(forces) - 1]
    assert forces[1:3] == (forces[1], forces[2])
    assert forces == tuple(forces)
    assert forces != tuple(forces)[:-1]
    assert forces != 3
    with pytest.raises(IndexError, match="contact point 4 of 4"):
        forces[4]
    assert copy.deepcopy(forces) == forces == pickle.loads(pickle.dumps(forces))


def test_bytes_that_are_no_forces_are_an_error() -> None:
    _, (state, kind) = ds.check(ds.scenes.column(3)).forces.__reduce__()
    with pytest.raises(ds.DrystoneError, match="no contact forces"):
        ds.ContactForces._again(state[: len(state) // 2], kind)


def test_an_answer_that_is_no_is_false() -> None:
    for scene in (ds.scenes.wall(2, 2), ds.scenes.arch(9, friction=0.0)):
        verdict, plan = ds.check(scene), ds.plan(scene)
        assert bool(verdict) is verdict.stable
        assert bool(plan) is plan.found
    assert not verdict
    assert not plan


def test_json_in_pieces_is_the_same_as_the_dictionary() -> None:
    scene = ds.Scene()
    scene.add_box((0, -0.5), (4, 1), name="ground", fixed=True)
    scene.add_box((0, 0.5), (1, 1), name='é"\\\t\U0001f9f1')
    verdict = ds.check(scene)
    assert json.loads(written(verdict)) == verdict.to_dict()
    assert written(verdict).isascii()
    assert verdict.to_dict()["forces"][0]["b"] == scene.names[1]
    for answer in (ds.check(ds.scenes.arch(20, friction=0.0)), ds.plan(ds.scenes.wall(4, 4))):
        assert json.loads(written(answer)) == answer.to_dict()


def test_json_of_anything() -> None:
    def text(value: object) -> str:
        file = io.StringIO()
        write_json(value, file)
        return file.getvalue()

    value = {"a": [], "b": [[1], [2]], "c": {}, "d": {"e": [{"f": None}]}, "g": [1, 2]}
    assert json.loads(text(value)) == value
    assert json.loads(text({"rows": Rows(iter(['{"a": 1}', "2,\n3"]))})) == {
        "rows": [{"a": 1}, 2, 3]
    }
    assert json.loads(text({"rows": Rows([])})) == {"rows": []}


def test_forces_of_many_pieces() -> None:
    forces = ds.check(ds.scenes.wall(8, 8)).forces
    pieces = list(forces.json_lines(together=7))
    assert len(pieces) == -(-len(forces) // 7)
    told = json.loads(f"[{','.join(pieces)}]")
    assert np.array([force["force"] for force in told]).tolist() == forces.vectors.tolist()


def test_tables_are_cut() -> None:
    verdict = ds.check(ds.scenes.wall(5, 5))
    assert len(verdict.table(3).splitlines()) == 2 + 3 + 1
    assert f"the first 3 of {len(verdict.forces)}" in verdict.table(3)
    with pytest.raises(ValueError, match="rows is -1"):
        verdict.table(-1)
    with pytest.raises(TypeError, match="rows must be a whole number"):
        verdict.table("3")  # type: ignore[arg-type]
    assert "the first" not in verdict.table(1000)
    assert "falls" in ds.check(ds.scenes.arch(20, friction=0.0)).table()
    plan = ds.plan(ds.scenes.column(4), clear_path=True)
    assert [line.split()[:2] for line in plan.table().splitlines()[2:]] == [
        [str(k + 1), name] for k, name in enumerate(plan.order)
    ]
    run = ds.simulate(ds.scenes.fall7(), steps=50)
    steps = [int(line.split()[0]) for line in run.table(5).splitlines()[2:7]]
    assert steps == [10, 20, 30, 40, 50]
    assert "5 of 50 steps" in run.table(5)
    assert len(ds.simulate(ds.scenes.fall7(), steps=0).table().splitlines()) == 2


def test_what_collapses_or_escapes_has_a_table() -> None:
    limit = ds.limit(ds.scenes.column(9, friction=2.0), gravity=(9.81, 0))
    for answer in (limit, limit.upper, ds.margin(ds.scenes.column(9, friction=2.0))):
        lines = answer.table(3).splitlines()
        assert [line.split()[0] for line in lines[2:5]] == ["1", "2", "3"]
        assert "x [m/s]" in lines[0]
        assert "the first 3 of 8; rows= shows more" in lines[5]
    space = ds.limit(ds.scenes.column(3).extruded(1.0), push={"2": (1, 0, 0)})
    assert "turns z [rad/s]" in space.table()
    escape = ds.check(ds.scenes.arch(8, friction=0.0), strong=True).escape
    assert escape is not None
    assert len(escape.table(2).splitlines()) == 2 + 2 + 1


def test_tables_do_not_show_what_rounding_left() -> None:
    """Upright blocks press straight down: 0, not 5.551e-17 or -0."""
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, 0.5), (1, 1), name="pier", fixed=True)
    scene.add_box((0.6, 1.1), (2, 0.2), name="plank")
    scene.add_box((0, 1.6), (0.8, 0.8), name="weight")
    lines = ds.check(scene).table().splitlines()[2:]
    assert [line.split()[-1] for line in lines] == ["0"] * 4


def test_what_rounding_left_is_printed_as_nothing() -> None:
    arch = ds.scenes.arch(8)
    assert any(0 < abs(x) < 1e-12 for force in ds.check(arch).forces for x in force.point)
    wall = ds.scenes.brick_wall(3, 3)
    margin = ds.margin(wall)
    assert any(0 < abs(x) < 1e-12 for x in margin.direction)
    for text in (ds.check(arch).table(), repr(arch.contacts), str(margin)):
        assert not re.search(r"e-1\d|-0[,)]", text), text
    assert f"({math.degrees(margin.tilt or 0):.3g} degrees)" in str(margin)
