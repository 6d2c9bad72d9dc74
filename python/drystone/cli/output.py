"""What commands print: text as it is, whatever names are in it, and tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from drystone.common.text import shown
from drystone.report.tables import IN_JSON, WIDE

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table


def console(stderr: bool = False) -> Console:
    """For text without markup: a name may look like some."""
    from rich.console import Console

    plain: dict[str, Any] = {"markup": False, "emoji": False, "highlight": False}
    made = Console(stderr=stderr, **plain)
    return made if made.is_terminal else Console(stderr=stderr, width=WIDE, **plain)


def facts() -> Table:
    """An empty list of what and how much."""
    from rich.table import Table

    made = Table.grid(padding=(0, 2))
    made.add_column(no_wrap=True)
    made.add_column(overflow="fold")
    return made


MOST_IN_A_ROW = 200
"""Words that are printed one after the other: two screens or so."""


def names(every: Sequence[str]) -> str:
    """The first names in a row; in quotes where one could be taken for several."""
    return in_a_row([_quoted(shown(name)) for name in every[:MOST_IN_A_ROW]], len(every))


def in_a_row(words: Sequence[str], count: int, between: str = " ") -> str:
    """The first of so many words, and how many more there are."""
    row = between.join(words[:MOST_IN_A_ROW])
    more = count - MOST_IN_A_ROW
    return row if more <= 0 else f"{row}{between}... {more} more; {IN_JSON}"


def _quoted(name: str) -> str:
    return f'"{name}"' if not name or " " in name else name
