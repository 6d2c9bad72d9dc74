"""Time related stability tests: drystone and its peers, one process, one thread, in turns.

    python benchmarks/run.py [--quick] [--scenes ...] [--workloads ...] [--peers ...] [-o DIR]

Results go to DIR/<machine>/<version>-<date>.csv with pictures beside it, and to the screen. The
file is rewritten after every workload, so that an interrupted run leaves what it measured.
"""

from __future__ import annotations

import threads  # noqa: F401  (before anything that loads NumPy)

# isort: split

import argparse

from rich.console import Console

import drystone as ds
import memory
import plots
import reference
import report
import results
import scenes
from assembly import Assembly
from measure import Measured, measure
from peers import PEERS
from steps import Workload
from workloads import WORKLOADS


def main() -> None:
    """Measure what the arguments say."""
    arguments = _arguments()
    console = Console()
    console.width = max(console.width, 100)
    names = tuple(arguments.scenes or (scenes.QUICK if arguments.quick else scenes.SCENES))
    path = results.path_in(arguments.output)
    if arguments.quick:
        path = path.with_name(path.name + "-quick")
    cases: list[results.Case] = []
    for row in scenes.rows(names):
        with console.status(f"{row}: the scene"):
            scene = row.build_within(arguments.cap)
        if scene is None:
            console.print(f"[red]{row}: not built within {arguments.cap:g} s, nothing measured[/]")
            cases += [_unbuilt(arguments, row, name) for name in arguments.workloads]
            continue
        assembly = Assembly.of(scene)
        with console.status(f"{row}: planning, for the order of the questions"):
            plan = ds.plan(scene, time_limit=arguments.cap)
        for name in arguments.workloads:
            with console.status(f"{row}, {name}: the questions"):
                workload = WORKLOADS[name](scene, assembly, plan)
            cases.append(_case(console, arguments, row, scene, assembly, workload))
            report.show(console, cases[-1])
            results.write(path.with_name(path.name + ".csv"), cases)
    report.show_summary(console, cases)
    for written in (path.with_name(path.name + ".csv"), *plots.draw(cases, path)):
        console.print(f"wrote {written}", soft_wrap=True)


def _case(
    console: Console,
    arguments: argparse.Namespace,
    row: scenes.Row,
    scene: ds.Scene,
    assembly: Assembly,
    workload: Workload,
) -> results.Case:
    peers = {key: PEERS[key] for key in arguments.peers}
    with console.status(f"{row}, {workload.name}: the right answers") as status:
        right = reference.verdicts(assembly, workload)

        def say(text: str) -> None:
            status.update(f"{row}, {workload.name}: {text}")

        measured = measure(scene, assembly, workload, right, peers, arguments.cap, say)
        for key, result in measured.items():
            if arguments.memory and not result.refused and not result.cut_off:
                say(f"{result.peer}, memory")
                result.memory = memory.grown(scene, workload, key, arguments.cap)
    counts = (len(assembly), len(assembly.bodies))
    load = results.load()
    return results.Case(row, workload.name, workload.note, *counts, measured, load)


def _unbuilt(arguments: argparse.Namespace, row: scenes.Row, workload: str) -> results.Case:
    reason = f"the scene was not built within {arguments.cap:g} s"
    nothing = {
        key: Measured(PEERS[key].name, PEERS[key].version() or "", 0, refused=reason)
        for key in arguments.peers
    }
    return results.Case(row, workload, reason, 0, 0, nothing)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="only col80 and pyr13")
    parser.add_argument("--scenes", nargs="+", choices=scenes.SCENES, metavar="SCENE")
    parser.add_argument("--workloads", nargs="+", choices=WORKLOADS, default=list(WORKLOADS))
    parser.add_argument("--peers", nargs="+", choices=PEERS, default=list(PEERS), metavar="PEER")
    parser.add_argument(
        "--cap",
        type=float,
        default=60.0,
        metavar="S",
        help="seconds of solver time after which a peer is cut off (default: 60)",
    )
    parser.add_argument(
        "--no-memory",
        dest="memory",
        action="store_false",
        help="leave out the runs in processes of their own that measure memory",
    )
    results.add_output(parser)
    return parser.parse_args()


if __name__ == "__main__":
    main()
