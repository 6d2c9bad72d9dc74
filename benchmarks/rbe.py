"""Verdicts and times beside compas_cra's rigid-block equilibrium (RBE), in one process.

    .venv/bin/pip install compas_cra==0.8.0
    .venv/bin/python benchmarks/rbe.py [CASE ...] [--json]

The questions are compas_cra's own samples, with the supports and coefficients of its examples, and
running-bond walls. Both sides are given the same blocks: theirs as a COMPAS assembly, ours by
`drystone.imports.load` of the same assembly in a file. RBE lets contacts pull at a price; a
structure stands if in its solution none does. Their verdict is read as clear if the largest pull is
below 1e-4 or above 1e-2 of the largest push.

"from scratch" is a question about the complete structure, from its blocks on: interfaces or
contacts (ours with the scene read from JSON), formulation and solution, the least of a few
repetitions; the part of finding interfaces is also given alone. "in a
plan" is the mean over the stability tests of `ds.plan`, and for RBE, which keeps nothing between
calls but the interfaces, the mean of solves of up to five of the sub-assemblies that the plan
puts up.
"""

from __future__ import annotations

import threads  # noqa: F401  (before anything that loads NumPy)

# isort: split

import argparse
import contextlib
import io
import json
import os
import tempfile
import time
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import compas
import compas_cra
import numpy as np
from compas.datastructures import Mesh
from compas.geometry import Box, Frame
from compas_assembly.datastructures import Block
from compas_cra.algorithms import assembly_interfaces_numpy
from compas_cra.datastructures import CRA_Assembly
from compas_cra.equilibrium import rbe_solve
from compas_cra.geometry import Arch
from rich.console import Console
from rich.table import Table

import drystone as ds

SAMPLES = Path(os.path.dirname(compas_cra.__file__)) / "data" / "samples"
GRAVITY = 9.81
CLEAR = (1e-4, 1e-2)
"""Shares of the largest push: a largest pull below the first is zero, above the other it is not."""

REPEATS = 3
"""The least of so many repetitions; one if it takes more than a second."""

SUB_ASSEMBLIES = 5
"""So many sub-assemblies of a plan are put to RBE."""


@dataclass(frozen=True)
class Case:
    """One structure, and how compas_cra's example asks about it."""

    name: str
    build: Callable[[], CRA_Assembly]
    friction: float = 0.84
    turned: float = 0.0
    """Degrees about the y axis."""
    least_area: float = 1e-2
    """Of an interface, and how far from plane it may be: what the example passes to RBE."""
    flat: float = 1e-2


@dataclass
class Answer:
    """One row of the table."""

    case: str
    blocks: int
    points: int
    contacts: int
    rbe: str
    ours: str
    expected_same: bool
    rbe_interfaces: float
    rbe_scratch: float
    our_scratch: float
    rbe_in_plan: float | None
    our_in_plan: float | None


def sample(name: str, supports: Iterable[int]) -> Callable[[], CRA_Assembly]:
    """A sample of compas_cra's with blocks fixed."""

    def build() -> CRA_Assembly:
        assembly = compas.json_load(SAMPLES / f"{name}.json").copy(cls=CRA_Assembly)
        assembly.set_boundary_conditions(supports)
        return assembly

    return build


def arch() -> CRA_Assembly:
    """The arch of compas_cra's example: 20 voussoirs, the outer two of them supports."""
    return Arch(height=5, span=10, thickness=0.5, depth=0.5, num_blocks=20).assembly()


def wall(rows: int, columns: int) -> Callable[[], CRA_Assembly]:
    """Bricks of 2 x 1 x 1 in running bond on a fixed slab."""

    def build() -> CRA_Assembly:
        assembly = CRA_Assembly()
        for row in range(rows):
            for column in range(columns):
                x = 2.0 * column + (row % 2)
                assembly.add_block(_box((x, 0.0, row + 0.5), (2.0, 1.0, 1.0)))
        slab = assembly.add_block(_box((columns - 0.5, 0.0, -0.5), (2.0 * columns + 4, 3.0, 1.0)))
        assembly.set_boundary_conditions([slab])
        return assembly

    return build


def _box(center: tuple[float, float, float], size: tuple[float, float, float]) -> Block:
    box = Box(*size, frame=Frame(center, [1, 0, 0], [0, 1, 0]))
    return Mesh.from_shape(box).copy(cls=Block)


CASES = [
    *(Case(f"type-{letter}", sample(f"type-{letter}", [0, 1]), turned=90) for letter in "abcd"),
    Case("cubes", sample("cubes", [0])),
    Case("bridge", sample("bridge", [0, 1]), 0.9, least_area=1e-6, flat=1e-4),
    Case("shelf-stable", sample("shelf-stable", [0]), least_area=1e-6, flat=1e-4),
    Case("shelf", sample("shelf", [0]), least_area=1e-6, flat=1e-4),
    Case("arch", arch, 0.7),
    Case("wall 5 x 5", wall(5, 5)),
    Case("wall 10 x 10", wall(10, 10)),
]


def measure(case: Case) -> Answer:
    """Both verdicts and all times of one case."""
    assembly = case.build()
    found = _least(lambda: _interfaces(case, case.build()))
    _interfaces(case, assembly)
    if case.turned:
        assembly.rotate_assembly([0, 0, 0], [0, 1, 0], case.turned)
    solved = _least(lambda: _solve(assembly, case.friction))
    scene = _scene(case)
    verdict = ds.check(scene)
    text = scene.to_json()
    ours = _least(lambda: ds.check(ds.Scene.from_json(text)))
    rbe_in_plan, our_in_plan = _in_plan(case, scene) if verdict.stable else (None, None)
    pull = _pull(assembly)
    return Answer(
        case.name,
        assembly.graph.number_of_nodes(),
        sum(len(interface.points) for interface in _all_interfaces(assembly)),
        len(scene.contacts),
        "stands" if pull < CLEAR[0] else "falls" if pull > CLEAR[1] else f"unclear ({pull:.0e})",
        "stands" if verdict.stable else "falls",
        not CLEAR[0] <= pull <= CLEAR[1],
        found,
        found + solved,
        ours,
        rbe_in_plan,
        our_in_plan,
    )


def _interfaces(case: Case, assembly: CRA_Assembly) -> None:
    blocks = assembly.graph.number_of_nodes()
    assembly_interfaces_numpy(assembly, nmax=blocks, amin=case.least_area, tmax=case.flat)


def _solve(assembly: CRA_Assembly, friction: float) -> None:
    with contextlib.redirect_stdout(io.StringIO()):
        rbe_solve(assembly, mu=friction)


def _all_interfaces(assembly: CRA_Assembly) -> list[Any]:
    edges = assembly.graph.edges()
    return [i for edge in edges for i in assembly.graph.edge_attribute(edge, "interfaces")]


def _pull(assembly: CRA_Assembly) -> float:
    forces = [force for interface in _all_interfaces(assembly) for force in interface.forces]
    return max(f["c_nn"] for f in forces) / max(f["c_np"] for f in forces)


def _scene(case: Case) -> ds.Scene:
    """The same blocks, read from the file that COMPAS writes."""
    angle = np.radians(case.turned)
    # Instead of the blocks, gravity is turned: the other way.
    gravity = (GRAVITY * np.sin(angle), 0.0, -GRAVITY * np.cos(angle))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "assembly.json"
        compas.json_dump(case.build(), path)
        return ds.imports.load(path, friction=case.friction, density=1.0, gravity=gravity).scene


def _in_plan(case: Case, scene: ds.Scene) -> tuple[float | None, float | None]:
    plan = ds.plan(scene)
    # Where there is no order, what was put up before that was known.
    order = [name for name in plan.reached if not scene.body(name).fixed]
    if not plan.tests or not order:
        return None, None
    mine = min(ds.plan(scene).test_seconds for _ in range(REPEATS))
    times = []
    for count in np.unique(np.linspace(1, len(order), SUB_ASSEMBLIES).astype(int)):
        part = _part(case, set(order[:count]))
        if _all_interfaces(part):
            times.append(_least(lambda part=part: _solve(part, case.friction)))
    return (float(np.mean(times)), mine / plan.tests) if times else (None, None)


def _part(case: Case, kept: set[str]) -> CRA_Assembly:
    """The blocks named, with the supports, and their interfaces."""
    part = case.build()
    part.delete_blocks(
        [n for n in part.graph.nodes() if str(n) not in kept and not part.is_block_support(n)]
    )
    _interfaces(case, part)
    if case.turned:
        part.rotate_assembly([0, 0, 0], [0, 1, 0], case.turned)
    return part


def _least(run: Callable[[], Any]) -> float:
    """Seconds of the fastest of a few runs."""
    best = float("inf")
    for _ in range(REPEATS):
        start = time.perf_counter()
        run()
        best = min(best, time.perf_counter() - start)
        if best > 1:
            break
    return best


def main() -> int:
    """Measure what the arguments say; 1 if a clear verdict differs."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("cases", nargs="*", metavar="CASE", help="; ".join(c.name for c in CASES))
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    unknown = set(arguments.cases) - {case.name for case in CASES}
    if unknown:
        parser.error(f"no case is called {min(unknown)!r}")
    answers = [measure(c) for c in CASES if not arguments.cases or c.name in arguments.cases]
    if arguments.json:
        print(json.dumps([asdict(answer) for answer in answers], indent=2))
    else:
        console = Console()
        console.width = max(console.width, 160)
        console.print(_table(answers))
    return int(any(answer.expected_same and answer.rbe != answer.ours for answer in answers))


def _table(answers: list[Answer]) -> Table:
    table = Table()
    for title in ("case", "blocks", "points", "RBE", "drystone"):
        table.add_column(title, no_wrap=True)
    for title in ("interfaces", "RBE", "drystone", "ratio", "RBE in a plan", "drystone", "ratio"):
        table.add_column(title, justify="right", no_wrap=True)
    for a in answers:
        inside = ("", "", "")
        if a.rbe_in_plan is not None and a.our_in_plan is not None:
            inside = (
                _ms(a.rbe_in_plan),
                _ms(a.our_in_plan),
                f"{a.rbe_in_plan / a.our_in_plan:.0f}",
            )
        table.add_row(
            a.case,
            str(a.blocks),
            f"{a.points}, {a.contacts}",
            a.rbe,
            a.ours,
            _ms(a.rbe_interfaces),
            _ms(a.rbe_scratch),
            _ms(a.our_scratch),
            f"{a.rbe_scratch / a.our_scratch:.0f}",
            *inside,
        )
    return table


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:.3g} ms"


if __name__ == "__main__":
    raise SystemExit(main())
