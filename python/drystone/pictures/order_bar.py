"""The colour bar of an order of removal."""

from __future__ import annotations

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from drystone.pictures import style
from drystone.pictures.canvas import Canvas


def draw_order_bar(canvas: Canvas, count: int) -> None:
    """The colour bar: first removed at the top, as the blocks usually are. None on axes that were
    given: the rest of that figure is not ours."""
    if canvas.on_given_axes:
        return
    frame = canvas.axes.get_position()
    width = canvas.figure.get_figwidth()
    bar = canvas.figure.add_axes((1 - 0.78 / width, frame.y0, 0.14 / width, frame.height))
    colours = ScalarMappable(Normalize(-max(count, 2), -1), colormaps[style.ORDER_MAP])
    ticks = sorted({1, count, *np.linspace(1, count, 5).round().astype(int).tolist()})
    drawn = canvas.figure.colorbar(colours, cax=bar, ticks=[-tick for tick in ticks])
    drawn.ax.set_yticklabels([str(tick) for tick in ticks], size=8, color=style.INK)
    drawn.ax.tick_params(length=2, color=style.FAINT)
    drawn.outline.set_visible(False)
    bar.set_title("removed", size=8, color=style.INK, loc="left", pad=8)
