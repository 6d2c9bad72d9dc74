"""Tables and plots of `benchmarks/results`, for the site: no number of the page is typed by hand.

Of each kind of file the newest is taken; the page names it.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib as mpl
from matplotlib.figure import Figure

from drystone.pictures import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

RESULTS = Path(__file__).parent.parent / "benchmarks" / "results" / "x86_64-2core"
COLOURS = (style.FORCE, style.NEXT, style.STANDS, style.LOAD, style.FALL, style.FAINT)
MARKERS = "osD^vP"
Row = dict[str, str]


@cache
def newest(kind: str) -> Path:
    """The newest file whose name ends in `-kind.csv`."""
    found = sorted(RESULTS.glob(f"*-{kind}.csv"))
    if not found:
        raise FileNotFoundError(f"no results of {kind!r} in {RESULTS}")
    return found[-1]


@cache
def rows(kind: str) -> tuple[Row, ...]:
    """The lines of that file, by column."""
    with newest(kind).open(newline="") as file:
        return tuple(csv.DictReader(file))


def table(name: str) -> str:
    """One table of the page, as Markdown, with where its numbers are from."""
    kind, make = TABLES[name]
    head, lines = make(rows(kind))
    first = rows(kind)[0]
    source = newest(kind).name
    text = [_row(head), _row(["---"] * 1 + ["---:"] * (len(head) - 1))]
    text += [_row(line) for line in lines]
    link = f"../benchmarks/results/x86_64-2core/{source}"
    told = f"[{source}]({link}), {first['date']}, {first['cpu']}, two cores, one thread each."
    return "\n".join([*text, "", f"<small>{told}</small>"])


def plots() -> dict[str, str]:
    """Every plot of the page, as SVG, by name."""
    return {
        "sequences": _dots(
            [row for row in rows("add") if row["friction"] == "0.5"],
            lambda row: (row["scene"], row["peer"], 1e3 * float(row["seconds"] or "nan")),
            "milliseconds for all questions of a plan, friction 0.5",
        ),
        "steps": _dots(
            _at_240(rows("simulation")),
            lambda row: (row["scene"], row["simulator"], float(row["microseconds"] or "nan")),
            "microseconds a step of 1/240 s",
        ),
        "verdicts": _ratios(),
    }


def _sequences(every: Iterable[Row]) -> tuple[list[str], list[list[str]]]:
    """The time of all questions, and how many times longer each peer takes."""
    every = list(every)
    peers = list(dict.fromkeys(row["peer"] for row in every if row["peer"] != "drystone reuse"))
    cases = dict.fromkeys((row["scene"], row["friction"]) for row in every)
    lines = []
    for scene, friction in cases:
        own = {r["peer"]: r for r in every if (r["scene"], r["friction"]) == (scene, friction)}
        line = [scene, friction, f"{1e3 * float(own['drystone reuse']['seconds']):.3g} ms"]
        lines.append(line + [_times(own.get(peer), "ratio_to_reuse") for peer in peers])
    return ["scene", "friction", "drystone", *peers], lines


def _steps(every: Iterable[Row]) -> tuple[list[str], list[list[str]]]:
    """Time of a step, and how far a block that should stay still was from its place at most."""
    every = _at_240(every)
    names = list(dict.fromkeys(row["simulator"] for row in every))
    lines = []
    for scene in dict.fromkeys(row["scene"] for row in every):
        own = {row["simulator"]: row for row in every if row["scene"] == scene}
        times = [
            f"{float(own[name]['microseconds']):.3g}" if name in own else "-" for name in names
        ]
        drift = [_drift(own.get(name)) for name in names]
        lines.append([scene, *times, *drift])
    head = [f"{name}, µs" for name in names] + [f"{name}, drift" for name in names]
    return ["scene", *head], lines


def _verdicts(every: Iterable[Row]) -> tuple[list[str], list[list[str]]]:
    """Of each family the largest structure: time of `check`, and the peers' by it."""
    every = list(every)
    peers = [peer for peer in dict.fromkeys(r["solver"] for r in every) if "drystone" not in peer]
    lines = []
    for family in dict.fromkeys(row["family"] for row in every):
        some = [row for row in every if row["family"] == family]
        scene = max(some, key=lambda row: int(row["points"]))["scene"]
        own = {row["solver"]: row for row in some if row["scene"] == scene}
        if "drystone" in own:
            first = own["drystone"]
            line = [f"{family}, {scene}", first["points"], first["verdict"]]
            line.append(f"{1e3 * float(first['seconds']):.3g} ms")
            lines.append(line + [_times(own.get(peer), "ratio") for peer in peers])
    return ["structure", "contact points", "verdict", "drystone", *peers], lines


def _hard(every: Iterable[Row]) -> tuple[list[str], list[list[str]]]:
    """By simulator the time of a step, who falls, and how deep blocks are in one another."""
    every = list(every)
    names = list(dict.fromkeys(row["simulator"] for row in every))
    lines = []
    for scene in dict.fromkeys(row["scene"] for row in every):
        own = {row["simulator"]: row for row in every if row["scene"] == scene}
        first = next(iter(own.values()))
        line = [scene, first["blocks"], {"stand": "0", "fall": "all"}[first["should"]]]
        lines.append(line + [_of_hard(own[name]) for name in names])
    return ["scene", "blocks", "should fall", *names], lines


def _heaps(every: Iterable[Row]) -> tuple[list[str], list[list[str]]]:
    """At friction .5 by number of boxes: a step, the worst, those not exact; beside others."""
    every = [row for row in every if row["friction"] == "0.5"]
    peers = list(dict.fromkeys(row["simulator"] for row in every if row["ratio"]))
    lines = []
    for boxes in dict.fromkeys(row["blocks"] for row in every):
        own = {row["simulator"]: row for row in every if row["blocks"] == boxes}
        first = next(row for row in own.values() if not row["ratio"])
        step = float(format(float(first["microseconds"]), ".3g"))
        line = [boxes, f"{step:g} µs", f"{first['worst_ms']} ms"]
        line.append(f"{first['not_exact']} of {first['steps']}")
        lines.append(line + [_times(own.get(peer), "ratio") for peer in peers])
    head = [f"drystone / {peer}" for peer in peers]
    return ["boxes", "drystone, a step", "worst", "not exact", *head], lines


def _of_hard(row: Row) -> str:
    if not row["microseconds"]:
        return "-"
    step = float(format(float(row["microseconds"]), ".3g"))
    overlap = _millimetres(float(row["penetration"]))
    return f"{step:g} µs, {row['fallen']} fell, {overlap}"


TABLES: dict[str, tuple[str, Callable[[Iterable[Row]], tuple[list[str], list[list[str]]]]]] = {
    "sequences": ("add", _sequences),
    "steps": ("simulation", _steps),
    "hard": ("hard-scenes", _hard),
    "heaps": ("heaps-in-plane", _heaps),
    "verdicts": ("cold", _verdicts),
}
"""Name on the page, kind of file, and what makes the table."""


def _at_240(every: Iterable[Row]) -> list[Row]:
    return [row for row in every if row["dt"] == "1/240"]


def _times(row: Row | None, column: str) -> str:
    if row is None or not row[column]:
        return "-"
    if row.get("cut_off"):
        return "not finished"
    return f"{float(format(float(row[column]), '.3g')):g}&nbsp;&times;"


def _drift(row: Row | None) -> str:
    if row is None or not row["displacement"]:
        return "-"
    return _millimetres(float(row["displacement"]))


def _millimetres(metres: float) -> str:
    return f"{1e3 * metres:.3g} mm" if metres else "0"


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _dots(every: Sequence[Row], of: Callable[[Row], tuple[str, str, float]], label: str) -> str:
    """One line of dots for each scene, on a logarithmic axis, a colour for each solver."""
    points = [of(row) for row in every if not row.get("cut_off")]
    scenes = list(dict.fromkeys(scene for scene, _, _ in points))[::-1]
    names = list(dict.fromkeys(name for _, name, _ in points))
    figure = Figure(figsize=(8, 0.9 + 0.42 * len(scenes)), layout="constrained")
    axes = figure.subplots()
    for k, name in enumerate(names):
        own = [(value, scenes.index(scene)) for scene, at, value in points if at == name]
        x, y = zip(*own, strict=True)
        axes.plot(x, y, MARKERS[k], color=COLOURS[k], markersize=8, label=name, linestyle="")
    axes.set_yticks(range(len(scenes)), scenes)
    axes.grid(axis="y", color="#e3e5e8")
    _finish(axes, label)
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1), frameon=False)
    return _svg(figure)


def _ratios() -> str:
    """How many times longer the public solvers take for a verdict from nothing, by size."""
    figure = Figure(figsize=(8, 3.6), layout="constrained")
    axes = figure.subplots()
    every = [row for row in rows("cold") if row["ratio"]]
    peers = [p for p in dict.fromkeys(row["solver"] for row in every) if "drystone" not in p]
    for k, peer in enumerate(peers):
        own = [(float(r["points"]), float(r["ratio"])) for r in every if r["solver"] == peer]
        x, y = zip(*own, strict=True)
        axes.plot(x, y, MARKERS[k], color=COLOURS[k + 1], label=peer, linestyle="", alpha=0.75)
    axes.axhline(1.0, color=style.FORCE, label="drystone")
    axes.set(yscale="log", ylabel="time by that of drystone")
    _finish(axes, "contact points")
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1), frameon=False)
    return _svg(figure)


def _finish(axes: Axes, label: str) -> None:
    axes.set(xscale="log", xlabel=label)
    axes.spines[["top", "right"]].set_visible(False)


def _svg(figure: Figure) -> str:
    import io

    out = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": "drystone", "svg.fonttype": "none"}):
        figure.savefig(out, format="svg", metadata={"Date": None})
    return out.getvalue()
