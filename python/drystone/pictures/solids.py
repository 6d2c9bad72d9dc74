"""Solids on a canvas: shaded faces from far to near, and labels where they are seen."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.collections import PathCollection, PolyCollection
from matplotlib.path import Path
from numpy.typing import NDArray

from drystone.pictures import style
from drystone.pictures.axonometry import (
    Piece,
    Points,
    Shadow,
    View,
    box_of,
    far_to_near,
    pieces_of,
    shadows,
)
from drystone.pictures.canvas import Canvas
from drystone.pictures.seams import edges_seen
from drystone.pictures.shapes import draw_absent, draw_labels, line_width
from drystone.scene import Solid

Stroke = tuple[Path, "tuple[float, ...] | str", "tuple[float, ...] | str"]
"""An outline or a line, what fills it, and its colour."""


@dataclass(frozen=True, slots=True)
class Drawing:
    """Bodies, how they are looked at, and their outlines on the picture."""

    bodies: Sequence[Solid]
    view: View
    pieces: Sequence[Piece]
    outlines: Sequence[Shadow]

    @classmethod
    def of(
        cls, bodies: Sequence[Solid], view: View, box: tuple[Points, Points] | None = None
    ) -> Drawing:
        """Of fixed bodies only what is near `box`, by default the box around the movable ones."""
        pieces = pieces_of(bodies, box or box_of(bodies))
        return cls(bodies, view, pieces, shadows(bodies, pieces, view))


def draw_solids(
    canvas: Canvas,
    drawing: Drawing,
    fills: Mapping[str, str],
    edges: Mapping[str, str] | None = None,
    labels: Mapping[str, str] | None = None,
    *,
    ghosts: bool = True,
) -> None:
    """The fixed bodies and those that `fills` names, in its colours, with `labels` in front.

    Bodies that are neither leave a dotted outline if there are `ghosts`. `edges` are other colours
    than ink.
    """
    bodies, view = drawing.bodies, drawing.view
    if ghosts:
        draw_absent(canvas, [o for o in drawing.outlines if not o.fixed and o.name not in fills])
    shown = [p for p in drawing.pieces if bodies[p.body].fixed or bodies[p.body].name in fills]
    ordered = far_to_near(shown, view)
    strokes: list[Stroke] = []
    for piece in ordered:
        body = bodies[piece.body]
        fill = style.GROUND if body.fixed else fills[body.name]
        line = style.HATCH if body.fixed else (edges or {}).get(body.name, style.INK)
        strokes.extend(_strokes(drawing, piece, fill, line))
    movable = [outline for outline in drawing.outlines if not outline.fixed]
    paths, faces, lines = zip(*strokes, strict=True) if strokes else ((), (), ())
    canvas.axes.add_collection(
        PathCollection(
            paths,
            facecolors=faces,
            edgecolors=lines,
            linewidths=line_width(canvas, movable),
            joinstyle="round",
            capstyle="round",
        ),
        autolim=False,
    )
    _draw_names(canvas, drawing, ordered, fills, labels or {})


def _strokes(drawing: Drawing, piece: Piece, fill: str, line: str) -> Iterator[Stroke]:
    """The faces of a piece that are seen, and on a body of several pieces the edges it has."""
    view = drawing.view
    if piece.sharp is not None:
        yield from _patch_strokes(drawing, piece, piece.sharp, fill, line)
        return
    others = [one for one in drawing.pieces if one.body == piece.body and one is not piece]
    for face in piece.visible(view):
        corners = piece.flat_face(face, view)
        outline = Path(np.concatenate([corners, corners[:1]]), closed=True)
        shade = view.shaded(fill, piece.normals[face])
        yield outline, shade, shade if others else line
        for ends in edges_seen(piece, face, others) if others else ():
            yield Path(view.flat(ends)), "none", line


def _patch_strokes(
    drawing: Drawing, piece: Piece, sharp: NDArray[np.bool_], fill: str, line: str
) -> Iterator[Stroke]:
    """The triangles of a patch that are seen, from far to near, and the edges between them."""
    view = drawing.view
    middle = {k: piece.corners[list(piece.faces[k])].mean(axis=0) for k in piece.visible(view)}
    depths = {k: float(at @ view.axes[2]) for k, at in middle.items()}
    for face in sorted(depths, key=depths.__getitem__):
        corners = piece.flat_face(face, view)
        shade = view.shaded(fill, piece.normals[face])
        yield Path(np.concatenate([corners, corners[:1]]), closed=True), shade, shade
        for side in np.flatnonzero(sharp[face]).tolist():
            yield Path(corners[[side, (side + 1) % 3]]), "none", line


def draw_dashed(canvas: Canvas, outlines: Sequence[Points]) -> None:
    """Where falling blocks are going, as outlines on the picture."""
    canvas.axes.add_collection(
        PolyCollection(
            outlines,
            facecolors="none",
            edgecolors=style.FALL,
            linestyles="dashed",
            linewidths=0.8,
        ),
        autolim=False,
    )


def _draw_names(
    canvas: Canvas,
    drawing: Drawing,
    ordered: Sequence[Piece],
    fills: Mapping[str, str],
    labels: Mapping[str, str],
) -> None:
    """Each on the largest face of its body that nothing nearer covers in the middle."""
    view = drawing.view
    faces = [
        (piece.body, piece.flat_face(face, view))
        for piece in ordered
        for face in piece.visible(view)
    ]
    best: dict[int, Points] = {}
    low = np.array([corners.min(axis=0) for _, corners in faces]).reshape(-1, 2)
    high = np.array([corners.max(axis=0) for _, corners in faces]).reshape(-1, 2)
    for k, (body, corners) in enumerate(faces):
        if drawing.bodies[body].name not in labels:
            continue
        middle = corners.mean(axis=0)
        near = np.flatnonzero(np.all((low < middle) & (middle < high), axis=1))
        if any(Path(faces[i][1]).contains_point(_middle(corners)) for i in near.tolist() if i > k):
            continue
        if body not in best or _area(corners) > _area(best[body]):
            best[body] = corners
    seen = [
        Shadow(drawing.bodies[b].name, False, _middle(corners), corners)
        for b, corners in best.items()
    ]
    draw_labels(canvas, seen, labels, fills)


def _area(corners: Points) -> float:
    x, y = corners.T
    return 0.5 * abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))


def _middle(corners: Points) -> tuple[float, float]:
    x, y = corners.mean(axis=0)
    return float(x), float(y)
