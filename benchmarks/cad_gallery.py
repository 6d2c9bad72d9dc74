"""Draw the assemblies of `cad_assemblies.py` taken apart, and write docs/guide/gallery-cad.md.

    python benchmarks/cad_gallery.py [NAME ...]

Without names all are drawn and the page is written; with names only these are drawn. Each picture
shows the parts moved along their ways out, the first to leave the farthest, in the colours of the
order.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_hex

import drystone as ds
from cad_assemblies import ASSEMBLIES, Assembly, Solid, scene_of
from drystone import pictures
from drystone.pictures import style
from drystone.pictures.axonometry import View
from drystone.pictures.canvas import fitted
from drystone.pictures.solids import Drawing, draw_solids

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DOCS = Path(__file__).resolve().parents[1] / "docs"
PICTURES = DOCS / "pictures" / "cad"
PAGE = DOCS / "guide" / "gallery-cad.md"

APART = 0.25
"""Of the diagonal of all parts: how far a part is drawn beyond its way to freedom, for each part
that leaves before it."""

NONE = 1e-3
"""A way to freedom shorter than this, mm, is none: nothing is in front of the part."""

HEAD = """# A gallery of CAD assemblies

Small assemblies that are known to come apart in one way, or not at all. Each is planned with
`clear_path=True`, and what is said below it is what the plan says: the parts in the order in which
they leave, each with its directions and how far it is to freedom. The parts are made in
`benchmarks/cad_assemblies.py`, the pictures and this page by `benchmarks/cad_gallery.py`;
`tests/python/test_cad_assemblies.py` holds each to its order and its ways.

Parts are drawn moved along their ways out, in the colours of the order: yellow leaves first.
"""


def moved_apart(assembly: Assembly, plan: ds.Plan) -> dict[str, Solid]:
    """The parts where they are drawn: along their ways, and beyond."""
    corners = np.array([solid.bounding_box() for solid in assembly.parts.values()])
    diagonal = float(np.linalg.norm(corners[:, 3:].max(axis=0) - corners[:, :3].min(axis=0)))
    parts, count = dict(assembly.parts), len(plan.order)
    group_of = {name: group for group in plan.groups for name in group}
    for step, name in enumerate(plan.order):
        moves = plan.moves[step]
        last = count - plan.order.index(group_of.get(name, (name,))[0])
        way = sum(1000 * move.length * np.array(move.direction) for move in moves)
        way = way + APART * diagonal * last / count * np.array(moves[-1].direction)
        parts[name] = parts[name].translate(tuple(way))
    return parts


def way_of(move: ds.Move) -> str:
    """A direction, and how far it is to freedom."""
    length = 1000 * move.length
    far = f"{length:.3g} mm" if length > NONE else "free at once"
    direction = ", ".join(f"{x:.2g}" for x in np.round(move.direction, 6) + 0.0)
    return f"{far} along ({direction})"


def told(assembly: Assembly, plan: ds.Plan) -> str:
    """What the plan says, in a line or two."""
    if not plan.found:
        stuck = "; ".join(f"{one.name} by {', '.join(one.by)}" for one in plan.blocked)
        return f"`{plan.status}`: in the way of {stuck}."
    grouped = [name for group in plan.groups for name in group]
    steps, shown = [], set()
    for name, moves in zip(plan.order, plan.moves, strict=True):
        group = next((group for group in plan.groups if name in group), (name,))
        if group in shown:
            continue
        shown.add(group)
        ways = ", then ".join(way_of(move) for move in moves)
        steps.append(f"`{'` with `'.join(group)}` {ways}")
    text = f"{'In this order' if len(steps) > 1 else 'Out goes'}: {'; '.join(steps)}."
    options = [f"`{key}={value}`" for key, value in assembly.options.items()]
    if assembly.obstacles:
        options.append("`obstacles=`")
    if options:
        text += f" With {' and '.join(options)}"
        text += f"; without, the plan says `{assembly.without}`." if assembly.without else "."
    if grouped and not options:
        text += f" Together: {', '.join(grouped)}."
    return text


def picture(assembly: Assembly, plan: ds.Plan) -> Figure:
    """The parts apart, those that stay in grey."""
    scene = scene_of(moved_apart(assembly, plan), (), surface=True)  # fixed ones would be cut off
    drawing = Drawing.of(scene.bodies, View.of(scene.bodies, scene.gravity))
    canvas = fitted(drawing.outlines, assembly.title, "")
    colours, last = colormaps[style.ORDER_MAP], max(len(plan.order) - 1, 1)
    fills = dict.fromkeys(assembly.parts, style.STONE)
    fills |= {name: to_hex(colours(1 - k / last)) for k, name in enumerate(plan.order)}
    draw_solids(
        canvas, drawing, fills, labels={name: str(k + 1) for k, name in enumerate(plan.order)}
    )
    return canvas.figure


def draw(name: str) -> str:
    """Draw one, and return its part of the page."""
    assembly = ASSEMBLIES[name]()
    plan = assembly.plan()
    PICTURES.mkdir(parents=True, exist_ok=True)
    pictures.save(picture(assembly, plan), PICTURES / f"{name}.svg")
    return (
        f"\n## {assembly.title}\n\n{told(assembly, plan)}\n\n"
        f"![{assembly.title}, apart](../pictures/cad/{name}.svg)\n"
    )


def main() -> None:
    """Draw all, or some."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("names", nargs="*", help="assemblies to draw, by default all")
    names = parser.parse_args().names
    parts = []
    for name in names or ASSEMBLIES:
        parts.append(draw(name))
        print(name, flush=True)
    if not names:
        PAGE.write_text(HEAD + "".join(parts))


if __name__ == "__main__":
    main()
