"""The linear program: one live model answers as fresh ones do, and no answer is no verdict."""

from __future__ import annotations

import highspy
import numpy as np
import pytest

import drystone as ds
from conftest import dropped
from drystone import statics


def test_the_live_model_answers_as_a_fresh_one() -> None:
    """Random walks through sub-assemblies: add one, back up several, jump elsewhere."""
    rng = np.random.default_rng(7)
    for _ in range(10):
        blocks = int(rng.integers(5, 25))
        scene = dropped(rng, blocks, friction=0.4)
        equilibrium = statics.Equilibrium.of(scene)
        warm, cold = statics.WarmProgram(equilibrium), statics.ColdProgram(equilibrium)
        present: list[int] = []
        for _ in range(40):
            if present and rng.uniform() < 0.4:
                del present[int(rng.integers(len(present))) :]
            rest = [body for body in range(blocks) if body not in present]
            if not rest:
                continue
            present.append(rest[int(rng.integers(min(3, len(rest))))])
            bodies = sorted(present)
            assert warm(bodies, present[-1])[0] == cold(bodies, present[-1])[0]


def test_a_block_added_costs_two_pivots_in_a_column() -> None:
    """The paper's closed form for reuse, 2 for every block added, is the warm simplex's too."""
    plan = ds.plan(ds.scenes.column(20), "lp-warm")
    assert plan.pivots == 2 * plan.tests


def test_gravity_and_mass_do_not_matter() -> None:
    """Verdicts of the scaled program are the same for feathers on the moon."""
    for scale in (1e-6, 1.0, 1e6):
        scene = ds.Scene(gravity=(0, -9.81 * scale))
        scene.add_box((0, -0.5), (9, 1), fixed=True)
        scene.add_box((0, 0.5), (1, 1), density=scale)
        scene.add_box((0.49, 1.5), (1, 1), density=scale)
        scene.add_box((0.99, 2.5), (1, 1), density=scale)
        program = statics.ColdProgram(statics.Equilibrium.of(scene))
        assert program([0, 1], 1)[0]
        assert not program([0, 1, 2], 2)[0]
        assert not program([1], 1)[0]


@pytest.mark.parametrize("test", ["lp", "lp-warm"])
def test_highs_leaves_standard_output_to_the_answer(
    test: str, capfd: pytest.CaptureFixture[str]
) -> None:
    ds.plan(ds.scenes.five_blocks(), test)
    assert capfd.readouterr() == ("", "")


class _Stubborn(statics.QuietHighs):
    """HiGHS, but the methods named in `silent` end without an answer."""

    silent: tuple[str, ...] = ()

    def getModelStatus(self) -> highspy.HighsModelStatus:  # noqa: N802 (HiGHS names it)
        presolved = self.getOptionValue("presolve")[1] == "on"
        method = self.getOptionValue("solver")[1] if presolved else "primal"
        if method in self.silent:
            return highspy.HighsModelStatus.kUnknown
        return super().getModelStatus()


@pytest.mark.parametrize("silent", [("primal",), ("primal", "ipm")])
def test_another_method_decides_where_the_simplex_method_does_not(
    silent: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_Stubborn, "silent", silent)
    monkeypatch.setattr(statics, "QuietHighs", _Stubborn)
    program = statics.ColdProgram(statics.Equilibrium.of(ds.scenes.five_blocks()))
    assert program([0, 2, 4], 4)[0]
    assert not program([0, 2], 2)[0]


def test_no_answer_is_an_error_and_never_a_verdict(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_Stubborn, "silent", ("primal", "ipm", "simplex"))
    monkeypatch.setattr(statics, "QuietHighs", _Stubborn)
    for test in ("lp", "lp-warm"):
        with pytest.raises(ds.StaticsError, match="none of its methods"):
            ds.plan(ds.scenes.five_blocks(), test)
