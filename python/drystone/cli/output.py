"""What commands print: text as it is, whatever names are in it, and tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from drystone.common.text import shown
from drystone.report.tables import WIDE

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


def names(every: Sequence[str]) -> str:
    """Names in a row; in quotes where one could be taken for several."""
    return " ".join(_quoted(shown(name)) for name in every)


def _quoted(name: str) -> str:
    return f'"{name}"' if not name or " " in name else name
