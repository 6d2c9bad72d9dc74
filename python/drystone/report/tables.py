"""Answers as tables of text, for people: on the command line, and where `.table()` is asked for."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from functools import singledispatch
from typing import TYPE_CHECKING

from drystone.common.numbers import whole
from drystone.common.text import MOST_ROWS, digits, place, shown
from drystone.common.units import scale_of
from drystone.equilibrium.limits import Limit, LimitEnd
from drystone.equilibrium.margins import Margin
from drystone.equilibrium.settled import Settled
from drystone.equilibrium.strong import Escape
from drystone.equilibrium.verdict import Verdict
from drystone.motion.run import Run
from drystone.planning.answer import Plan

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from rich.table import Table


IN_JSON = "--json lists all"
"""Where the rest of a table is, on the command line."""

IN_PYTHON = "rows= shows more"
"""The same in Python."""

WIDE = 1_000_000
"""Columns of what is no terminal: a program that reads lines wants them whole."""


def table(first: str, *others: str, left: Sequence[str] = ()) -> Table:
    """An empty table: names in the first column, numbers in the others but those in `left`."""
    from rich import box
    from rich.table import Table

    made = Table(box=box.SIMPLE_HEAD)
    made.add_column(first, overflow="fold")
    for title in others:
        made.add_column(title, justify="left" if title in left else "right", overflow="fold")
    return made


def cut(made: Table, rows: int, shown_rows: int = MOST_ROWS, more: str = IN_JSON) -> Table:
    """Says so if the table has fewer than all its rows."""
    if rows > shown_rows:
        made.caption = f"the first {shown_rows} of {rows}; {more}"
    return made


def text_of(made: Table) -> str:
    """The table as lines of text."""
    from rich.console import Console

    file = io.StringIO()
    Console(file=file, width=WIDE, markup=False, emoji=False, highlight=False).print(made)
    lines = (line.rstrip() for line in file.getvalue().splitlines())
    return "\n".join(line for line in lines if line)


def table_of(answer: object, rows: int = MOST_ROWS) -> str:
    """What `.table(rows)` gives; ValueError for a number of rows that is none."""
    if whole(rows, "rows") < 0:
        raise ValueError(f"rows is {rows}: it must be zero or more")
    return text(answer, rows)


@singledispatch
def text(answer: object, rows: int = MOST_ROWS) -> str:
    """The first `rows` of an answer's table, as lines of text."""
    raise TypeError(f"there is no table of a {type(answer).__name__}")


@text.register(Verdict)
def _(verdict: Verdict, rows: int = MOST_ROWS) -> str:
    return text_of(verdict_table(verdict, rows, IN_PYTHON))


@text.register(Escape)
def _(escape: Escape, rows: int = MOST_ROWS) -> str:
    return text_of(_fall_table(escape, rows, IN_PYTHON))


@text.register(LimitEnd)
@text.register(Limit)
@text.register(Margin)
def _(answer: LimitEnd | Limit | Margin, rows: int = MOST_ROWS) -> str:
    return text_of(motion_table(answer.mechanism, rows, IN_PYTHON))


@text.register(Settled)
def _(settled: Settled, rows: int = MOST_ROWS) -> str:
    return text_of(joints_table(settled, rows, IN_PYTHON))


@text.register(Plan)
def _(plan: Plan, rows: int = MOST_ROWS) -> str:
    return text_of(plan_table(plan, rows))


@text.register(Run)
def _(run: Run, rows: int = MOST_ROWS) -> str:
    return text_of(run_table(run, rows))


def verdict_table(verdict: Verdict, rows: int = MOST_ROWS, more: str = IN_JSON) -> Table:
    """The forces of what stands, the accelerations of what falls."""
    return (_fall_table if verdict.falling else _force_table)(verdict, rows, more)


def _force_table(verdict: Verdict, rows: int, more: str) -> Table:
    axes = "xyz"[: verdict.scene.dimension]
    metres = [f"{axis} [m]" for axis in axes]
    forces = verdict.forces[:rows]
    largest = max((force.normal_force for force in forces), default=0.0)
    furthest = max((abs(x) for force in forces for x in force.point), default=0.0)
    size, unit = scale_of([largest], "N")
    made = table("contact", *metres, f"normal [{unit}]", f"tangential [{unit}]")
    for force in forces:
        made.add_row(
            f"{shown(force.a)} - {shown(force.b)}",
            *(digits(value, furthest) for value in force.point),
            *(
                digits(value / size, largest / size)
                for value in (force.normal_force, force.tangential_force)
            ),
        )
    return cut(made, len(verdict.forces), rows, more)


def _fall_table(answer: Verdict | Escape, rows: int, more: str) -> Table:
    titles = ["x [m/s²]", "y [m/s²]", "turns [rad/s²]"]
    if answer.scene.dimension == 3:
        titles = [f"{axis} [m/s²]" for axis in "xyz"] + [f"turns {axis} [rad/s²]" for axis in "xyz"]
    made = table("falls", *titles)
    for name in answer.falling[:rows]:
        made.add_row(shown(name), *_cells(answer.acceleration(name)))
    return cut(made, len(answer.falling), rows, more)


def motion_table(
    motion: Mapping[str, NDArray[np.float64]], rows: int = MOST_ROWS, more: str = IN_JSON
) -> Table:
    """How blocks move in a collapse."""
    titles = ["x [m/s]", "y [m/s]", "turns [rad/s]"]
    if any(len(velocity) == 6 for velocity in motion.values()):  # in space
        titles = [f"{axis} [m/s]" for axis in "xyz"] + [f"turns {axis} [rad/s]" for axis in "xyz"]
    made = table("collapses", *titles)
    for name in list(motion)[:rows]:
        made.add_row(shown(name), *_cells(motion[name]))
    return cut(made, len(motion), rows, more)


def joints_table(settled: Settled, rows: int = MOST_ROWS, more: str = IN_JSON) -> Table:
    """The joints that a settlement opens."""
    metres = [f"{axis} [m]" for axis in "xyz"[: settled.scene.dimension]]
    size, unit = scale_of([joint.opens for joint in settled.joints], "m")
    made = table("joint", "does", *metres, f"opens [{unit}]", f"slides [{unit}]", left=("does",))
    largest = max((max(joint.opens, joint.slides) for joint in settled.joints), default=0.0) / size
    furthest = max((abs(x) for joint in settled.joints for x in joint.at), default=0.0)
    for joint in settled.joints[:rows]:
        made.add_row(
            f"{shown(joint.a)} - {shown(joint.b)}",
            joint.opening,
            *(digits(value, furthest) for value in joint.at),
            *(digits(value / size, largest) for value in (joint.opens, joint.slides)),
        )
    return cut(made, len(settled.joints), rows, more)


def _cells(values: NDArray[np.float64]) -> list[str]:
    """The numbers of one block's motion."""
    largest = float(abs(values).max(initial=0.0))
    return [digits(value, largest) for value in values.tolist()]


def plan_table(plan: Plan, rows: int) -> Table:
    """The order: which block leaves, what is held then, and whereto."""
    made = table("step", "remove", "held", "towards", left=("remove", "held", "towards"))
    for k, name in enumerate(plan.order[:rows]):
        held = " ".join(shown(other) for other in plan.holds[k]) if plan.holds else ""
        way = place(plan.directions[k], 3) if plan.directions else ""
        made.add_row(str(k + 1), shown(name), held, way)
    return cut(made, len(plan.order), rows, IN_PYTHON)


def run_table(run: Run, rows: int) -> Table:
    """A line for each of some steps, evenly spread, the last one among them."""
    made = table("step", "time [s]", "moving", "pivots", "overlap [m]", "friction error [m/s]")
    count = min(rows, run.steps)
    for k in (((j + 1) * run.steps) // count - 1 for j in range(count)):
        made.add_row(
            str(k + 1),
            f"{(k + 1) * run.dt:.4g}",
            str(int((~run.motionless[k]).sum())),
            str(int(run.pivots[k])),
            f"{run.penetration[k]:.2g}",
            f"{run.friction_error[k]:.2g}",
        )
    if count < run.steps:
        made.caption = f"{count} of {run.steps} steps; {IN_PYTHON}"
    return made
