"""Pictures of solids: what hides what, what is seen of a face, to which scale arrows are drawn."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrow

import drystone as ds
from by_hand import box, solids
from conftest import Ran
from drystone import pictures
from drystone.pictures import style
from drystone.pictures.axonometry import View, box_of, far_to_near, pieces_of, rotation
from drystone.pictures.canvas import fitted
from drystone.pictures.in_space import draw_forces
from drystone.pictures.seams import edges_seen
from drystone.pictures.solids import Drawing, draw_solids
from drystone.scene import Solid

GRAVITY = (0.0, 0.0, -9.81)


def apart(rng: np.random.Generator, count: int) -> list[Solid]:
    """Turned boxes that do not overlap: each stays within its own cell of a grid."""
    cells = rng.permutation(27)[:count]
    found = []
    for i, cell in enumerate(cells):
        quaternion = rng.normal(size=4)
        size = rng.uniform(0.2, 1.0, 3)
        size *= 1.0 / np.linalg.norm(size)
        at = np.array([cell % 3, cell // 3 % 3, cell // 9], dtype=float)
        orientation = quaternion / np.linalg.norm(quaternion)
        found.append(box(f"b{i}", tuple(at), tuple(size), False, tuple(orientation)))
    return found


def hits(body: Solid, origin: np.ndarray, way: np.ndarray) -> float:
    """Where a ray enters a box, by its slabs in its own frame: another way than the code's."""
    turned = rotation(body.orientation)
    start, along = (origin - body.centroid) @ turned, way @ turned
    half = np.asarray(body.box_size) / 2
    near, far = (-half - start) / along, (half - start) / along
    enters, leaves = np.max(np.minimum(near, far)), np.min(np.maximum(near, far))
    return float(enters) if enters < leaves else np.inf


@pytest.mark.parametrize("seed", range(12))
def test_nearer_solids_are_painted_over_farther_ones(seed: int) -> None:
    rng = np.random.default_rng(seed)
    bodies = apart(rng, 18)
    view = View.of(bodies, rng.normal(size=3))
    order = [piece.body for piece in far_to_near(pieces_of(bodies, box_of(bodies)), view)]
    assert sorted(order) == list(range(18))
    met = 0
    for _ in range(400):
        through = bodies[rng.integers(18)].vertices.mean(axis=0) + rng.normal(size=3) * 0.1
        eye = through + 50 * view.axes[2]
        distance = [hits(body, eye, -view.axes[2]) for body in bodies]
        seen = [body for body in order if np.isfinite(distance[body])]
        met += len(seen) > 1
        assert [distance[b] for b in seen] == sorted((distance[b] for b in seen), reverse=True)
    assert met > 50


def test_stacked_blocks_are_painted_from_the_foot_up() -> None:
    bodies = [box(f"b{i}", (0, 0, i + 0.5)) for i in (2, 0, 3, 1)]
    order = far_to_near(pieces_of(bodies, box_of(bodies)), View.of(bodies, GRAVITY))
    assert [bodies[piece.body].name for piece in order] == ["b0", "b1", "b2", "b3"]


def test_the_view_is_a_rotation_with_gravity_downwards() -> None:
    for gravity in (GRAVITY, (3.0, -1.0, -9.0), (0.0, -9.81, 0.0), (0.0, 0.0, 0.0)):
        view = View.of(solids(), gravity)
        assert view.axes @ view.axes.T == pytest.approx(np.eye(3), abs=1e-12)
        assert np.linalg.det(view.axes) == pytest.approx(1)
        down = view.flat(np.array([gravity]))[0]
        assert down[0] == pytest.approx(0, abs=1e-12)
        assert down[1] <= 0


def test_a_quaternion_turns_as_its_axis_says() -> None:
    """A quarter about z takes x to y."""
    turned = rotation((np.cos(np.pi / 4), 0, 0, np.sin(np.pi / 4)))
    assert turned @ [1, 0, 0] == pytest.approx([0, 1, 0])


def _faces(figure: Figure) -> list[np.ndarray]:
    return [
        np.asarray(path.vertices)
        for collection in figure.axes[0].collections
        if isinstance(collection, PathCollection)
        for path in collection.get_paths()
    ]


def _drawn(bodies: list[Solid], labels: dict[str, str] | None = None) -> Figure:
    drawing = Drawing.of(bodies, View.of(bodies, GRAVITY))
    canvas = fitted(drawing.outlines, "title", key=True)
    fills = {body.name: style.STONE for body in bodies if not body.fixed}
    draw_solids(canvas, drawing, fills, labels=labels)
    return canvas.figure


def test_of_a_cube_three_faces_are_seen_and_they_fill_its_outline() -> None:
    figure = _drawn([box("cube", (0, 0, 0))])
    faces = _faces(figure)
    assert len(faces) == 3
    view = View.of([box("cube", (0, 0, 0))], GRAVITY)
    areas = []
    for face in faces:
        x, y = face[:-1].T
        areas.append(0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))
    # A unit face is seen as large as its normal points to the eye.
    assert sorted(areas) == pytest.approx(sorted(np.abs(view.axes[2])))


def test_labels_are_where_their_block_is_seen() -> None:
    hidden = box("hidden", (0, 3, 0.2), (0.3, 0.3, 0.3))
    wall = box("wall", (0, 0, 0), (8, 0.5, 6))
    names = {"wall": "wall", "hidden": "hidden"}
    texts = [text.get_text() for text in _drawn([wall, hidden], names).axes[0].texts]
    assert "wall" in texts
    assert "hidden" not in texts


def test_a_large_ground_does_not_take_the_picture() -> None:
    bodies = [box("ground", (0, 0, -1), (1000, 1000, 2), fixed=True), box("b", (0, 0, 0.5))]
    extent = np.concatenate(_faces(_drawn(bodies)))
    assert np.ptp(extent, axis=0).max() < 3


def test_arrows_are_to_scale_as_far_as_they_are_seen() -> None:
    bodies = [box("ground", (0, 0, -0.5), (4, 4, 1), fixed=True), box("b", (0, 0, 0.5))]
    drawing = Drawing.of(bodies, View.of(bodies, GRAVITY))
    canvas = fitted(drawing.outlines, "title", key=True)
    vectors = np.array([[0.0, 0.0, 4.0], [1.0, 0.0, 2.0], [0.0, 0.0, -2.0]])
    draw_forces(canvas, drawing, np.zeros((3, 3)), vectors, GRAVITY, 1.0)
    arrows = [patch for patch in canvas.axes.patches if isinstance(patch, FancyArrow)]
    lengths = [np.ptp(arrow.get_xy(), axis=0)[1] for arrow in arrows[:3]]
    assert lengths[0] == pytest.approx(np.cos(0.38), rel=0.05), "a metre, foreshortened"
    assert lengths[2] == pytest.approx(lengths[0] / 2, rel=0.05)
    key = next(text for text in canvas.axes.texts if text.get_text().endswith(" N"))
    shown = np.ptp(arrows[3].get_xy(), axis=0)[0]
    assert shown == pytest.approx(float(key.get_text().split()[0]) / 4.0)
    ups = [arrow.get_xy()[:, 1].max() > 0.1 for arrow in arrows[:3]]
    assert all(ups), "each as it acts on what is carried"


def test_what_falls_is_red_and_says_where_it_goes() -> None:
    scene = ds.Scene(dimension=3)
    scene.add_box((0, 0, 0.5), (1, 1, 1), name="pier", fixed=True)
    scene.add_box((0.6, 0, 1.1), (2, 1, 0.2), name="plank")
    axes = pictures.verdict_figure(ds.check(scene)).axes[0]
    assert any(text.get_text().endswith("m/s²") for text in axes.texts)
    edges = {mpl.colors.to_hex(c) for col in axes.collections for c in col.get_edgecolor()}
    assert style.FALL in edges
    dashed = [col for col in axes.collections if len(col.get_paths()) == 1]
    assert dashed, "the outline of where the plank is going"


def test_the_command_line_draws(cli: Callable[..., Ran], tmp_path: Path) -> None:
    ds.scenes.column(3).extruded().save(tmp_path / "column.json")
    for command in ("check", "plan"):
        picture = tmp_path / f"{command}.png"
        assert cli(command, tmp_path / "column.json", "-o", picture).status == 0
        assert picture.read_bytes().startswith(b"\x89PNG")


def test_edges_between_pieces_in_one_plane_are_not_drawn() -> None:
    """An L of two boxes, 1 deep: twice its outline of 8, less what is hidden, and edges across."""
    foot, post = box("L", (0, 0, 0), (2, 1, 1)), box("L", (-0.5, 0, 1))
    pieces = pieces_of([foot, post], box_of([foot, post]))
    seen: dict[frozenset[tuple[float, ...]], float] = {}
    for piece, other in (pieces, pieces[::-1]):
        for face in range(6):
            for ends in edges_seen(piece, face, [other]):
                name = frozenset(tuple((np.round(end, 3) + 0.0).tolist()) for end in ends)
                seen[name] = float(np.linalg.norm(ends[1] - ends[0]))
    assert sum(seen.values()) == pytest.approx(2 * 8 + 6, abs=1e-3)
