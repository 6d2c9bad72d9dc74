"""Scenes and helpers that several tests share."""

from __future__ import annotations

import contextlib
import importlib.util
import io
import signal
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import drystone as ds

if importlib.util.find_spec("playwright"):  # an installed package is tested without
    pytest.register_assert_rewrite("tab")
    from tab import browser, opened, playwright

    __all__ = ["browser", "opened", "playwright"]

ROOT = Path(__file__).resolve().parents[2]

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # A shell's job in the background ignores Ctrl-C, and tests of it would wait for ever.
    signal.signal(signal.SIGINT, signal.default_int_handler)


@dataclass
class Ran:
    """What a command line left behind."""

    status: int
    out: str
    err: str


@pytest.fixture
def cli() -> Callable[..., Ran]:
    """Run a command line in this process."""

    def run(*arguments: str | Path) -> Ran:
        from drystone.cli import run as run_arguments

        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            status = run_arguments([str(argument) for argument in arguments])
        return Ran(status, out.getvalue(), err.getvalue())

    return run


@pytest.fixture
def block() -> ds.Scene:
    """One unit square of 2 kg in the middle of fixed ground."""
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, -0.5), (4, 1), name="ground", fixed=True)
    scene.add_box((0, 0.5), (1, 1), name="block", density=2.0)
    return scene


@pytest.fixture
def leaning() -> ds.Scene:
    """A plank whose centre of mass is 0.1 m beyond the edge of its pier: it tips to the right."""
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, 0.5), (1, 1), name="pier", fixed=True)
    scene.add_box((0.6, 1.1), (2, 0.2), name="plank")
    return scene


def orderless(loose: int) -> ds.Scene:
    """A structure that stands but that no order builds up, and `loose` blocks beside it.

    The plank's centre of mass is 0.1 m beyond its pier, so it needs the counterweight that lies on
    it: neither can come first. The loose blocks double the number of sub-assemblies each.
    """
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, -0.5), (100, 1), name="ground", fixed=True)
    scene.add_box((0, 0.5), (1, 1), name="pier")
    scene.add_box((0.6, 1.1), (2, 0.2), name="plank")
    scene.add_box((0, 1.6), (0.8, 0.8), name="counterweight")
    for i in range(loose):
        scene.add_box((4 + 2 * i, 0.5), (1, 1), name=f"loose{i}")
    return scene


def dropped(rng: np.random.Generator, blocks: int, friction: float) -> ds.Scene:
    """Boxes let down one after another at random places: some such structures stand, most fall.

    Every box rests on the highest thing below it. Widths, heights and places are drawn from a
    continuum, so that no box balances exactly on an edge.
    """
    scene = ds.Scene(friction=friction)
    scene.add_box((0, -0.5), (40, 1), name="ground", fixed=True)
    reach = 0.5 * np.sqrt(blocks)
    placed: list[tuple[float, float, float]] = []
    for _ in range(blocks):
        width, height = rng.uniform(0.6, 3.0), rng.uniform(0.3, 1.2)
        x = rng.uniform(-reach, reach)
        left, right = x - width / 2, x + width / 2
        floor = max((top for lo, hi, top in placed if lo < right and left < hi), default=0.0)
        scene.add_box((x, floor + height / 2), (width, height))
        placed.append((left, right, floor + height))
    return scene
