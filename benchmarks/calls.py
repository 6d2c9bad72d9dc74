"""Whole calls of a user on the structures on which they take longest, each in a process of its own.

    .venv/bin/python benchmarks/calls.py [--only NAME ...] [--limit SECONDS]

A plan, the first step of a world, the forces of a verdict, and the command line with what it
writes: from the scene to the end of the call, seconds by a clock around it, and the peak of the
process's memory. What takes longer than the limit is stopped, and says so.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from rich.console import Console
from rich.table import Table

import cold_scenes
import drystone as ds

LIMIT = 120.0
"""Seconds."""

Call = Callable[[], object]


def _plan(scene: ds.Scene, hold: int = 0) -> Call:
    return lambda: f"{ds.plan(scene, hold=hold).status}"


def _first_step(scene: ds.Scene) -> Call:
    world = ds.World(scene)
    return lambda: f"{world.step().pivots} pivots"


def _forces(scene: ds.Scene) -> Call:
    verdict = ds.check(scene)
    return lambda: f"{len(verdict.forces.vectors)} forces, {verdict.forces.kind}"


def _command(*arguments: str) -> Call:
    def call() -> str:
        command = Path(sys.executable).with_name("drystone")
        done = subprocess.run([command, *arguments], capture_output=True, check=True)
        return f"{len(done.stdout) / 1e6:.1f} MB written"

    return call


CALLS: dict[str, Callable[[], Call]] = {
    "plan bricks 40 x 60": lambda: _plan(ds.scenes.brick_wall(40, 60)),
    "plan bricks 70 x 100": lambda: _plan(ds.scenes.brick_wall(70, 100)),
    "plan dome of 4 rings, 1 hand": lambda: _plan(cold_scenes.dome(4, 0.7), hold=1),
    "plan dome of 6 rings, 2 hands": lambda: _plan(cold_scenes.dome(6, 0.7), hold=2),
    "plan dome of 8 rings, 2 hands": lambda: _plan(cold_scenes.dome(8, 0.7), hold=2),
    "first step, loose brick 8": lambda: _first_step(cold_scenes.loose_brick(8)),
    "first step, loose brick 12": lambda: _first_step(cold_scenes.loose_brick(12)),
    "forces, wall of 40": lambda: _forces(ds.scenes.wall(40, columns=40)),
    "forces, wall of 60": lambda: _forces(ds.scenes.wall(60, columns=60)),
    "check wall:300,columns=300": lambda: _command("check", "wall:300,columns=300", "--json"),
    "plan wall:300,columns=300": lambda: _command("plan", "wall:300,columns=300", "--json"),
}


def one(name: str) -> dict[str, object]:
    """A call in this process: seconds, megabytes, and what came out."""
    call = CALLS[name]()
    begun = time.perf_counter()
    said = call()
    seconds = time.perf_counter() - begun
    who = resource.RUSAGE_CHILDREN if "wall:" in name else resource.RUSAGE_SELF
    peak = resource.getrusage(who).ru_maxrss / 1024
    return {"seconds": seconds, "megabytes": peak, "said": said}


def apart(name: str, limit: float) -> tuple[str, str, str]:
    """The same in another process: a line of the table."""
    command = [sys.executable, __file__, "--one", name]
    try:
        done = subprocess.run(command, capture_output=True, timeout=limit, text=True)
    except subprocess.TimeoutExpired:
        return f"more than {limit:g}", "", "stopped"
    if done.returncode != 0:
        return "", "", done.stderr.strip().splitlines()[-1]
    found = json.loads(done.stdout)
    return f"{found['seconds']:.3g}", f"{found['megabytes']:.0f}", str(found["said"])


def main() -> None:
    """Measure what the arguments say."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--only", nargs="+", default=list(CALLS), choices=CALLS, metavar="NAME")
    parser.add_argument("--limit", type=float, default=LIMIT, metavar="SECONDS")
    parser.add_argument("--one", choices=CALLS, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.one is not None:
        print(json.dumps(one(arguments.one)))
        return
    table = Table("call", "s", "MB", "")
    for name in arguments.only:
        line = apart(name, arguments.limit)
        print(f"{name}: {', '.join(line)}", file=sys.stderr, flush=True)
        table.add_row(name, *line)
    Console(width=120).print(table)


if __name__ == "__main__":
    main()
