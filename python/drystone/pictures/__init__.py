"""Pictures of scenes, verdicts, plans and frames of recordings, as matplotlib figures.

Figures are built without pyplot: no global state, no window, any thread. `save` writes SVG, PDF
or PNG, `svg` gives the text of an SVG.
"""

from drystone.common.extras import extra

with extra("pictures", "pictures"):
    from drystone.pictures.canvas import save, svg
    from drystone.pictures.figures import plan_figure, scene_figure, verdict_figure
    from drystone.pictures.film import save_film
    from drystone.pictures.graph import graph_figure
    from drystone.pictures.limits import escape_figure, limit_figure, margin_figure
    from drystone.pictures.pictured import draw_on, figure_of
    from drystone.pictures.recording import frame_figure, frames_box

__all__ = [
    "draw_on",
    "escape_figure",
    "figure_of",
    "frame_figure",
    "frames_box",
    "graph_figure",
    "limit_figure",
    "margin_figure",
    "plan_figure",
    "save",
    "save_film",
    "scene_figure",
    "svg",
    "verdict_figure",
]
