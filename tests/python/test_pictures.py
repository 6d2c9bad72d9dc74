"""Pictures are written, show what they should, and are the same every time."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrow

import drystone as ds
from conftest import orderless
from drystone import pictures
from drystone.pictures import style
from drystone.pictures.arrows import round_number


def _polygons(figure: Figure) -> int:
    return sum(
        len(collection.get_paths())
        for axes in figure.axes
        for collection in axes.collections
        if isinstance(collection, PolyCollection)
    )


def _arrows(figure: Figure, colour: str) -> list[FancyArrow]:
    return [
        patch
        for axes in figure.axes
        for patch in axes.patches
        if isinstance(patch, FancyArrow) and mpl.colors.to_hex(patch.get_facecolor()) == colour
    ]


def _texts(figure: Figure) -> list[str]:
    return [text.get_text() for axes in figure.axes for text in axes.texts]


@pytest.mark.parametrize("suffix", ["svg", "png"])
@pytest.mark.parametrize("space", [False, True])
def test_files_are_written(tmp_path: Path, suffix: str, space: bool) -> None:
    def given(scene: ds.Scene) -> ds.Scene:
        return scene.extruded(0.5) if space else scene

    scene = given(ds.scenes.five_blocks())
    for name, drawn in {
        "scene": scene,
        "check": ds.check(scene),
        "falls": ds.check(scene, ["1", "3"]),
        "plan": ds.plan(scene),
        "no plan": ds.plan(given(orderless(1))),
        "whole falls": ds.plan(given(ds.scenes.diamond(5))),
    }.items():
        path = tmp_path / f"{name}.{suffix}"
        drawn.draw(path)
        data = path.read_bytes()
        assert len(data) > 2000
        assert data.startswith(b"<?xml" if suffix == "svg" else b"\x89PNG")
        drawn.draw(tmp_path / f"again.{suffix}")
        assert (tmp_path / f"again.{suffix}").read_bytes() == data, "the same every time"


def test_a_png_has_more_than_one_colour(tmp_path: Path) -> None:
    from matplotlib.image import imread

    ds.check(ds.scenes.arch(7)).draw(tmp_path / "arch.png")
    pixels = imread(tmp_path / "arch.png").reshape(-1, 4)
    assert len(np.unique((255 * pixels).astype(int), axis=0)) > 50


def test_another_kind_of_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"\.svg, \.pdf, \.png or \.html"):
        ds.scenes.column(3).draw(tmp_path / "column.gif")
    assert not list(tmp_path.iterdir())


def test_notebooks_get_an_image() -> None:
    scene = ds.scenes.column(3)
    for shown in (scene, ds.check(scene), ds.plan(scene)):
        assert "<svg" in shown._repr_svg_()


def test_every_block_and_force_is_drawn() -> None:
    verdict = ds.check(ds.scenes.pyramid(3))
    figure = pictures.verdict_figure(verdict)
    assert _polygons(figure) == 7
    pushing = [force for force in verdict.forces if force.normal_force > 1e-6]
    # One arrow a force, and one in the key.
    assert len(_arrows(figure, style.FORCE)) == len(pushing) + 1
    assert {"1", "2", "3", "4", "5", "6"} <= set(_texts(figure))
    assert any(text.endswith(" N") for text in _texts(figure))


def test_arrows_are_to_scale() -> None:
    """Two equal forces and the key: lengths in proportion to newtons."""
    scene = ds.Scene(friction=0)
    scene.add_box((0, -0.5), (4, 1), fixed=True)
    scene.add_box((0, 0.5), (1, 1), density=2.0)
    figure = pictures.verdict_figure(ds.check(scene))
    lengths = [np.ptp(arrow.get_xy(), axis=0).max() for arrow in _arrows(figure, style.FORCE)]
    assert lengths[0] == pytest.approx(lengths[1])
    key = next(text for text in _texts(figure) if text.endswith(" N"))
    assert lengths[2] / lengths[0] == pytest.approx(float(key.split()[0]) / 9.81)


def test_falling_blocks_are_marked_and_their_acceleration_drawn(leaning: ds.Scene) -> None:
    figure = pictures.verdict_figure(ds.check(leaning))
    fills = [
        mpl.colors.to_hex(colour)
        for collection in figure.axes[0].collections
        for colour in collection.get_facecolor()
    ]
    assert style.FALLING in fills
    assert len(_arrows(figure, style.FALL)) == 2
    assert any(text.endswith("m/s²") for text in _texts(figure))


def test_the_order_is_coloured_and_numbered() -> None:
    plan = ds.plan(ds.scenes.pyramid(3))
    figure = pictures.plan_figure(plan)
    assert {"1", "2", "3", "4", "5", "6"} <= set(_texts(figure))
    assert len(figure.axes) == 2, "the second is the colour bar"


def test_held_blocks_are_hatched_and_arrows_say_where_blocks_leave() -> None:
    plan = ds.plan(ds.scenes.arch(7), hold=1, clear_path=True)
    figure = pictures.plan_figure(plan)
    hatched = [c for c in figure.axes[0].collections if c.get_hatch() == "\\\\\\\\"]
    assert [len(c.get_paths()) for c in hatched] == [len({n for held in plan.holds for n in held})]
    assert len(_arrows(figure, style.WAY)) == len(plan.order)
    assert any("held on the way" in text.get_text() for text in figure.texts)


def test_large_scenes_drop_labels_and_stay_readable() -> None:
    scene = ds.scenes.wall(45, 55)
    figure = pictures.scene_figure(scene)
    assert _polygons(figure) == len(scene)
    assert _texts(figure) == []
    assert len(pictures.svg(figure)) < 5_000_000


def test_an_empty_scene_is_a_picture() -> None:
    assert "<svg" in ds.Scene()._repr_svg_()
    assert "<svg" in ds.check(ds.Scene())._repr_svg_()


def test_the_same_picture_every_time() -> None:
    scene = ds.scenes.random_stack(12)
    for draw in (
        lambda: scene._repr_svg_(),
        lambda: ds.check(scene)._repr_svg_(),
        lambda: ds.plan(scene)._repr_svg_(),
    ):
        assert draw() == draw()


def test_global_state_is_left_alone() -> None:
    before = dict(mpl.rcParams)
    pictures.svg(pictures.scene_figure(ds.scenes.column(3)))
    assert dict(mpl.rcParams) == before


def test_pyplot_is_not_loaded() -> None:
    code = "import drystone as ds, sys; ds.scenes.column(3)._repr_svg_(); print(*sys.modules)"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "matplotlib.figure" in ran.stdout.split()
    assert "matplotlib.pyplot" not in ran.stdout.split()


def test_the_disassembly_graph_has_every_sub_assembly() -> None:
    from drystone import _core

    scene = ds.scenes.five_blocks()
    nodes = _core.disassembly_graph(scene._core)
    assert len(nodes) == 2**5
    for names, stands in nodes:
        assert stands == ds.check(scene, names).stable
    figure = pictures.graph_figure(scene, nodes, ds.plan(scene).order)
    # 16 times each of the five blocks, and the ground in each of the 32 nodes.
    assert _polygons(figure) == 5 * 16 + 32


def test_round_numbers() -> None:
    assert [round_number(value) for value in (1, 1.9, 2, 4.99, 5, 99, 0.03)] == pytest.approx(
        [1, 1, 2, 2, 5, 50, 0.02]
    )


@pytest.mark.parametrize("space", [False, True])
def test_where_blocks_are_going_is_within_the_picture(space: bool) -> None:
    """A tall block that tips over rises above where it stood."""
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, -0.5), (4, 1), name="ground", fixed=True)
    scene.add_box((0, 1), (0.6, 2), name="block")
    scene = scene.extruded(0.5) if space else scene
    push = {"block": (1, 0, 0) if space else (1, 0)}
    (axes,) = pictures.limit_figure(ds.limit(scene, push=push)).axes
    dashed = [
        path.vertices
        for collection in axes.collections
        if isinstance(collection, PolyCollection) and collection.get_facecolor().size == 0
        for path in collection.get_paths()
    ]
    assert dashed
    low, high = np.min(np.concatenate(dashed), axis=0), np.max(np.concatenate(dashed), axis=0)
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    assert left < low[0] < high[0] < right
    assert bottom < low[1] < high[1] < top


@pytest.mark.parametrize("space", [False, True])
def test_the_picture_of_a_run_is_of_its_end(space: bool) -> None:
    """A block has fallen from ten times its height: the sky it fell through is not shown; in the
    frames of a film it is."""
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, -0.5), (2, 1), name="ground", fixed=True)
    scene.add_box((0, 10), (1, 1), name="block")
    run = ds.simulate(scene.extruded(1.0) if space else scene, steps=480)
    assert not run.moving
    (axes,) = pictures.figure_of(run).axes
    assert np.ptp(axes.get_ylim()) < 4
    (axes,) = pictures.frame_figure(run.view().recording, run.steps).axes
    assert np.ptp(axes.get_ylim()) > 8
