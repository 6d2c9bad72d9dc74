"""Assemblies of CAD parts and scanned stones that others published: import, check and plan.

    python benchmarks/cad.py LearningToAssemble/data/assembly/* --fixed 0 --hold 2
    python benchmarks/cad.py compas_cra/src/compas_cra/data/samples/armadillo.json

Each argument is a folder of part meshes or a file that `drystone import` reads, with nothing
changed in it by hand. The data are those of github.com/KIKI007/LearningToAssemble,
github.com/yunshengtian/ASAP (assets/beam_assembly) and github.com/BlockResearchGroup/compas_cra;
they are not kept here. Seconds are of processor time. One line each: bodies, triangles of those
that are surfaces, seconds to import, contact points and seconds to find them, seconds of a check
and whether it stands, then the plan's status, its seconds with the check of the whole, its tests,
and these seconds for one of them.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import drystone as ds

HEAD = (
    "assembly",
    "bodies",
    "triangles",
    "import s",
    "contacts",
    "find s",
    "check s",
    "stands",
    "plan",
    "plan s",
    "tests",
    "s a test",
)


def timed(work: Callable[[], Any]) -> tuple[Any, float]:
    """What work gives, and its seconds of processor time."""
    start = time.process_time()
    done = work()
    return done, time.process_time() - start


def measured(path: Path, options: argparse.Namespace) -> list[str]:
    """One line of the table; what is refused says why."""
    try:
        imported, import_seconds = timed(lambda: ds.imports.load(path, tolerance="auto"))
        names = {body.name for body in imported.bodies}
        fixed = [name for name in options.fixed if name in names]
        if fixed or options.ground:
            imported, import_seconds = timed(
                lambda: ds.imports.load(
                    path,
                    tolerance="auto",
                    fixed=fixed,
                    ground=options.ground,
                    friction=options.friction,
                    density=options.density,
                )
            )
        scene = imported.scene
        contacts, find_seconds = timed(lambda: scene.contacts)
        verdict, check_seconds = timed(lambda: ds.check(scene))
    except ds.SceneError as error:
        return [path.stem, str(error)[:150]]
    surfaces = [body.triangles for body in imported.bodies if body.triangles is not None]
    line = [path.stem, str(len(scene)), str(sum(map(len, surfaces))), f"{import_seconds:.2f}",
            str(len(contacts)), f"{find_seconds:.3f}", f"{check_seconds:.3f}",
            "yes" if verdict.stable else "no"]  # fmt: skip
    if options.hold is None:
        return line
    limits = {"hold": options.hold, "clear_path": options.clear_path, "time_limit": options.limit}
    plan, seconds = timed(lambda: ds.plan(scene, **limits))
    a_test = seconds / max(plan.tests, 1)
    return [*line, plan.status, f"{seconds:.2f}", str(plan.tests), f"{a_test:.1e}"]


def main() -> None:
    """Print the table, a line as soon as it is measured."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("paths", nargs="+", type=Path)
    parser.add_argument("--fixed", nargs="*", default=[], help="bodies that never move")
    parser.add_argument("--ground", action="store_true", help="lay a fixed box under all")
    parser.add_argument("--friction", type=float, default=0.55)
    parser.add_argument("--density", type=float, default=None, help="kg/m^3")
    parser.add_argument("--hold", type=int, default=None, help="plan with so many hands")
    parser.add_argument("--clear-path", action="store_true", help="along straight ways out")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds of a plan")
    options = parser.parse_args()
    print("| " + " | ".join(HEAD) + " |", "|" + "---|" * len(HEAD), sep="\n")
    for path in options.paths:
        print("| " + " | ".join(measured(path, options)) + " |", flush=True)


if __name__ == "__main__":
    main()
