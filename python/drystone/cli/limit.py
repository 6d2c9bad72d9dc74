"""`drystone limit`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from drystone.cli.errors import InputError
from drystone.cli.inputs import chosen, load_scene, numbers, picture_path, said_of, write
from drystone.cli.output import console
from drystone.common.cones import Cone
from drystone.common.files import JSON, PAGE
from drystone.common.json_text import write_json
from drystone.equilibrium.limits import Limit, limit
from drystone.report.tables import motion_table

if TYPE_CHECKING:
    from rich.console import Console


def run(
    scene_name: str,
    push: Sequence[str] | None,
    gravity: str | None,
    blocks: str | None,
    block: Sequence[str] | None,
    as_json: bool,
    output: Path | None,
    facets: int,
    cone: Cone,
) -> int:
    """0 if it stands under some factor, 1 if under none, 2 if there is no answer."""
    if not push and gravity is None:
        raise InputError("nothing pushes: give --push, as 7:100,0, or --gravity, as 9.81,0")
    picture = picture_path(output, PAGE, JSON)
    scene = load_scene(scene_name)
    names = chosen(blocks, block)
    found = limit(
        scene,
        None if not push else dict(_push(text) for text in push),
        None if gravity is None else numbers(gravity, "--gravity"),
        names,
        facets=facets,
        cone=cone,
    )
    write(found, found, picture)
    if as_json:
        write_json(found.to_dict(), sys.stdout)
    else:
        _print(console(), found, picture)
    if found.status not in ("solved", "no_solution"):
        raise InputError(f"{scene_name}: no answer ({found.status})")
    return 0 if found.status == "solved" else 1


def _push(text: str) -> tuple[str, tuple[float, ...]]:
    name, colon, force = text.rpartition(":")
    if not colon:
        raise InputError(f"--push {text}: give a block and a force, as 7:100,0")
    return name, numbers(force, f"--push {text}")


def _print(out: Console, found: Limit, picture: Path | None) -> None:
    solved = found.status == "solved"
    colour = "green" if solved else "red" if found.status == "no_solution" else "yellow"
    out.print(str(found), style=f"bold {colour}")
    if found.mechanism:
        out.print(motion_table(found.mechanism))
    if picture is not None:
        out.print(said_of(picture), soft_wrap=True)
