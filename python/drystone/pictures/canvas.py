"""A figure fitted to a scene: equal scales, no axes, room for a title, a key and a colour bar."""

from __future__ import annotations

import io
import textwrap
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, cast

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.common.drawn import DPI
from drystone.common.files import PICTURES, ending_of, write_whole
from drystone.common.numbers import number
from drystone.pictures import style
from drystone.pictures.fonts import fonts_for_names

if TYPE_CHECKING:
    from numpy.typing import NDArray

LONGEST_SIDE = 8.0
"""Inches of the drawing's longer side."""
LEAST_WIDTH = 3.4
"""Inches, so that a title fits above a slender column."""
FIXED_REACH = 0.12
"""How far beyond the movable bodies a fixed one may widen the view, in the view's own size."""
SETTINGS: dict[Any, Any] = {
    "svg.hashsalt": "drystone",
    "svg.fonttype": "none",
    "hatch.linewidth": 0.6,
}
"""Same input, same file: no random identifiers. Text stays text."""


LEAST_DPI, MOST_DPI = 10, 2400
"""Below, letters have no pixel and matplotlib ends the process; above, a picture fills memory."""

UNSAID: dict[str, dict[str, None]] = {
    "svg": {"Date": None},
    "pdf": {"CreationDate": None},
    "png": {"Software": None},
}
"""What files do not say of when and by what they were made."""

_GIVEN: ContextVar[Axes | None] = ContextVar("axes to draw in", default=None)


class Outlined(Protocol):
    """What is drawn of a body: one of the plane, or what is seen of one in space."""

    @property
    def name(self) -> str: ...
    @property
    def fixed(self) -> bool: ...
    @property
    def centroid(self) -> tuple[float, float]: ...
    @property
    def vertices(self) -> NDArray[np.float64]:
        """(n, 2), metres on the picture."""


@dataclass(frozen=True, slots=True)
class Canvas:
    """A figure, its drawing area, and the scale between metres and points."""

    figure: Figure
    axes: Axes
    points_per_metre: float
    box: tuple[float, float, float, float]
    """(left, bottom, right, top) of the view in metres."""
    on_given_axes: bool = False
    """Whether the figure is somebody else's: see `drawing_on`."""

    @property
    def diagonal(self) -> float:
        """Metres across the view."""
        left, bottom, right, top = self.box
        return float(np.hypot(right - left, top - bottom))


def fitted(
    bodies: Sequence[Outlined],
    title: str,
    note: str = "",
    *,
    key: bool = False,
    colour_bar: bool = False,
) -> Canvas:
    """An empty canvas for these bodies, with a title above and a note below.

    `key` leaves room for a row of arrows under the drawing, `colour_bar` for one on its right.
    """
    box = _view(bodies)
    given = _GIVEN.get()
    if given is not None:
        return _within(given, box, title, note, key)
    width, height = box[2] - box[0], box[3] - box[1]
    scale = LONGEST_SIDE / max(width, height)
    drawn_width, drawn_height = width * scale, height * scale
    side = 0.95 if colour_bar else 0.15
    total_width = max(drawn_width + 0.15 + side, LEAST_WIDTH)
    title_lines = _wrapped(title, total_width, 11)
    note_lines = _wrapped(note, total_width, 8)
    top = 0.18 + 0.2 * len(title_lines)
    bottom = (0.4 if key else 0.15) + 0.16 * len(note_lines)
    total_height = drawn_height + top + bottom
    figure = Figure(figsize=(total_width, total_height), facecolor="white")
    left = (total_width - side + 0.15 - drawn_width) / 2
    axes = figure.add_axes(
        (
            left / total_width,
            bottom / total_height,
            drawn_width / total_width,
            drawn_height / total_height,
        )
    )
    axes.set_xlim(box[0], box[2])
    axes.set_ylim(box[1], box[3])
    axes.set_axis_off()
    figure.text(
        0.15 / total_width,
        1 - 0.1 / total_height,
        "\n".join(title_lines),
        size=11,
        weight="bold",
        color=style.INK,
        va="top",
        parse_math=False,
    )
    figure.text(
        0.15 / total_width,
        0.08 / total_height,
        "\n".join(note_lines),
        size=8,
        color=style.FAINT,
        va="bottom",
        parse_math=False,
    )
    return Canvas(figure, axes, 72 * scale, box)


@contextmanager
def drawing_on(axes: Axes) -> Iterator[None]:
    """Within it `fitted` makes no figure of its own but takes these axes."""
    token = _GIVEN.set(axes)
    try:
        yield
    finally:
        _GIVEN.reset(token)


def _within(
    axes: Axes, box: tuple[float, float, float, float], title: str, note: str, key: bool
) -> Canvas:
    """A canvas on somebody's axes: title above, note below, sizes of lines as the axes are now."""
    figure = cast("Figure", axes.get_figure(root=True))
    extent = axes.get_window_extent()
    points = 72 / figure.dpi
    width, height = box[2] - box[0], box[3] - box[1]
    scale = points * min(extent.width / width, extent.height / height)
    axes.set_xlim(box[0], box[2])
    axes.set_ylim(box[1], box[3])
    axes.set_aspect("equal", adjustable="box")
    axes.set_axis_off()
    inches = extent.width / figure.dpi
    axes.set_title(
        "\n".join(_wrapped(title, inches, 11)),
        loc="left",
        size=11,
        weight="bold",
        color=style.INK,
        parse_math=False,
    )
    axes.annotate(
        "\n".join(_wrapped(note, inches, 8)),
        (0, 0),
        xycoords="axes fraction",
        xytext=(0, -26 if key else -4),
        textcoords="offset points",
        size=8,
        color=style.FAINT,
        va="top",
        parse_math=False,
    )
    return Canvas(figure, axes, scale, box, on_given_axes=True)


def save(figure: Figure, path: str | PathLike[str], dpi: float = DPI) -> None:
    """Write the figure whole or not at all; ValueError unless the name ends as a picture's."""
    data = rendered(figure, ending_of(path, PICTURES)[1:], dpi)
    write_whole(Path(path), data)


def svg(figure: Figure) -> str:
    """The figure as the text of an SVG image."""
    return rendered(figure, "svg").decode()


def rendered(figure: Figure, kind: str, dpi: float = DPI) -> bytes:
    """The figure as a file of some kind: the same figure, the same bytes."""
    dots = number(dpi, "dpi")
    if not LEAST_DPI <= dots <= MOST_DPI:
        raise ValueError(f"dpi is {dots:g}: it must be from {LEAST_DPI} to {MOST_DPI}")
    out = io.BytesIO()
    with mpl.rc_context(SETTINGS), fonts_for_names(figure, text=kind == "svg"):
        figure.savefig(out, format=kind, dpi=dots, metadata=UNSAID[kind])
    return out.getvalue()


def _view(bodies: Sequence[Outlined]) -> tuple[float, float, float, float]:
    """The movable bodies and as much of the fixed ones as `FIXED_REACH` lets in, with a margin."""
    movable = [body.vertices for body in bodies if not body.fixed]
    every = [body.vertices for body in bodies] or [np.array([[0.0, 0.0], [1.0, 1.0]])]
    low, high = bounds(movable or every)
    if movable:
        reach = FIXED_REACH * np.max(high - low)
        all_low, all_high = bounds(every)
        low, high = np.maximum(all_low, low - reach), np.minimum(all_high, high + reach)
    margin = 0.03 * np.max(high - low)
    left, bottom = low - margin
    right, top = high + margin
    return float(left), float(bottom), float(right), float(top)


def bounds(
    polygons: Sequence[NDArray[np.float64]],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The lower left and the upper right corner around some polygons."""
    corners = np.concatenate(polygons)
    return corners.min(axis=0), corners.max(axis=0)


def _wrapped(text: str, inches: float, size: float) -> list[str]:
    """Lines of `text` that fit into a width; a character is about 0.57 of its size wide."""
    characters = max(int(72 * (inches - 0.3) / (0.57 * size)), 12)
    return [line for part in text.splitlines() for line in textwrap.wrap(part, characters)]
