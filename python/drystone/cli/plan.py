"""`drystone plan`."""

from __future__ import annotations

import sys
from itertools import groupby
from pathlib import Path

from drystone.cli.inputs import load_scene, page_path, picture_path, reporting_files
from drystone.cli.output import console, facts, names
from drystone.common.progress import ForcesProgress, PlanProgress
from drystone.common.text import shown
from drystone.planning.answer import Plan
from drystone.planning.search import plan


def run(
    scene_name: str,
    test: str,
    node_limit: int | None,
    time_limit: float | None,
    shortcuts: bool,
    threads: int | None,
    hold: int,
    clear_path: bool,
    facets: int,
    cone: str,
    as_json: bool,
    output: Path | None,
) -> int:
    """0 if an order was found, 1 if not."""
    picture = picture_path(output, ".html")
    scene = load_scene(scene_name)
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
            facets=facets,
            cone=cone,
        )
    if picture is not None:
        with reporting_files():
            _write(found, picture)
    if as_json:
        found.write_json(sys.stdout)
    else:
        _print(found, picture)
    return 0 if found.found else 1


def _write(found: Plan, path: Path) -> None:
    if not page_path(path):
        found.draw(path)
        return
    with ForcesProgress() as progress:
        page = found.view(progress)
    page.save(path)


def _print(found: Plan, picture: Path | None) -> None:
    out = console()
    out.print(str(found).splitlines()[0], style="bold green" if found.found else "bold red")
    told = facts()
    if found.found:
        told.add_row("remove, in this order", names(found.order))
    else:
        told.add_row("largest that stands", names(found.reached) or "nothing")
        told.add_row("falls with any of", names(found.falls_next) or "nothing tried")
        if found.whole is not None:
            told.add_row("the whole assembly", str(found.whole))
    if any(found.holds):
        told.add_row("hold and release", _hold_steps(found))
    if found.directions:
        told.add_row("leaving towards", _directions(found))
    for one in found.blocked:
        told.add_row(f"in the way of {shown(one.name)}", names(one.by))
    told.add_row("stability test", found.test)
    out.print(told)
    if picture is not None:
        what = "page" if page_path(picture) else "picture"
        out.print(f"{what}: {shown(str(picture))}", soft_wrap=True)


def _hold_steps(found: Plan) -> str:
    """What hands do, by the block before whose removal they do it."""
    order = found.order or tuple(reversed(found.reached))
    before: dict[int, list[str]] = {}
    for action, name, k in found.hold_steps:
        before.setdefault(k, []).append(f"{action} {shown(name)}")
    return "; ".join(f"before {shown(order[k])}: {', '.join(steps)}" for k, steps in before.items())


def _directions(found: Plan) -> str:
    """Rounded, without minus zeros; runs of the same one are counted."""
    texts = (_numbers(way) for way in found.directions)
    runs = ((text, len(list(run))) for text, run in groupby(texts))
    return " ".join(text if count == 1 else f"{count} x {text}" for text, count in runs)


def _numbers(way: tuple[float, ...]) -> str:
    return f"({','.join(f'{round(x, 3) + 0.0:g}' for x in way)})"
