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


class _NoAnswer(highspy.Highs):
    """A simplex method that always gives up; the interior point method too, if told so."""

    both = False

    def getModelStatus(self) -> highspy.HighsModelStatus:  # noqa: N802 (HiGHS names it)
        by_simplex = self.getOptionValue("solver")[1] == "simplex"
        if by_simplex or self.both:
            return highspy.HighsModelStatus.kUnknown
        return super().getModelStatus()


@pytest.mark.parametrize("both", [False, True])
def test_the_interior_point_method_decides_if_the_simplex_method_does_not(
    both: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = ds.scenes.five_blocks()
    monkeypatch.setattr(_NoAnswer, "both", both)
    monkeypatch.setattr(statics.highspy, "Highs", _NoAnswer)
    program = statics.ColdProgram(statics.Equilibrium.of(scene))
    if both:
        with pytest.raises(ds.StaticsError, match="neither by the simplex method"):
            program([0], 0)
        with pytest.raises(ds.StaticsError):
            ds.plan(scene, "lp")
    else:
        assert program([0, 2, 4], 4)[0]
        assert not program([0, 2], 2)[0]
