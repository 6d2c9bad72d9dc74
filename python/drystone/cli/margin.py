"""`drystone margin`."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from pathlib import Path

from drystone.cli.errors import InputError
from drystone.cli.inputs import chosen, load_scene, picture_path, said_of, write
from drystone.cli.output import console
from drystone.common.cones import Cone
from drystone.common.files import JSON, PAGE
from drystone.common.json_text import write_json
from drystone.equilibrium.margins import LoadsUnder, Margin, margin
from drystone.report.tables import motion_table


def run(
    scene_name: str,
    blocks: str | None,
    block: Sequence[str] | None,
    loads: LoadsUnder,
    tolerance: float,
    as_json: bool,
    output: Path | None,
    facets: int,
    cone: Cone,
) -> int:
    """0 if it has a margin, 1 if it falls, 2 if there is no answer."""
    picture = picture_path(output, PAGE, JSON)
    scene = load_scene(scene_name)
    names = chosen(blocks, block)
    found = margin(scene, names, loads=loads, tolerance=tolerance, facets=facets, cone=cone)
    write(found, found, picture)
    if as_json:
        write_json(found.to_dict(), sys.stdout)
    else:
        _print(found, picture)
    if found.status != "solved":
        raise InputError(f"{scene_name}: no answer ({found.status})")
    return 0 if found.acceleration > 0.0 else 1


def _print(found: Margin, picture: Path | None) -> None:
    out = console()
    solved = found.status == "solved"
    colour = "yellow" if not solved else "green" if found.acceleration > 0.0 else "red"
    out.print(str(found), style=f"bold {colour}")
    if solved:
        out.print(_of_friction(found.friction))
    if found.mechanism:
        out.print(motion_table(found.mechanism))
    if picture is not None:
        out.print(said_of(picture), soft_wrap=True)


def _of_friction(factor: float) -> str:
    if math.isinf(factor):
        return "No friction, however much, makes it stand."
    return f"Stands with {factor:.6g} times its friction and more."
