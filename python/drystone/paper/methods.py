"""Section VI of the paper: what reuse gives to other methods, on the same stability tests."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from drystone import _core, scenes, statics
from drystone.common.text import shown
from drystone.paper.plain import plain_table

if TYPE_CHECKING:
    from rich.table import Table

    from drystone.scene import Scene

METHODS: Mapping[str, tuple[str | None, str]] = {
    "Dantzig": ("lcp", "reuse-dantzig"),
    "block": ("block", "reuse-block"),
    "Lemke": ("lemke", "reuse-lemke"),
    "LP": ("lp", "lp-warm"),
    "kept basis": (None, "reuse"),
}
"""Each method's test from scratch and with reuse. "kept basis", the planner's own, has only one."""

STRUCTURES: Mapping[str, Callable[[float], Scene]] = {
    "Column 50": lambda friction: scenes.column(50, friction=friction),
    "Column 80": lambda friction: scenes.column(80, friction=friction),
    "Pyramid 91": lambda friction: scenes.pyramid(13, friction=friction),
    "Random 84": lambda friction: scenes.random_stack(84, friction=friction),
}
FRICTIONS = (0.0, 0.5)

Cases: TypeAlias = "Mapping[tuple[str, float | None], Scene]"
"""Scenes by name and friction; None for a scene with frictions of its own."""

LONG = 1.0
"""Seconds; a measurement that takes longer is not repeated."""


@dataclass(frozen=True, slots=True)
class Measurement:
    """One method on the stability tests of one search."""

    structure: str
    friction: float | None
    method: str
    test: str
    reuse: bool
    tests: int
    pivots: int
    """Of "block" rows moved, of "LP" simplex iterations."""
    seconds: float
    """All tests, the least of the repetitions."""
    unanswered: int
    """Tests that ended with any other status than solved; of "LP", without an answer by the primal
    simplex method."""
    wrong: int
    """Verdicts unlike those of HiGHS from scratch, whose search is followed."""

    @property
    def failures(self) -> int:
        """Tests without the right answer."""
        return self.unanswered + self.wrong


def paper_scenes() -> Cases:
    """The structures of Table I without and with friction."""
    return {
        (name, friction): build(friction)
        for friction in FRICTIONS
        for name, build in STRUCTURES.items()
    }


def measure_methods(
    cases: Cases,
    repeats: int = 5,
    announce: Callable[[str], None] = lambda what: None,
) -> list[Measurement]:
    """Record the search on every scene and put its tests to every method.

    `announce` is told what comes next.
    """
    found = []
    for (name, friction), scene in cases.items():
        label = _label(name, friction)
        announce(f"{label} (recording)")
        program = statics.Equilibrium.of(scene)
        recording = _core.Recording(scene._core, statics.ColdProgram(program))
        for method, pair in METHODS.items():
            for test, reuse in zip(pair, (False, True), strict=True):
                if test is not None:
                    announce(f"{label} ({test})")
                    replay, rescued = _least(recording, test, program, repeats)
                    found.append(
                        Measurement(
                            name,
                            friction,
                            method,
                            test,
                            reuse,
                            replay.tests,
                            replay.pivots,
                            replay.seconds,
                            replay.unanswered + rescued,
                            replay.wrong,
                        )
                    )
    return found


def _least(
    recording: _core.Recording, test: str, program: statics.Equilibrium, repeats: int
) -> tuple[_core.Replay, int]:
    """The fastest of the repetitions, and in how many tests HiGHS had to be rescued."""
    replays = []
    rescued = 0
    for _ in range(repeats):
        if test in ("lp", "lp-warm"):
            rival = (statics.ColdProgram if test == "lp" else statics.WarmProgram)(program)
            replays.append(recording.replay(rival))
            rescued = rival.rescued
        else:
            replays.append(recording.replay(test))
        if replays[-1].seconds > LONG:
            break
    return min(replays, key=lambda replay: replay.seconds), rescued


def methods_table(found: Sequence[Measurement]) -> Table:
    """Without and with reuse side by side, a section for each structure."""
    from rich.text import Text

    title = "Stability tests of one search by other methods, without and with reuse"
    table = plain_table(title, padding=(0, 1, 0, 0))
    table.caption = (
        "failures: tests not solved, or with a verdict unlike that of the linear program"
    )
    table.add_column("method", overflow="fold")
    for heading in ("pivots", "reuse", "fewer", "ms", "reuse", "faster", "fail"):
        table.add_column(heading, justify="right", no_wrap=True)
    for label, rows in _by_structure(found).items():
        table.add_row(Text(shown(label), style="bold"))
        for place, (method, pair) in enumerate(rows.items()):
            table.add_row(f"  {method}", *_cells(pair), end_section=place + 1 == len(rows))
    return table


def _label(name: str, friction: float | None) -> str:
    return name if friction is None else f"{name}, friction {friction:g}"


def _by_structure(found: Iterable[Measurement]) -> dict[str, dict[str, dict[bool, Measurement]]]:
    grouped: dict[str, dict[str, dict[bool, Measurement]]] = {}
    for one in found:
        label = _label(one.structure, one.friction)
        grouped.setdefault(label, {}).setdefault(one.method, {})[one.reuse] = one
    return grouped


def _cells(pair: Mapping[bool, Measurement]) -> list[str]:
    cold, warm = pair.get(False), pair[True]
    failures = "/".join(str(one.failures) for one in (cold, warm) if one is not None)
    return [
        "" if cold is None else str(cold.pivots),
        str(warm.pivots),
        "" if cold is None else f"{cold.pivots / max(warm.pivots, 1):.1f}",
        "" if cold is None else _milliseconds(cold),
        _milliseconds(warm),
        "" if cold is None else f"{cold.seconds / max(warm.seconds, 1e-9):.1f}",
        failures,
    ]


def _milliseconds(one: Measurement) -> str:
    """Two digits, more only where there are."""
    milliseconds = 1e3 * one.seconds
    return f"{milliseconds:.0f}" if milliseconds >= 10 else f"{milliseconds:.2g}"


def methods_as_dicts(found: Iterable[Measurement]) -> list[dict[str, Any]]:
    """In types that JSON knows, `failures` included."""
    return [{**asdict(one), "failures": one.failures} for one in found]


def write_methods_csv(found: Iterable[Measurement], folder: Path) -> Path:
    """One line a structure, method and start."""
    path = folder / "methods.csv"
    rows = methods_as_dicts(found)
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows({**row, "seconds": f"{row['seconds']:.6f}"} for row in rows)
    return path
