"""`drystone check`."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from drystone.cli.errors import InputError
from drystone.cli.inputs import listed, load_scene, picture_path, reporting_files
from drystone.cli.output import MOST_ROWS, console, cut, table
from drystone.text import shown
from drystone.verdict import Verdict, check

if TYPE_CHECKING:
    from rich.table import Table


def run(
    scene_name: str,
    blocks: str | None,
    block: Sequence[str] | None,
    as_json: bool,
    output: Path | None,
    facets: int,
    cone: str,
) -> int:
    """0 if it stands, 1 if not, 2 if there is no verdict."""
    picture = picture_path(output)
    scene = load_scene(scene_name)
    names = None if blocks is None and not block else [*listed(blocks), *(block or ())]
    verdict = check(scene, names, facets=facets, cone=cone)
    if picture is not None:
        with reporting_files():
            verdict.draw(picture)
    if as_json:
        print(json.dumps(verdict.to_dict(), indent=2))
    else:
        _print(verdict, picture)
    if verdict.status != "solved":
        raise InputError(f"{scene_name}: no verdict ({verdict.status})")
    return 0 if verdict.stable else 1


def _print(verdict: Verdict, picture: Path | None) -> None:
    out = console()
    undecided = verdict.status != "solved"
    colour = "yellow" if undecided else "green" if verdict.stable else "red"
    out.print(str(verdict), style=f"bold {colour}")
    if verdict.falling:
        out.print(_fall_table(verdict))
    else:
        out.print(_force_table(verdict))
    if picture is not None:
        out.print(f"picture: {shown(str(picture))}", soft_wrap=True)


def _force_table(verdict: Verdict) -> Table:
    axes = "xyz"[: verdict.scene.dimension]
    metres = [f"{axis} [m]" for axis in axes]
    made = table("contact", *metres, "normal [N]", "tangential [N]")
    for force in verdict.forces[:MOST_ROWS]:
        made.add_row(
            f"{shown(force.a)} - {shown(force.b)}",
            *(f"{value:.4g}" for value in force.point),
            f"{force.normal_force:.4g}",
            f"{force.tangential_force:.4g}",
        )
    return cut(made, len(verdict.forces))


def _fall_table(verdict: Verdict) -> Table:
    titles = ["x [m/s²]", "y [m/s²]", "turns [rad/s²]"]
    if verdict.scene.dimension == 3:
        titles = [f"{axis} [m/s²]" for axis in "xyz"] + [f"turns {axis} [rad/s²]" for axis in "xyz"]
    made = table("falls", *titles)
    for name in verdict.falling[:MOST_ROWS]:
        made.add_row(shown(name), *(f"{value:.4g}" for value in verdict.acceleration(name)))
    return cut(made, len(verdict.falling))
