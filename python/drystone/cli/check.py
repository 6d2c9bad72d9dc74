"""`drystone check`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from drystone.cli.inputs import load_scene, picture_path, reporting_files
from drystone.verdict import Verdict, check

if TYPE_CHECKING:
    from rich.table import Table

MOST_ROWS = 40
"""Longer tables are cut, with a line that says so; --json has everything."""


def run(
    scene_name: str,
    blocks: str | None,
    as_json: bool,
    output: Path | None,
    facets: int,
    cone: str,
) -> int:
    """0 if it stands, 1 if not."""
    picture = picture_path(output)
    scene = load_scene(scene_name)
    names = None if blocks is None else [name.strip() for name in blocks.split(",") if name.strip()]
    verdict = check(scene, names, facets=facets, cone=cone)
    if picture is not None:
        with reporting_files():
            verdict.draw(picture)
    if as_json:
        print(json.dumps(verdict.to_dict(), indent=2))
    else:
        _print(verdict, picture)
    return 0 if verdict.stable else 1


def _print(verdict: Verdict, picture: Path | None) -> None:
    from rich.console import Console

    console = Console(highlight=False)
    colour = "green" if verdict.stable else "red"
    console.print(str(verdict), style=f"bold {colour}")
    if verdict.falling:
        console.print(_fall_table(verdict))
    else:
        console.print(_force_table(verdict))
    if picture is not None:
        console.print(f"picture: {picture}")


def _force_table(verdict: Verdict) -> Table:
    axes = "xyz"[: verdict.scene.dimension]
    metres = [f"{axis} [m]" for axis in axes]
    table = _table("contact", *metres, "normal [N]", "tangential [N]")
    for force in verdict.forces[:MOST_ROWS]:
        table.add_row(
            f"{force.a} - {force.b}",
            *(f"{value:.4g}" for value in force.point),
            f"{force.normal_force:.4g}",
            f"{force.tangential_force:.4g}",
        )
    return _cut(table, len(verdict.forces))


def _fall_table(verdict: Verdict) -> Table:
    titles = ["x [m/s²]", "y [m/s²]", "turns [rad/s²]"]
    if verdict.scene.dimension == 3:
        titles = [f"{axis} [m/s²]" for axis in "xyz"] + [f"turns {axis} [rad/s²]" for axis in "xyz"]
    table = _table("falls", *titles)
    for name in verdict.falling[:MOST_ROWS]:
        table.add_row(name, *(f"{value:.4g}" for value in verdict.acceleration(name)))
    return _cut(table, len(verdict.falling))


def _table(first: str, *others: str) -> Table:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD)
    table.add_column(first)
    for title in others:
        table.add_column(Text(title), justify="right")  # Text: [m] is a unit, not markup
    return table


def _cut(table: Table, rows: int) -> Table:
    if rows > MOST_ROWS:
        table.caption = f"the first {MOST_ROWS} of {rows}; --json lists all"
    return table
