"""Measurements of simulators: kept in a file as they come, shown as a table in the end."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from rich.console import Console
from rich.table import Table

import results
from simulators import Simulator

WIDTH = 110
"""Characters at least: a table of seven columns."""


def ready(simulators: Iterable[Simulator]) -> list[Simulator]:
    """Those that are installed, built where they have to be."""
    found = [simulator for simulator in simulators if not simulator.missing()]
    for simulator in found:
        simulator.prepare()
    return found


class KeptTable:
    """Lines of a file, some of whose columns are shown."""

    def __init__(self, folder: Path, ending: str, columns: tuple[str, ...], shown: dict[str, str]):
        """A file of this run in a folder; `shown` are columns of it with their titles."""
        base = results.path_in(folder)
        self.path = base.with_name(f"{base.name}-{ending}.csv")
        self.columns = columns
        self.shown = shown
        self.lines: list[dict[str, object]] = []

    def add(self, lines: Iterable[dict[str, object]]) -> None:
        """More lines; the file has them at once."""
        self.lines.extend(lines)
        results.write_lines(self.path, self.columns, self.lines)

    def show(self, asked: Iterable[Simulator], notes: Iterable[str] = ()) -> None:
        """The table, what else there is to say, who of those asked is missing, and where the file
        is."""
        table = Table(*self.shown.values())
        for line in self.lines:
            table.add_row(*(str(line[column]) for column in self.shown))
        console = Console()
        console.width = max(console.width, WIDTH)
        console.print(table)
        for note in notes:
            console.print(note)
        for simulator in asked:
            if missing := simulator.missing():
                console.print(f"{simulator.name}: {missing}")
        console.print(f"wrote {self.path}", soft_wrap=True)
