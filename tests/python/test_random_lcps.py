"""Random complementarity problems of the families in benchmarks/: none wrong, none unanswered.

A smaller part of what `benchmarks/random_lcps.py` counts; its judge is tested here too.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from drystone import lcp

BENCHMARKS = str(Path(__file__).parents[2] / "benchmarks")
sys.path.insert(0, BENCHMARKS)

import random_lcps  # noqa: E402
from lcp_families import FAMILIES, Family, Problem  # noqa: E402
from lcp_reference import Judgement, judge, reference  # noqa: E402

sys.path.remove(BENCHMARKS)

EACH = 10


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.name)
def test_no_answer_is_wrong_and_none_is_missing(family: Family) -> None:
    tallies = [random_lcps.single_problems(family, range(EACH))]
    if family.name in random_lcps.WALKS:
        tallies.append(random_lcps.walks(family, range(EACH // 5)))
    for tally in tallies:
        assert tally.judged == {Judgement.RIGHT: tally.answers}, tally.remarks
        assert tally.answers >= tally.problems // 2


def test_walks_are_of_families_that_there_are() -> None:
    assert set(random_lcps.WALKS) <= {family.name for family in FAMILIES}


def test_the_named_eigenvalue_is_one_that_m_has() -> None:
    """Here the direction has an image of 1e-4 beside its own curvature, which is positive."""
    family = next(family for family in FAMILIES if family.name == "9 decimals")
    tally = random_lcps.single_problems(family, range(1528, 1529))
    assert tally.judged == {Judgement.RIGHT: tally.answers}, tally.remarks


@pytest.mark.parametrize(
    ("name", "seed"),
    [
        ("near columns, infeasible", 731),
        ("near columns, infeasible", 114),
        ("units 1e-8 to 1e8, infeasible", 916),
        ("units 1e-8 to 1e8, infeasible", 1062),
        ("huge or tiny", 110),
        ("huge or tiny", 983),
    ],
)
def test_a_certificate_of_nearly_equal_columns_is_found(name: str, seed: int) -> None:
    """Its M'y is rounding only in 32 digits, or only within the null space of M."""
    family = next(family for family in FAMILIES if family.name == name)
    tally = random_lcps.single_problems(family, range(seed, seed + 1))
    assert tally.said["no_solution"] == tally.answers >= 3
    assert tally.judged == {Judgement.RIGHT: tally.answers}, tally.remarks


def test_where_pivots_go_in_circles_another_method_is_asked() -> None:
    """Of two columns that are opposite but for rounding now one bears and now the other."""
    family = next(family for family in FAMILIES if family.name == "near opposite columns")
    tally = random_lcps.walks(family, range(94, 95))
    assert tally.judged == {Judgement.RIGHT: tally.answers}, tally.remarks


TWO = Problem(np.array([[1.0, -1.0], [-1.0, 1.0]]), np.array([-1.0, -1.0]))


def test_the_judge_tells_right_from_wrong() -> None:
    right = lcp.solve(TWO.M, TWO.q)
    assert right.status == "no_solution"
    assert judge(replace(TWO, expected="no_solution"), right).judgement == Judgement.RIGHT
    assert judge(replace(TWO, expected="solved"), right).judgement == Judgement.WRONG
    for ray in (None, np.array([1.0, 0.0]), np.array([1.0, 1.0 + 1e-9]), np.array([-1.0, -1.0])):
        assert judge(TWO, replace(right, ray=ray)).judgement == Judgement.WRONG
    for z in ([0.0, 0.0], [1.0, 1.0], [-1.0, 3.0], [np.nan, 0.0]):
        claimed = replace(right, status="solved", z=np.array(z))
        assert judge(TWO, claimed).judgement == Judgement.WRONG
    trouble = replace(right, status="numerical_trouble")
    assert judge(TWO, trouble).judgement == Judgement.UNANSWERED
    refused = lcp.LcpError(
        "M is not positive semidefinite: it has an eigenvalue of -1.0e-9 or less"
    )
    assert judge(TWO, refused).judgement == Judgement.WRONG
    assert judge(replace(TWO, rounded=True), refused).judgement == Judgement.WRONG


def test_the_reference_tells_what_is_solvable() -> None:
    assert reference(TWO) == "no_solution"
    assert reference(replace(TWO, q=np.array([-1.0, 1.0]))) == "solved"
    assert reference(replace(TWO, q=np.array([-1.0, 1.0 - 1e-6]))) is None
