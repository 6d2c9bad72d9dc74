"""What commands print: text as it is, whatever names are in it, and tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from drystone.text import shown

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

MOST_ROWS = 40
"""Longer tables are cut, with a line that says so; --json has everything."""

WIDE = 1_000_000
"""Columns of what is no terminal: a program that reads lines wants them whole."""


def console(stderr: bool = False) -> Console:
    """For text without markup: a name may look like some."""
    from rich.console import Console

    plain: dict[str, Any] = {"markup": False, "emoji": False, "highlight": False}
    made = Console(stderr=stderr, **plain)
    return made if made.is_terminal else Console(stderr=stderr, width=WIDE, **plain)


def table(first: str, *others: str, left: Sequence[str] = ()) -> Table:
    """An empty table: names in the first column, numbers in the others but those in `left`."""
    from rich import box
    from rich.table import Table

    made = Table(box=box.SIMPLE_HEAD)
    made.add_column(first, overflow="fold")
    for title in others:
        made.add_column(title, justify="left" if title in left else "right", overflow="fold")
    return made


def facts() -> Table:
    """An empty list of what and how much."""
    from rich.table import Table

    made = Table.grid(padding=(0, 2))
    made.add_column(no_wrap=True)
    made.add_column(overflow="fold")
    return made


def cut(made: Table, rows: int) -> Table:
    """Says so if the table has fewer than all its rows."""
    if rows > MOST_ROWS:
        made.caption = f"the first {MOST_ROWS} of {rows}; --json lists all"
    return made


def names(every: Sequence[str]) -> str:
    """Names in a row; in quotes where one could be taken for several."""
    return " ".join(_quoted(shown(name)) for name in every)


def _quoted(name: str) -> str:
    return f'"{name}"' if not name or " " in name else name
