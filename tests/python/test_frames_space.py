"""Frames of recordings in space as still pictures."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.patches import FancyArrow

import drystone as ds
from by_hand import plan_by_hand, run_by_hand
from drystone import pictures
from drystone.viewer import Page


def test_frames_in_space_have_one_view(tmp_path: Path) -> None:
    run = run_by_hand()
    figures = [pictures.frame_figure(run, frame) for frame in (0, 60, 120)]
    assert len({figure.axes[0].get_xlim() for figure in figures}) == 1
    assert len({figure.axes[0].get_ylim() for figure in figures}) == 1
    fills = [
        {mpl.colors.to_hex(c) for col in figure.axes[0].collections for c in col.get_facecolor()}
        for figure in figures
    ]
    assert len(fills[1]) > len(fills[0]), "what moves is light beside the dark"
    paths = Page(plan_by_hand()).save_frames(tmp_path, [0, 5], ".svg")
    assert all(path.read_text().startswith("<?xml") for path in paths)


def test_forces_of_a_frame_are_to_one_scale_in_all() -> None:
    plan = plan_by_hand()
    longest = []
    for frame in (0, 1):
        axes = pictures.frame_figure(plan, frame).axes[0]
        arrows = [patch for patch in axes.patches if isinstance(patch, FancyArrow)]
        longest.append(max(np.ptp(arrow.get_xy(), axis=0)[1] for arrow in arrows))
    assert longest[0] == pytest.approx(1.25 * longest[1], rel=0.02)


def test_the_bodies_of_a_frame_have_their_names() -> None:
    scene = ds.Scene(dimension=3)
    scene.add_box((0, 0, -0.5), (6, 6, 1), name="floor", fixed=True)
    scene.add_box((0, 0, 0.5), (1, 1, 1), name="below")
    scene.add_box((0.2, 0, 3.0), (1, 1, 1), name="above")
    for page in (ds.simulate(scene, steps=20).view(), ds.plan(scene.parted(), hold=1).view()):
        (axes,) = pictures.frame_figure(page.recording, 0).axes
        places = {text.get_text(): text.get_position() for text in axes.texts}
        assert {"below", "above"} <= set(places)
        assert "floor" not in places
        assert places["above"][1] > places["below"][1] + 1.0
