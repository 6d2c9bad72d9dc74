"""`drystone bench`."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from drystone.cli.inputs import load_scene, reporting_files
from drystone.cli.output import console
from drystone.common.text import shown


def paper(folder: Path) -> int:
    """Print Table I and the simulations, write the figures; 0 if all was planned and simulated."""
    from drystone import paper

    out = console()
    with reporting_files():
        folder.mkdir(parents=True, exist_ok=True)
        with out.status("planning") as status:
            rows = paper.measure(lambda what: status.update(f"planning {what}"))
            moved = paper.measure_motions(lambda what: status.update(f"simulating {what}"))
            status.update("drawing")
            written = [paper.write_csv(rows, folder), *paper.write_figures(rows, folder)]
            written += [paper.write_motion_csv(moved, folder)]
            written += paper.write_motion_figures(moved, folder)
    for table in (*paper.as_tables(rows), *paper.motion_tables(moved)):
        out.print(table)
    for path in written:
        out.print(f"written: {shown(str(path))}", soft_wrap=True)
    finished = all(run.finished for scene in moved for run in scene.runs.values())
    return 0 if finished and all(row.found for row in rows) else 1


def methods(names: Sequence[str], repeats: int, folder: Path | None, as_json: bool) -> int:
    """Print what reuse gives to each method; 0 if every test had the right answer."""
    from drystone import paper

    out = console()
    # The spinner must not get into somebody's JSON.
    with console(stderr=True).status("building") as status:
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
        out.print(paper.methods_table(found))
        if written is not None:
            out.print(f"written: {shown(str(written))}", soft_wrap=True)
    return 0 if all(one.failures == 0 for one in found) else 1
