"""`drystone bench`."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from drystone.cli.inputs import load_scene, reporting_files


def paper(folder: Path) -> int:
    """Print Table I and write the figures; 0 if every assembly was planned."""
    from rich.console import Console

    from drystone import paper

    console = Console(highlight=False)
    with reporting_files():
        folder.mkdir(parents=True, exist_ok=True)
        with console.status("planning") as status:
            rows = paper.measure(lambda what: status.update(f"planning {what}"))
            status.update("drawing")
            written = [paper.write_csv(rows, folder), *paper.write_figures(rows, folder)]
    for table in paper.as_tables(rows):
        console.print(table)
    for path in written:
        console.print(f"written: {path}", soft_wrap=True)
    return 0 if all(row.found for row in rows) else 1


def methods(names: Sequence[str], repeats: int, folder: Path | None, as_json: bool) -> int:
    """Print what reuse gives to each method; 0 if every test had the right answer."""
    from rich.console import Console

    from drystone import paper

    console = Console(highlight=False)
    # The spinner must not get into somebody's JSON.
    with Console(stderr=True).status("building") as status:
        given: paper.Cases = {(name, None): load_scene(name) for name in names}
        with reporting_files():
            if folder is not None:
                folder.mkdir(parents=True, exist_ok=True)
        cases = given or paper.paper_scenes()
        found = paper.measure_methods(cases, repeats, lambda what: status.update(what))
    with reporting_files():
        written = None if folder is None else paper.write_methods_csv(found, folder)
    if as_json:
        print(json.dumps(paper.methods_as_dicts(found), indent=2))
    else:
        console.print(paper.methods_table(found))
        if written is not None:
            console.print(f"written: {written}", soft_wrap=True)
    return 0 if all(one.failures == 0 for one in found) else 1
