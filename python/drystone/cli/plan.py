"""`drystone plan`."""

from __future__ import annotations

import json
from itertools import groupby
from pathlib import Path

from drystone.cli.inputs import load_scene, page_path, picture_path, reporting_files
from drystone.plan_answer import Plan
from drystone.planning import plan
from drystone.progress import ForcesProgress, PlanProgress


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
        print(json.dumps(found.to_dict(), indent=2))
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
    from rich.console import Console
    from rich.table import Table

    console = Console(highlight=False)
    console.print(str(found).splitlines()[0], style="bold green" if found.found else "bold red")
    facts = Table.grid(padding=(0, 2))
    if found.found:
        facts.add_row("remove, in this order", " ".join(found.order))
    else:
        facts.add_row("largest that stands", " ".join(found.reached) or "nothing")
        facts.add_row("falls with any of", " ".join(found.falls_next) or "nothing tried")
        if found.whole is not None:
            facts.add_row("the whole assembly", str(found.whole))
    if any(found.holds):
        facts.add_row("hold and release", _hold_steps(found))
    if found.directions:
        facts.add_row("leaving towards", _directions(found))
    for one in found.blocked:
        facts.add_row(f"in the way of {one.name}", " ".join(one.by))
    facts.add_row("stability test", found.test)
    console.print(facts)
    if picture is not None:
        what = "page" if page_path(picture) else "picture"
        console.print(f"{what}: {picture}", soft_wrap=True)


def _hold_steps(found: Plan) -> str:
    """What hands do, by the block before whose removal they do it."""
    order = found.order or tuple(reversed(found.reached))
    before: dict[int, list[str]] = {}
    for action, name, k in found.hold_steps:
        before.setdefault(k, []).append(f"{action} {name}")
    return "; ".join(f"before {order[k]}: {', '.join(steps)}" for k, steps in before.items())


def _directions(found: Plan) -> str:
    """Rounded, without minus zeros; runs of the same one are counted."""
    texts = (_numbers(way) for way in found.directions)
    runs = ((text, len(list(run))) for text, run in groupby(texts))
    return " ".join(text if count == 1 else f"{count} x {text}" for text, count in runs)


def _numbers(way: tuple[float, ...]) -> str:
    return f"({','.join(f'{round(x, 3) + 0.0:g}' for x in way)})"
