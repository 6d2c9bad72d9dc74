"""Pictures of the simulations: work step by step, and how the error falls with the time step."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone import pictures, scenes
from drystone.common.extras import extra
from drystone.motion.simulation import simulate
from drystone.paper.motion import MODES, Measured
from drystone.pictures import style

COLOURS = {"none": "#1f6fb2", "motionless": "#7a4fa3", "full": "#2c8a57"}

SLOPE = {"angle_degrees": 40.0, "friction": 3.0, "width": 0.4, "height": 1.0}
"""A block that topples over its lower corner from the beginning."""
TIME = 0.4
"""Seconds of it."""


def write_motion_figures(measured: list[Measured], folder: Path) -> list[Path]:
    """Write the figures as SVG and PNG; the paths written, SVG only."""
    figures = {"fig1_fig4_pivots_by_step": pivots_by_step(measured), "order": order_of_error()}
    for name, figure in figures.items():
        for suffix in (".svg", ".png"):
            pictures.save(figure, folder / f"{name}{suffix}")
    return [folder / f"{name}.svg" for name in figures]


def pivots_by_step(measured: list[Measured]) -> Figure:
    """Pivots of every step in the three modes; the shade says how many bodies are motionless."""
    figure = Figure(figsize=(7.2, 5.4), facecolor="white", layout="constrained")
    for axes, scene in zip(
        figure.subplots(len(measured), squeeze=False)[:, 0], measured, strict=True
    ):
        for segment in scene.segments()[1:]:
            shade = 0.25 * (7 - segment.moving) / 7
            end = segment.first + segment.steps
            axes.axvspan(segment.first, end, color=style.INK, alpha=shade, linewidth=0)
        for mode in MODES:
            # A step without pivots has no place on a logarithmic axis: on its lower edge.
            axes.plot(
                np.maximum(scene.runs[mode].pivots, 0.5),
                color=COLOURS[mode],
                linewidth=0.9,
                label=mode,
            )
        axes.set_yscale("log")
        axes.set_ylabel("pivots of a step", color=style.INK)
        _title(axes, f"{scene.motion.name}: the darker, the more blocks are motionless")
        axes.legend(frameon=False, fontsize=8, loc="upper right", ncols=3)
        axes.set_xlabel("step", color=style.INK)
    return figure


def order_of_error() -> Figure:
    """Error of the angle of a toppling block against the pendulum's equation, by the time step."""
    scene = scenes.slope(**SLOPE)
    counts = np.array([25, 50, 100, 200, 400, 800, 1600])
    exact = _pendulum()
    errors = []
    for steps in counts:
        angles = simulate(scene, TIME / steps, int(steps)).poses[:, 1, 2]
        errors.append(abs(angles[-1] - angles[0] - exact))
    figure = Figure(figsize=(5.4, 4.0), facecolor="white", layout="constrained")
    axes = figure.add_subplot()
    steps_of_time = TIME / counts
    axes.loglog(steps_of_time, errors, "o-", color=COLOURS["full"], label="error of the angle")
    axes.loglog(
        steps_of_time,
        errors[-1] * steps_of_time / steps_of_time[-1],
        "--",
        color=style.FAINT,
        linewidth=0.9,
        label="first order",
    )
    axes.set_xlabel("time step [s]", color=style.INK)
    axes.set_ylabel(f"error after {TIME} s [rad]", color=style.INK)
    _title(axes, "A toppling block: order of the integrator")
    axes.legend(frameon=False, fontsize=8)
    return figure


def _pendulum() -> float:
    """Turn of the block after `TIME`: angle'' = 3 g sin(angle) / (4 r) about its corner."""
    with extra("all", "published measurements"):
        from scipy.integrate import solve_ivp

    arm = 0.5 * np.hypot(SLOPE["width"], SLOPE["height"])
    start = np.radians(SLOPE["angle_degrees"]) - np.arctan2(SLOPE["width"], SLOPE["height"])
    solution = solve_ivp(
        lambda _, state: (state[1], 0.75 * 9.81 / arm * np.sin(state[0])),
        (0.0, TIME),
        (start, 0.0),
        rtol=1e-12,
        atol=1e-12,
    )
    return float(solution.y[0, -1] - start)


def _title(axes: Axes, text: str) -> None:
    axes.set_title(text, loc="left", size=10, weight="bold", color=style.INK)
    axes.grid(True, which="major", color="#e6e8ea", linewidth=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
