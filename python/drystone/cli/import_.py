"""`drystone import`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drystone.cli.errors import InputError
from drystone.cli.inputs import reporting_files
from drystone.imports import Imported, load

if TYPE_CHECKING:
    from rich.table import Table

MOST_ROWS = 40
"""Longer tables are cut, with a line that says so; --json has everything."""


def run(
    file: Path,
    output: Path | None,
    as_json: bool,
    *,
    gravity: str | None,
    fixed: str | None,
    **options: Any,
) -> int:
    """0 if there is a scene; what cannot be imported is an error. `options` are those of `load`."""
    names = [name.strip() for name in (fixed or "").split(",") if name.strip()]
    with reporting_files():
        imported = load(file, gravity=_gravity(gravity), fixed=names, **options)
        if output is not None:
            imported.scene.save(output)
    if as_json:
        print(json.dumps(imported.to_dict(), indent=2))
    else:
        _print(imported, output)
    return 0


def _gravity(text: str | None) -> tuple[float, ...] | None:
    if text is None:
        return None
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"--gravity must be three numbers x,y,z, not {text!r}") from None
    return x, y, z


def _print(imported: Imported, output: Path | None) -> None:
    from rich.console import Console

    console = Console(highlight=False)
    bodies = imported.bodies
    pieces = sum(len(body.pieces) for body in bodies)
    fixed = sum(body.fixed for body in bodies)
    count = f"{len(bodies)} {'body' if len(bodies) == 1 else 'bodies'}"
    console.print(
        f"{imported.format}: {count}, {fixed} of them fixed, {pieces} convex pieces",
        style="bold",
    )
    console.print(_bodies(imported))
    if imported.left_out:
        console.print(_left_out(imported))
    for message in imported.messages[:MOST_ROWS]:
        console.print(message, markup=False)
    if len(imported.messages) > MOST_ROWS:
        console.print(f"... and {len(imported.messages) - MOST_ROWS} more; --json has all")
    if not fixed:
        console.print("Nothing is fixed: everything will fall. See --fixed and --ground.")
    if output is None:
        console.print("Nothing written: give the scene a file with -o.")
    else:
        console.print(f"scene: {output}", soft_wrap=True)


def _bodies(imported: Imported) -> Table:
    from rich.text import Text

    table = _table("body", "pieces", "volume [m³]", "density [kg/m³]", "friction", "fixed")
    for body in imported.bodies[:MOST_ROWS]:
        table.add_row(
            Text(body.name),
            str(len(body.pieces)),
            f"{body.volume:.4g}",
            f"{body.density:.4g}",
            "" if body.friction is None else f"{body.friction:g}",
            "fixed" if body.fixed else "",
        )
    return _cut(table, len(imported.bodies))


def _left_out(imported: Imported) -> Table:
    from rich.text import Text

    table = _table("left out", "why")
    for out in imported.left_out[:MOST_ROWS]:
        table.add_row(Text(out.what), Text(out.why))
    return _cut(table, len(imported.left_out))


def _table(first: str, *others: str) -> Table:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD)
    table.add_column(first, overflow="fold")
    for title in others:
        # Text: [m³] is a unit, not markup.
        table.add_column(Text(title), justify="left" if title == "why" else "right")
    return table


def _cut(table: Table, rows: int) -> Table:
    if rows > MOST_ROWS:
        table.caption = f"the first {MOST_ROWS} of {rows}; --json lists all"
    return table
