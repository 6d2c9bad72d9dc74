"""`drystone plan` of a folder."""

from __future__ import annotations

import json
import sys
from contextlib import redirect_stdout
from pathlib import Path
from typing import TYPE_CHECKING

from drystone.cli.errors import BAD_INPUT, INTERRUPTED, InputError
from drystone.cli.inputs import load_scene, reporting_files
from drystone.cli.output import console
from drystone.common.cones import Pyramid
from drystone.common.text import MOST_ROWS, shorten, shown
from drystone.many import ManyPlans, plan_many
from drystone.many.engines import EngineName
from drystone.many.progress import ManyProgress
from drystone.planning.search import OrderOfPlan, StabilityTest
from drystone.report.tables import cut, table

if TYPE_CHECKING:
    from rich.table import Table

WHY = "why there is no order"


def run(
    folder: Path,
    engine: EngineName,
    output: Path | None,
    test: StabilityTest,
    node_limit: int | None,
    time_limit: float | None,
    workers: int | None,
    address: str | None,
    as_json: bool,
    *,
    shortcuts: bool,
    hold: int,
    clear_path: bool,
    margin: float,
    order: OrderOfPlan,
    moves: int,
    together: int,
    obstacles: str | None,
    facets: int,
    cone: Pyramid,
) -> int:
    """0 if every scene has an order, 1 if some has none, 2 if some could not be planned."""
    if output is None:
        raise InputError(f"{folder} is a folder: say with -o into which folder its plans go")
    if output.resolve() == folder.resolve():
        raise InputError(f"{output}: plans go into another folder than the scenes")
    if output.is_file():
        raise InputError(f"{output} is a file: plans of a folder go into a folder")
    in_the_way = None if obstacles is None else load_scene(obstacles)
    try:
        # Ray tells of lost machines on standard output, which is for the answer.
        with reporting_files(), redirect_stdout(sys.stderr), ManyProgress() as progress:
            many = plan_many(
                folder,
                engine,
                output,
                test=test,
                node_limit=node_limit,
                time_limit=time_limit,
                shortcuts=shortcuts,
                hold=hold,
                clear_path=clear_path,
                margin=margin,
                order=order,
                moves=moves,
                together=together,
                obstacles=in_the_way,
                facets=facets,
                cone=cone,
                workers=workers,
                address=address,
                progress=progress,
            )
    except ValueError as error:
        raise InputError(str(error)) from None
    if as_json:
        print(json.dumps(many.to_dict(), indent=2))
    else:
        _print(many, output)
    if many.bad:
        names = shorten(Path(answer.name).name for answer in many.bad)
        print(f"drystone: {len(many.bad)} of {len(many)} not planned: {names}", file=sys.stderr)
    return _status(many)


def _status(many: ManyPlans) -> int:
    if many.interrupted:
        return INTERRUPTED
    if many.bad:
        return BAD_INPUT
    return 1 if many.without_order else 0


def _print(many: ManyPlans, output: Path) -> None:
    out = console()
    every = many.found == len(many) and not many.interrupted
    out.print(str(many), style="bold green" if every else "bold red")
    if many.bad or many.without_order:
        out.print(_table(many))
    out.print(f"plans: {shown(str(output))}", soft_wrap=True)


def _table(many: ManyPlans) -> Table:
    made = table("scene", WHY, left=[WHY])
    rows = [*many.bad, *many.without_order]
    for answer in rows[:MOST_ROWS]:
        made.add_row(shown(answer.name), shown(answer.error or answer.status))
    return cut(made, len(rows))
