"""What a scene or an answer does by the means of a later room: draw itself, make a page of itself.

Code goes one way, as the data does: who draws, tabulates and imports knows scenes and answers, and
these know none of them. So a method such as `Verdict.draw` calls a function of this file, and
`drystone/__init__.py`, which knows all rooms, says who does the work.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

from drystone.common.extras import MissingExtraError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Made = TypeVar("Made")


class Later(Generic[Made]):
    """A function that is found when it is first called."""

    __slots__ = ("_find",)

    _find: Callable[[], Callable[..., Made]]

    def done_by(self, find: Callable[[], Callable[..., Made]]) -> None:
        """Say who does it: `find` imports and returns the function."""
        self._find = find

    def __call__(self, *given: Any, **options: Any) -> Made:
        return self._find()(*given, **options)


class Page(Protocol):
    """A page to look at: a `drystone.viewer.Page`, which says more."""

    def html(self) -> str:
        """The text of the page."""

    def save(self, path: str | PathLike[str]) -> None:
        """Write the page; the name ends in .html."""

    def save_frames(
        self,
        folder: str | PathLike[str],
        frames: Iterable[int] | None = None,
        suffix: str = ".png",
    ) -> list[Path]:
        """Draw frames (all by default) as pictures; return their paths."""

    def show(self) -> None:
        """Show the page: in a notebook, or from a script in the browser."""


figure: Later[Figure] = Later()
"""The picture of a scene or an answer."""

save_figure: Later[None] = Later()
"""Writes a figure into a file, given its path and dots per inch."""

draw_on: Later[None] = Later()
"""Draws the picture of a scene or an answer in given axes."""

show: Later[None] = Later()
"""Shows a scene, an answer or a page, in a notebook or in the browser."""

film: Later[None] = Later()
"""Writes the frames of a plan or a run as a film, given its path and dots per inch."""

svg_of: Later[str] = Later()
"""The text of a figure as an SVG image."""


def svg_if_possible(thing: object) -> str | None:
    """The picture of a scene or an answer for a notebook, which shows its text if there is none."""
    try:
        return svg_of(figure(thing))
    except MissingExtraError:
        return None


page: Later[Page] = Later()
"""The page of a scene, an answer, a plan or a run."""

table: Later[str] = Later()
"""The table of an answer as text, with at most a given number of rows."""

imported: Later[Any] = Later()
"""Reads a file of another tool, with the options of `drystone.imports.load`: an `Imported`."""

advice: Later[str | None] = Later()
"""What to do with a file of another tool that was given as a scene, by its path."""

lies: Later[bool] = Later()
"""Whether the name of a file says that it is something else than a scene."""
