"""What scenes and answers can do alike: be drawn, saved by the ending of a name, and shown."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING, TextIO

from drystone.common import later
from drystone.common.files import JSON, PAGE, PICTURES, ending_of
from drystone.common.json_text import save_json

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from drystone.common.later import Page

DPI = 160.0
"""Dots per inch of a .png without a choice."""


class Drawn:
    """What has a picture. Notebooks show it by themselves."""

    __slots__ = ()

    def draw(
        self, path: str | PathLike[str] | None = None, *, ax: Axes | None = None, dpi: float = DPI
    ) -> None:
        """Write the picture, or draw it in a figure of your own.

        The name of the file ends in .svg, .pdf or .png; `dpi` is the resolution of a .png, dots per
        inch. With `ax`, axes of matplotlib, it is drawn in these, without a colour bar.

        Raises ValueError for another ending, and TypeError unless one of `path` and `ax` is given.
        """
        _require_one(path, ax)
        if ax is not None:
            later.draw_on(self, ax)
        elif path is not None:
            ending_of(path, PICTURES)
            later.save_figure(later.figure(self), path, dpi)

    def show(self) -> None:
        """Show it: below the cell of a notebook, from a script in a window of the browser."""
        later.show(self)

    def _repr_svg_(self) -> str | None:
        return later.svg_if_possible(self)


class Paged(Drawn):
    """What has a page too, to step through or to turn and look into."""

    __slots__ = ()

    def draw(
        self, path: str | PathLike[str] | None = None, *, ax: Axes | None = None, dpi: float = DPI
    ) -> None:
        """Write a picture as `Drawn.draw` does, or a page if the name ends in .html."""
        _require_one(path, ax)
        if path is not None and ending_of(path, (*PICTURES, PAGE)) == PAGE:
            self.view().save(path)
        else:
            super().draw(path, ax=ax, dpi=dpi)

    def view(self) -> Page:
        """The page: save it, show it, or let a notebook show it."""
        return later.page(self)


class Answer(Paged):
    """What can be written as JSON besides."""

    __slots__ = ()

    def write_json(self, file: TextIO) -> None:
        """Write it to an open file."""
        raise NotImplementedError

    def save(self, path: str | PathLike[str], *, dpi: float = DPI) -> None:
        """Write what `write_json` does (.json), the picture (.svg, .pdf, .png), or a page that
        plays what moves (.html)."""
        if ending_of(path, (JSON, *PICTURES, PAGE)) == JSON:
            save_json(self, path)
        else:
            self.draw(path, dpi=dpi)


def _require_one(path: object, ax: object) -> None:
    """TypeError unless a name or axes are given."""
    if (path is None) == (ax is None):
        raise TypeError("draw wants a file's name, or ax=: one of the two")
    if hasattr(path, "set_xlim"):
        raise TypeError("draw wants axes by name: draw(ax=axes)")
    if ax is not None and not hasattr(ax, "set_xlim"):
        raise TypeError(f"ax must be axes of matplotlib, not a {type(ax).__name__}")
