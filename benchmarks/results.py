"""Results as CSV: a line for each peer on each workload, a file for each machine and version."""

from __future__ import annotations

import argparse
import csv
import datetime
import math
import os
import platform
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import drystone as ds
from measure import Measured
from scenes import Row

WHERE = ("version", "date", "machine", "cpu", "load")
"""What every line of every file begins with."""

COLUMNS = (
    *WHERE,
    "scene",
    "blocks",
    "generators",
    "friction",
    "workload",
    "note",
    "peer",
    "peer_version",
    "queries",
    "answered",
    "missing",
    "checked",
    "wrong",
    "residual",
    "inaccurate",
    "seconds",
    "seconds_least",
    "seconds_most",
    "rounds",
    "ratio_to_reuse",
    "ratio_of_least",
    "iterations",
    "entries",
    "memory_mb",
    "cut_off",
    "refused",
)
"""Explained in benchmarks/README.md."""


@dataclass(slots=True)
class Case:
    """One row of the tables: a workload on an assembly, with everybody's results."""

    row: Row
    workload: str
    note: str
    blocks: int
    generators: int
    results: dict[str, Measured]
    load: float = math.nan
    """The machine's load average while this was measured; above 1 others were at work too."""

    @property
    def fastest(self) -> Measured | None:
        """The fastest of the others that answered everything, and nothing known to be wrong."""
        others = [r for r in self.results.values() if r.right and r.version and not _ours(r)]
        return min(others, key=lambda result: result.seconds, default=None)

    def ratio(self, result: Measured) -> float:
        """A peer's median time by that of reuse; a lower bound if the peer was cut off."""
        reuse = self.results.get("reuse")
        if reuse is None or not reuse.right or not result.times:
            return math.nan
        return result.seconds / reuse.seconds

    def ratio_of_least(self, result: Measured) -> float:
        """As `ratio`, of the least times."""
        reuse = self.results.get("reuse")
        if reuse is None or not reuse.right or not result.times:
            return math.nan
        return result.least / reuse.least


def _ours(result: Measured) -> bool:
    return result.peer.startswith("drystone")


def machine() -> str:
    """The kind of machine: architecture and cores."""
    return f"{platform.machine()}-{os.cpu_count()}core"


def add_output(parser: argparse.ArgumentParser) -> None:
    """The option that says where results go."""
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        default=Path(__file__).parent / "results",
        metavar="DIR",
        help="where results go (default: benchmarks/results)",
    )


def path_in(folder: Path) -> Path:
    """Where this run's results go, without the file's ending."""
    return folder / machine() / f"{ds.__version__}-{datetime.date.today().isoformat()}"


def write(path: Path, cases: Iterable[Case]) -> None:
    """Write the file of stability tests anew."""
    write_lines(path, COLUMNS, (line for case in cases for line in _lines(case)))


def write_lines(path: Path, columns: Iterable[str], lines: Iterable[dict[str, object]]) -> None:
    """Write a file anew, whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_suffix(".unfinished")
    with unfinished.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(columns), lineterminator="\n")
        writer.writeheader()
        writer.writerows(lines)
    unfinished.replace(path)


def _lines(case: Case) -> Iterator[dict[str, object]]:
    common = where(case.load) | {
        "scene": case.row.scene,
        "blocks": case.blocks,
        "generators": case.generators,
        "friction": f"{case.row.friction:g}",
        "workload": case.workload,
        "note": case.note,
    }
    for r in case.results.values():
        yield common | {
            "peer": r.peer,
            "peer_version": r.version,
            "queries": r.queries,
            "answered": r.answered,
            "missing": r.missing,
            "checked": r.checked,
            "wrong": r.wrong,
            "residual": number(r.residual, 3),
            "inaccurate": r.inaccurate,
            "seconds": number(r.seconds, 5),
            "seconds_least": number(r.least, 5),
            "seconds_most": number(max(r.times, default=math.nan), 5),
            "rounds": len(r.times),
            "ratio_to_reuse": number(case.ratio(r), 4),
            "ratio_of_least": number(case.ratio_of_least(r), 4),
            "iterations": r.iterations,
            "entries": "" if r.entries is None else r.entries,
            "memory_mb": number(r.memory, 3),
            "cut_off": r.cut_off,
            "refused": r.refused,
        }


def load() -> float:
    """How many processes want to run, over the last minute; NaN where the system does not say."""
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else math.nan


def where(load: float) -> dict[str, object]:
    """The columns of `WHERE`, today and here."""
    return {
        "version": ds.__version__,
        "date": datetime.date.today().isoformat(),
        "machine": machine(),
        "cpu": _cpu(),
        "load": number(load, 2),
    }


def number(value: float, digits: int) -> str:
    """A number for a table; nothing for NaN."""
    return "" if math.isnan(value) else f"{value:.{digits}g}"


def _cpu() -> str:
    """The processor's model, where the system says."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), "")
