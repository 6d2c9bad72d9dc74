"""Section VI of the paper: every method gives the right verdicts, and reuse saves work in each."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import drystone as ds
from conftest import Ran, dropped, orderless
from drystone import _core, paper, statics

Cli = Callable[..., Ran]


@pytest.fixture(scope="module")
def found() -> list[paper.Measurement]:
    cases: paper.Cases = {
        ("column", 0.0): ds.scenes.column(30),
        ("column", 0.5): ds.scenes.column(30, friction=0.5),
        ("pyramid", 0.0): ds.scenes.pyramid(7),
        ("pyramid", 0.5): ds.scenes.pyramid(7, friction=0.5),
        ("random", 0.0): ds.scenes.random_stack(40),
        ("random", 0.5): ds.scenes.random_stack(40, friction=0.5),
    }
    return paper.measure_methods(cases, repeats=1)


def test_no_method_fails(found: list[paper.Measurement]) -> None:
    """The verdicts are those of HiGHS from scratch, which shares nothing with the methods."""
    assert len(found) == 6 * 9
    for one in found:
        assert (one.wrong, one.unanswered) == (0, 0), one


def test_reuse_takes_less_of_every_method(found: list[paper.Measurement]) -> None:
    pivots = {(one.structure, one.friction, one.method, one.reuse): one.pivots for one in found}
    saved = 0
    for (structure, friction, method, reuse), warm in pivots.items():
        if reuse and method != "kept basis":
            cold = pivots[structure, friction, method, False]
            assert 4 * warm < cold, (structure, friction, method)
            saved += 1
    assert saved == 6 * 4
    # Closed form, as in Table I: two forces a block; Lemke's artificial variable takes one more.
    tests = 28
    assert pivots["column", 0.0, "Dantzig", False] == tests * (tests + 1)
    assert pivots["column", 0.0, "block", False] == tests * (tests + 1)
    assert pivots["column", 0.0, "Lemke", False] == tests * (tests + 2)
    for method, each in (("Dantzig", 2), ("block", 2), ("Lemke", 3), ("kept basis", 2)):
        assert pivots["column", 0.0, method, True] == each * tests


def test_searches_that_step_back() -> None:
    rng = np.random.default_rng(3)
    scenes = [orderless(5), *(dropped(rng, 6, friction) for friction in (0.0, 0.3, 0.8) * 8)]
    cases: paper.Cases = {(str(i), None): scene for i, scene in enumerate(scenes)}
    found = paper.measure_methods(cases, repeats=1)
    assert [one for one in found if one.failures] == []
    assert sum(one.tests for one in found if one.test == "reuse") > 100


def test_a_verdict_unlike_the_reference_is_a_failure() -> None:
    """The reference says that everything stands, so those that fall count as wrong."""
    recording = _core.Recording(orderless(1)._core, lambda bodies, added: (True, 0))
    program = statics.ColdProgram(statics.Equilibrium.of(orderless(1)))
    for test in ("lcp", "reuse-lemke", program):
        replay = recording.replay(test)
        assert replay.wrong > 0
        assert replay.unanswered == 0
    with pytest.raises(ValueError, match="newton"):
        recording.replay("newton")


def test_a_test_in_python_may_fail() -> None:
    def test(bodies: list[int], added: int) -> tuple[bool, int]:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        _core.Recording(ds.scenes.column(4)._core, test)


def test_the_command_prints_a_table_and_writes_it(cli: Cli, tmp_path: Path) -> None:
    folder = tmp_path / "new" / "folder"
    ran = cli("bench", "methods", "column:12", "pyramid:3,friction=0.5", "-o", folder)
    assert (ran.status, ran.err) == (0, "")
    for word in ("column:12", "Dantzig", "block", "Lemke", "LP", "kept basis", "110"):
        assert word in ran.out
    assert max(map(len, ran.out.splitlines()[:-1])) <= 80
    with (folder / "methods.csv").open() as file:
        lines = list(csv.DictReader(file))
    assert len(lines) == 2 * 9
    assert {line["failures"] for line in lines} == {"0"}


def test_the_command_as_json(cli: Cli) -> None:
    ran = cli("bench", "methods", "column:6", "--repeats", "1", "--json")
    answer = json.loads(ran.out)
    assert [one["test"] for one in answer][:2] == ["lcp", "reuse-dantzig"]
    assert all(one["failures"] == 0 and one["seconds"] > 0 for one in answer)


def test_the_command_refuses_what_is_no_scene(cli: Cli) -> None:
    ran = cli("bench", "methods", "no-such-scene")
    assert (ran.status, ran.out) == (2, "")
    assert "no-such-scene" in ran.err


def test_the_default_is_the_papers_structures() -> None:
    assert list(paper.paper_scenes()) == [
        (name, friction)
        for friction in (0.0, 0.5)
        for name in ("Column 50", "Column 80", "Pyramid 91", "Random 84")
    ]
