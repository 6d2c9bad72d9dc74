"""`drystone plan`."""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from itertools import groupby
from pathlib import Path

from drystone.cli.errors import INTERRUPTED, InputError
from drystone.cli.forces import with_forces_in_time
from drystone.cli.inputs import (
    kind_of,
    load_scene,
    picture_path,
    reporting_files,
    said_of,
    save_film,
)
from drystone.cli.output import console, facts, in_a_row, names
from drystone.common.cones import Pyramid
from drystone.common.files import FILMS, JSON, PAGE
from drystone.common.progress import ForcesProgress, PlanProgress
from drystone.common.text import shown
from drystone.common.units import scale_of
from drystone.planning.answer import Plan
from drystone.planning.search import OrderOfPlan, StabilityTest, plan

MOST_POINTS = 200_000
"""What hands bear is not computed of plans with more contact points, those of all steps together:
it takes longer than a second."""


def run(
    scene_name: str,
    test: StabilityTest,
    node_limit: int | None,
    time_limit: float | None,
    shortcuts: bool,
    threads: int | None,
    hold: int,
    clear_path: bool,
    margin: float,
    order: OrderOfPlan,
    strong: bool,
    facets: int,
    cone: Pyramid,
    as_json: bool,
    output: Path | None,
    moves: int,
    together: int,
    obstacles: str | None,
) -> int:
    """0 if an order was found, 1 if not, 130 after Ctrl-C."""
    if (strong or margin or order != "any") and (hold or test != "reuse"):
        raise InputError(
            "--margin, --order robust and --strong go with --test reuse, without --hold"
        )
    if strong and (margin or order != "any"):
        raise InputError("--strong goes without --margin and --order robust")
    # First, as a folder that is not there must not be told what a picture is called.
    scene = load_scene(scene_name)
    picture = picture_path(output, PAGE, JSON, *FILMS)
    in_the_way = None if obstacles is None else load_scene(obstacles)
    with PlanProgress() as progress:
        found = plan(
            scene,
            test,
            node_limit,
            time_limit,
            progress,
            shortcuts,
            threads,
            hold,
            clear_path,
            margin=margin,
            order=order,
            strong=strong,
            moves=moves,
            together=together,
            obstacles=in_the_way,
            facets=facets,
            cone=cone,
        )
    if found.whole is not None and (as_json or (picture and kind_of(picture) == "answer")):
        found = replace(found, whole=with_forces_in_time(found.whole))
    if picture is not None:
        with reporting_files():
            _write(found, picture)
    if as_json:
        found.write_json(sys.stdout)
    else:
        _print(found, picture)
    if found.status == "interrupted":
        return INTERRUPTED
    return 0 if found.found else 1


def _write(found: Plan, path: Path) -> None:
    if kind_of(path) == "film":
        save_film(found, path)
    elif kind_of(path) != "page":
        found.save(path)
    else:
        with ForcesProgress() as progress:
            page = found.view(progress)
        page.save(path)


def _print(found: Plan, picture: Path | None) -> None:
    out = console()
    out.print(str(found).splitlines()[0], style="bold green" if found.found else "bold red")
    told = facts()
    if found.found:
        told.add_row("remove, in this order", names(found.order))
        told.add_row("put up, in this order", names(found.assembly_order))
    else:
        told.add_row("largest that stands", names(found.reached) or "nothing")
        told.add_row("falls with any of", names(found.falls_next) or "nothing tried")
        if found.whole is not None:
            told.add_row("the whole assembly", str(found.whole))
        if found.next_hold is not None:
            told.add_row("with blocks held", f"there may be an order: --hold {found.next_hold}")
    if found.margin and found.found:
        bears = [f"{m:.3g}" for m in found.margins]
        told.add_row("bears sideways, in g", in_a_row(bears, len(bears)))
    if any(found.holds):
        told.add_row("hold and release", _hold_steps(found))
        if len(found.scene.contacts) * len(found.order or found.reached) <= MOST_POINTS:
            told.add_row("hands bear at most", _hands(found))
    if found.moves:
        told.add_row("leaving towards", _directions(found))
    for group in found.groups:
        told.add_row("leaving together", names(group))
    for one in found.blocked:
        told.add_row(f"in the way of {shown(one.name)}", names(one.by))
    told.add_row("stability test", found.test)
    out.print(told)
    if picture is not None:
        out.print(said_of(picture), soft_wrap=True)


def _hold_steps(found: Plan) -> str:
    """What hands do, by the block before whose removal they do it."""
    order = found.order or tuple(reversed(found.reached))
    before: dict[int, list[str]] = {}
    for action, name, k in found.hold_steps:
        before.setdefault(k, []).append(f"{action} {shown(name)}")
    steps = [f"before {shown(order[k])}: {', '.join(steps)}" for k, steps in before.items()]
    return in_a_row(steps, len(steps), "; ")


def _hands(found: Plan) -> str:
    """For each block that is held the largest force of the hand on it."""
    most: dict[str, float] = {}
    for wrenches in found.hand_forces():
        for name, wrench in wrenches.items():
            force = math.hypot(*wrench[: found.scene.dimension].tolist())
            most[name] = max(most.get(name, 0.0), force)
    size, unit = scale_of(most.values(), "N")
    forces = [f"{shown(name)}: {force / size:.3g} {unit}" for name, force in most.items()]
    return in_a_row(forces, len(forces), ", ")


def _directions(found: Plan) -> str:
    """Rounded, without minus zeros; runs of the same one are counted."""
    texts = (" then ".join(_numbers(move.direction) for move in moves) for moves in found.moves)
    runs = [(text, len(list(run))) for text, run in groupby(texts)]
    ways = [text if count == 1 else f"{count} x {text}" for text, count in runs]
    return in_a_row(ways, len(ways))


def _numbers(way: tuple[float, ...]) -> str:
    return f"({','.join(f'{round(x, 3) + 0.0:g}' for x in way)})"
