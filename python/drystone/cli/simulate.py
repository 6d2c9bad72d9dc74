"""`drystone simulate`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from drystone.cli.errors import INTERRUPTED
from drystone.cli.inputs import (
    kind_of,
    load_scene,
    picture_path,
    reporting_files,
    said_of,
    save_film,
)
from drystone.cli.output import console, facts
from drystone.common.cones import Pyramid
from drystone.common.files import FILMS, PAGE, RUN
from drystone.common.progress import RunProgress
from drystone.common.text import counted, shown
from drystone.common.units import quantity
from drystone.motion.modes import Formulation, Reuse
from drystone.motion.run import Run
from drystone.motion.simulation import simulate

if TYPE_CHECKING:
    from rich.table import Table


def run(
    scene_name: str,
    dt: float,
    steps: int,
    reuse: Reuse,
    restitution: float,
    formulation: Formulation,
    coulomb_tolerance: float,
    facets: int,
    cone: Pyramid,
    forces: bool,
    every: int,
    as_json: bool,
    output: Path | None,
) -> int:
    """0 if every step was made, 1 if one could not be, 130 after Ctrl-C."""
    output = picture_path(output, PAGE, *FILMS, RUN)
    forces = forces or (output is not None and kind_of(output) != "run")
    scene = load_scene(scene_name)
    with RunProgress() as progress:
        made = simulate(
            scene,
            dt,
            steps,
            reuse,
            restitution=restitution,
            formulation=formulation,
            coulomb_tolerance=coulomb_tolerance,
            facets=facets,
            cone=cone,
            forces=forces,
            every=every,
            progress=progress,
        )
    if output is not None:
        with reporting_files():
            if kind_of(output) == "film":
                save_film(made, output)
            else:
                _save(made, output)
    if as_json:
        print(json.dumps(made.to_dict(), indent=2))
    else:
        _print(made, output)
    return {"finished": 0, "interrupted": INTERRUPTED}.get(made.ending, 1)


def _save(made: Run, output: Path) -> None:
    """Says so meanwhile: a run of a million steps takes seconds to compress."""
    from rich.text import Text

    with console(stderr=True).status(Text(f"writing {shown(str(output))}")):
        made.save(output)


def _print(made: Run, output: Path | None) -> None:
    out = console()
    out.print(str(made), style=f"bold {'green' if made.finished else 'red'}")
    if made.steps:
        out.print(_facts(made))
    if output is not None:
        out.print(said_of(output), soft_wrap=True)


def _facts(made: Run) -> Table:
    told = facts()
    step = quantity(float(made.step_seconds.mean()), "s")
    solving = quantity(float(made.solve_seconds.mean()), "s")
    told.add_row("a step", f"{step}, {solving} in solves")
    told.add_row(
        "pivots",
        f"{made.pivots.sum()} ({made.major_cycles.sum()} major, {made.minor_cycles.sum()} minor) "
        f"in {counted(int(made.solves.sum()), 'solve')}",
    )
    settled = int(made.motionless.all(axis=1).sum())
    told.add_row("steps in which nothing moved", f"{settled} of {made.steps}")
    told.add_row("deepest overlap", quantity(float(made.penetration.max()), "m", 2))
    told.add_row("largest error of friction", f"{made.friction_error.max():.2g} m/s")
    told.add_row("steps not exact", f"{made.not_exact} of {made.steps}")
    if made.formulation != "velocity":
        told.add_row("formulation", made.formulation)
        told.add_row("steps with collisions", f"{int((made.collisions > 0).sum())}")
    told.add_row("reuse", made.reuse)
    return told
