"""The look of the tables: lines under the headings only, so that they fit into 80 columns."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.table import Table


def plain_table(title: str, padding: tuple[int, int, int, int] = (0, 0, 0, 1)) -> Table:
    """A table without columns yet; `padding` is that of a cell: top, right, bottom, left."""
    from rich import box
    from rich.table import Table

    return Table(
        title=title,
        title_justify="left",
        title_style="bold",
        caption_justify="left",
        box=box.SIMPLE_HEAD,
        padding=padding,
        pad_edge=False,
        show_edge=False,
    )
