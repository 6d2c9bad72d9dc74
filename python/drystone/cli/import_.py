"""`drystone import`."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from drystone.cli.errors import InputError
from drystone.cli.inputs import STANDARD, listed, reporting_files
from drystone.cli.output import console
from drystone.common.text import MOST_ROWS, counted, shown
from drystone.imports import Imported, load
from drystone.report.tables import cut, table

if TYPE_CHECKING:
    from rich.table import Table


def run(
    file: str,
    output: Path | None,
    as_json: bool,
    *,
    gravity: str | None,
    fixed: str | None,
    fix: Sequence[str] | None,
    tolerance: str | None,
    **options: Any,
) -> int:
    """0 if there is a scene; what cannot be imported is an error. `options` are those of `load`."""
    names = [*listed(fixed), *(fix or ())]
    with reporting_files():
        imported = load(
            file,
            gravity=_gravity(gravity),
            fixed=names,
            tolerance=_tolerance(tolerance),
            **options,
        )
        if output is not None and str(output) != STANDARD:
            imported.scene.save(output)
    if output is not None and str(output) == STANDARD:
        if as_json:
            raise InputError("--json and -o - both want standard output: give one of them")
        print(imported.scene.to_json())
    elif as_json:
        print(json.dumps(imported.to_dict(), indent=2))
    else:
        _print(imported, output)
    return 0


def _tolerance(text: str | None) -> float | Literal["auto"] | None:
    if text is None or text == "auto":
        return None if text is None else "auto"
    try:
        return float(text)
    except ValueError:
        raise InputError(f"--tolerance must be a length in metres or auto, not {text!r}") from None


def _gravity(text: str | None) -> tuple[float, ...] | None:
    if text is None:
        return None
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"--gravity must be three numbers x,y,z, not {text!r}") from None
    return x, y, z


def _print(imported: Imported, output: Path | None) -> None:
    out = console()
    bodies = imported.bodies
    pieces = sum(len(body.pieces) for body in bodies if body.triangles is None)
    surfaces = sum(body.triangles is not None for body in bodies)
    fixed = sum(body.fixed for body in bodies)
    count = f"{counted(len(bodies), 'body', 'bodies')}, {fixed} of them fixed"
    out.print(
        f"{imported.format}: {count}, {counted(pieces, 'convex piece')}"
        + (f", {counted(surfaces, 'surface')}" if surfaces else ""),
        style="bold",
    )
    out.print(_bodies(imported))
    if imported.left_out:
        out.print(_left_out(imported))
    for message in imported.messages[:MOST_ROWS]:
        out.print(shown(message))
    if len(imported.messages) > MOST_ROWS:
        out.print(f"... and {len(imported.messages) - MOST_ROWS} more; --json has all")
    if not fixed:
        out.print("Nothing is fixed: everything will fall. See --fixed and --ground.")
    if output is None:
        out.print("Nothing written: give the scene a file with -o.")
    else:
        out.print(f"scene: {shown(str(output))}", soft_wrap=True)


def _bodies(imported: Imported) -> Table:
    made = table("body", "pieces", "volume [m³]", "density [kg/m³]", "friction", "fixed")
    for body in imported.bodies[:MOST_ROWS]:
        made.add_row(
            shown(body.name),
            str(len(body.pieces)) if body.triangles is None else f"{len(body.triangles)} triangles",
            f"{body.volume:.4g}",
            f"{body.density:.4g}",
            "" if body.friction is None else f"{body.friction:g}",
            "fixed" if body.fixed else "",
        )
    return cut(made, len(imported.bodies))


def _left_out(imported: Imported) -> Table:
    made = table("left out", "why", left=["why"])
    for out in imported.left_out[:MOST_ROWS]:
        made.add_row(shown(out.what), shown(out.why))
    return cut(made, len(imported.left_out))
