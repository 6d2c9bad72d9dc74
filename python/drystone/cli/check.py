"""`drystone check`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from drystone.cli.errors import InputError
from drystone.cli.forces import with_forces_in_time
from drystone.cli.inputs import chosen, load_scene, numbers, picture_path, said_of, write
from drystone.cli.output import console
from drystone.common.cones import ConeOfCheck
from drystone.common.drawn import Drawn
from drystone.common.files import JSON, PAGE
from drystone.common.progress import StrongProgress
from drystone.common.text import counted
from drystone.equilibrium.contact_force import ANY, CANONICAL, WhichForces
from drystone.equilibrium.verdict import Verdict, check
from drystone.report.tables import joints_table, verdict_table
from drystone.scene import Scene


def run(
    scene_name: str,
    blocks: str | None,
    block: Sequence[str] | None,
    as_json: bool,
    output: Path | None,
    facets: int,
    cone: ConeOfCheck,
    forces: WhichForces | None,
    strong: bool,
    budget: int | None,
    settle: Sequence[str] | None,
) -> int:
    """0 if it stands, 1 if not, 2 if there is no verdict.

    A settlement that no rigid blocks can follow, or without an answer, is 2 as well.

    With `strong` 0 if it must stand, 1 if it need not, 2 if that was not decided.
    """
    picture = picture_path(output, PAGE, JSON)
    scene = load_scene(scene_name)
    names = chosen(blocks, block)
    if budget is not None and not strong:
        raise InputError("--strong-budget goes with --strong")
    for text in settle or ():
        _add_settlement(scene, text)
    with StrongProgress() as progress:
        verdict = check(
            scene,
            names,
            facets=facets,
            cone=cone,
            forces=forces or CANONICAL,
            strong=strong,
            strong_budget=budget,
            progress=progress,
        )
    if forces is None:
        verdict = with_forces_in_time(verdict)
    write(verdict, _drawn(verdict, picture), picture)
    if as_json:
        verdict.write_json(sys.stdout)
    else:
        _print(verdict, picture)
    if verdict.status != "solved":
        raise InputError(f"{scene_name}: no verdict ({verdict.status})")
    if strong and verdict.must_stand is None:
        nodes = counted(verdict.nodes or 0, "node")
        hint = "" if scene.dimension == 3 else "; --strong-budget sets how many"
        raise InputError(f"{scene_name}: not decided whether it must stand ({nodes}{hint})")
    if verdict.settled is not None and verdict.settled.status != "solved":
        raise InputError(f"{scene_name}: {verdict.settled}")
    return 0 if (verdict.must_stand if strong else verdict.stable) else 1


def _drawn(verdict: Verdict, picture: Path | None) -> Drawn:
    """What a picture is of. The page of a verdict has its settlement in it."""
    if verdict.settled is not None:
        return (
            verdict if picture is not None and picture.suffix.lower() == PAGE else verdict.settled
        )
    return verdict.escape or verdict


def _add_settlement(scene: Scene, text: str) -> None:
    name, colon, moved = text.rpartition(":")
    given = numbers(moved, f"--settle {text}") if colon else ()
    n = scene.dimension
    turns = 1 if n == 2 else 3
    if not colon or len(given) not in (n, n + turns):
        raise InputError(
            f"--settle {text}: give a support and {n} numbers in metres, as "
            f"right:{','.join(['0'] * (n - 1))},-0.01; behind them, if it turns, {turns} in radians"
        )
    turn = None if len(given) == n else given[n] if n == 2 else given[n:]
    scene.add_settlement(name, given[:n], turn)


def _print(verdict: Verdict, picture: Path | None) -> None:
    out = console()
    undecided = verdict.status != "solved"
    colour = "yellow" if undecided else "green" if verdict.stable else "red"
    out.print(str(verdict), style=f"bold {colour}")
    if verdict.settled is not None:
        if verdict.settled.joints:
            out.print(joints_table(verdict.settled))
    else:
        out.print(verdict_table(verdict))
    if verdict.settled is None and verdict.stable and verdict.forces.kind == ANY:
        out.print("These forces are some of many; --forces canonical computes those of least norm.")
    if picture is not None:
        out.print(said_of(picture), soft_wrap=True)
