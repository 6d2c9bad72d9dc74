"""Table I of the paper, and the figures beside it."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import pytest

import drystone as ds
from conftest import Ran
from drystone import paper


@pytest.fixture(scope="module")
def rows() -> dict[str, paper.Row]:
    return {row.example.name: row for row in paper.measure()}


# Closed form: k blocks take 2 k pivots from scratch, a block added takes 2.
@pytest.mark.parametrize(
    ("name", "lcp", "reuse"),
    [("Column 50", 48 * 49, 96), ("Column 80", 78 * 79, 156), ("Pyramid 91", 90 * 91, 180)],
)
def test_the_regular_structures_take_the_papers_pivots(
    rows: dict[str, paper.Row], name: str, lcp: int, reuse: int
) -> None:
    row = rows[name]
    assert row.plans["lcp"].pivots == lcp == row.example.printed["lcp"]
    assert row.plans["reuse-dantzig"].pivots <= reuse == row.example.printed["reuse-dantzig"]
    assert row.plans["reuse"].pivots <= reuse
    assert row.plans["lcp"].tests == reuse // 2


@pytest.mark.parametrize(("name", "saving"), [("Random 10", 5), ("Random 84", 30)])
def test_reuse_saves_on_random_structures(
    rows: dict[str, paper.Row], name: str, saving: float
) -> None:
    """The paper: 127 / 13 = 10 and 15136 / 420 = 36.

    On n blocks its 10 is out of reach of these structures. A block in plane equilibrium without
    friction needs two contact forces, so tests of 1 to n - 1 blocks that all stand take at least
    2 + 4 + ... = n (n - 1) pivots from scratch and 2 (n - 1) with reuse: n / 2 times fewer. More
    takes many tests that fail near the end, which so few blocks do not make.
    """
    plans = rows[name].plans
    assert plans["lcp"].pivots >= saving * plans["reuse"].pivots
    assert plans["lcp"].pivots >= saving * plans["reuse-dantzig"].pivots


def test_reuse_saves_in_space(rows: dict[str, paper.Row]) -> None:
    column = rows["Column 50 cubes"].plans
    # As in the plane: what is pressed straight needs no other forces.
    assert (column["lcp"].pivots, column["reuse-dantzig"].pivots) == (2352, 96)
    assert column["reuse"].pivots == 96
    for name in ("Pyramid 91 cubes", "Square pyramid 140"):
        plans = rows[name].plans
        assert plans["lcp"].pivots > 40 * plans["reuse"].pivots
        assert plans["lcp"].pivots > 35 * plans["reuse-dantzig"].pivots


def test_every_test_finds_the_same_order(rows: dict[str, paper.Row]) -> None:
    for row in rows.values():
        assert row.found
        assert len({plan.order for plan in row.plans.values()}) == 1
        assert len({plan.tests for plan in row.plans.values()}) == 1


def test_the_order_matters_in_the_random_structure(rows: dict[str, paper.Row]) -> None:
    """As in Fig. 7, taking the highest block first would collapse it somewhere on the way."""
    plan = rows["Random 84"].plans["reuse"]
    bodies = [body for body in plan.scene.bodies if not body.fixed]
    assert len(bodies) == 84
    by_height = sorted(bodies, key=lambda body: -body.centroid[1])
    names = [body.name for body in by_height]
    assert not all(ds.check(plan.scene, names[taken:]).stable for taken in range(len(names)))


def test_reuse_saves_in_the_simulations() -> None:
    """Exact work counts; the times are for the reader."""
    fig1, fig4 = (measured.segments() for measured in paper.measure_motions())
    assert [segment.moving for segment in fig1] == [-1, 1, 2]
    assert [segment.moving for segment in fig4] == [-1, 2, 5, 7]
    assert fig1[0].saved(fig1[0].pivots, "full") >= 0.9
    for segment in fig1 + fig4:
        assert segment.pivots["full"] < 0.2 * segment.pivots["none"], segment.label
        assert all(seconds > 0 for seconds in segment.seconds.values())


def test_the_command_prints_the_table_and_writes_everything(
    cli: Callable[..., Ran], tmp_path: Path
) -> None:
    ran = cli("bench", "paper", "-o", tmp_path / "new" / "folder")
    assert ran.status == 0
    for number in ("2352", "6162", "8190", "(15136)"):
        assert number in ran.out
    written = sorted(path.name for path in (tmp_path / "new" / "folder").iterdir())
    assert written == [
        "fig1_fig4_pivots_by_step.png",
        "fig1_fig4_pivots_by_step.svg",
        "fig5_disassembly_graph.png",
        "fig5_disassembly_graph.svg",
        "fig6_pivots_by_size.png",
        "fig6_pivots_by_size.svg",
        "fig7_disassembly_order.png",
        "fig7_disassembly_order.svg",
        "motion.csv",
        "order.png",
        "order.svg",
        "table1.csv",
    ]
    with (tmp_path / "new" / "folder" / "table1.csv").open() as file:
        lines = list(csv.DictReader(file))
    assert len(lines) == 8 * 5
    assert {line["pivots"] for line in lines if line["structure"] == "Pyramid 91"} >= {"8190"}
