"""Scans become few convex pieces near their surface, with the scan's mass, or an error."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, KDTree

import drystone as ds
from conftest import Ran
from drystone.meshes import MeshError, MeshWarning, Part, read_part
from test_meshes import CUBE, box, l_shape, moments, prism

Points = NDArray[np.float64]


def noisy(mesh: Any, times: int, amplitude: float, seed: int = 0) -> Any:
    """A scan of a mesh: its triangles divided, its points off by up to so much along each axis."""
    for _ in range(times):
        mesh = mesh.subdivide()
    off = np.random.default_rng(seed).uniform(-amplitude, amplitude, mesh.vertices.shape)
    return trimesh.Trimesh(mesh.vertices + off, mesh.faces, process=False)


def distance(mesh: Any, pieces: list[Points], count: int = 1500) -> float:
    """The greatest distance of points of either surface from the other, another way.

    The pieces are joined by boolean union, and distances are those of a mesh's closest triangle of
    all, on points drawn at random; corners of the simpler one among them.
    """
    # A little larger, so that pieces that touch within rounding have no slit between them.
    larger = [piece + 1e-5 * (piece - piece.mean(axis=0)) for piece in pieces]
    hulls = [trimesh.convex.convex_hull(piece) for piece in larger]
    solid = hulls[0] if len(hulls) == 1 else trimesh.boolean.union(hulls)
    rng = np.random.default_rng(1)
    there = np.concatenate([solid.sample(count, seed=2), solid.vertices])
    from_mesh = mesh.vertices[rng.choice(len(mesh.vertices), count, replace=False)]
    return max(farthest(there, mesh.triangles), farthest(from_mesh, solid.triangles))


def farthest(points: Points, triangles: Points) -> float:
    """The greatest distance of a point from the nearest of all triangles that might be it."""
    middles = triangles.mean(axis=1)
    radius = np.linalg.norm(triangles - middles[:, None], axis=2).max()
    tree = KDTree(middles)
    greatest = 0.0
    for some in np.array_split(points, len(points) // 100 + 1):
        # The nearest triangle's middle is no farther than two radii beyond the nearest middle.
        may_be = tree.query_ball_point(some, tree.query(some)[0] + 2.001 * radius)
        counts = [len(one) for one in may_be]
        each = np.repeat(some, counts, axis=0)
        near = trimesh.triangles.closest_point(triangles[np.concatenate(may_be).astype(int)], each)
        gaps = np.linalg.norm(near - each, axis=1)
        first = np.cumsum([0, *counts[:-1]])
        greatest = max(greatest, np.minimum.reduceat(gaps, first).max())
    return float(greatest)


SCANS = {
    "cube": (noisy(box((1, 1, 1)), 5, 5e-4), 0.005, 1),
    "ball": (noisy(trimesh.creation.icosphere(5), 0, 5e-4), 0.03, 1),
    "L": (noisy(l_shape(), 5, 1e-3), 0.02, 2),
}


@cache
def simplified(kind: str) -> Part:
    """A scan within its bound; several tests look at it."""
    mesh, bound, _ = SCANS[kind]
    return read_part(mesh, simplify=bound)


@pytest.mark.parametrize("kind", SCANS)
def test_a_scan_becomes_few_pieces_within_the_bound(kind: str) -> None:
    mesh, bound, count = SCANS[kind]
    assert len(mesh.faces) >= 12_288
    part = simplified(kind)
    note = part.simplification
    assert note is not None
    assert len(part.pieces) == note.pieces == count
    assert sum(map(len, part.pieces)) == note.corners
    measured = distance(mesh, part.pieces)
    assert measured <= bound
    assert measured == pytest.approx(note.deviation, rel=0.25)
    assert note.volume_before == pytest.approx(mesh.volume)
    assert note.volume_after == pytest.approx(moments(part.pieces)[0])
    assert part.messages[-1] == note.message()


def test_flat_faces_come_out_flat() -> None:
    for kind, corners in (("cube", [8]), ("L", [8, 8])):
        assert [len(piece) for piece in simplified(kind).pieces] == corners


def test_what_was_simplified_weighs_what_the_mesh_does(tmp_path: Path) -> None:
    mesh, bound, _ = SCANS["ball"]
    scene = ds.Scene(dimension=3)
    with pytest.warns(MeshWarning, match="its volume by -.* its mass is that of the volume before"):
        name = scene.add_mesh(mesh, density=2.0, simplify=bound)
    assert scene.body(name).mass == pytest.approx(2.0 * mesh.volume, rel=1e-9)
    mesh.apply_scale(1000).export(tmp_path / "ball.ply")
    imported = ds.imports.load(tmp_path / "ball.ply", scale=0.001, density=3.0, simplify=bound)
    assert imported.scene.body("ball").mass == pytest.approx(3e-9 * mesh.volume, rel=1e-6)
    assert imported.bodies[0].volume == pytest.approx(1e-9 * mesh.volume, rel=1e-6)
    assert "simplified from 20480 triangles" in imported.messages[0]


def test_a_clean_mesh_stays_what_it_is() -> None:
    part = read_part(l_shape(), simplify=1e-4)
    assert moments(part.pieces)[0] == pytest.approx(3)
    assert part.density_factor == pytest.approx(1)
    assert [len(piece) for piece in part.pieces] == [8, 8]


def test_what_has_exact_pieces_only_keeps_them() -> None:
    """A gear of more planes than a decimated mesh is cut along, and no nearer one with fewer."""
    angles = np.linspace(0, 2 * np.pi, 80, endpoint=False)
    radii = np.where(np.arange(80) % 2, 1.0, 1.1)
    gear = prism(list(zip(radii * np.cos(angles), radii * np.sin(angles), strict=True)), 0.2)
    exact, part = read_part(gear), read_part(gear, simplify=1e-3)
    assert part.simplification is None
    assert [a.tobytes() for a in part.pieces] == [b.tobytes() for b in exact.pieces]


def test_what_is_no_solid_is_no_simple_one() -> None:
    with pytest.raises(MeshError, match="it is not closed"):
        read_part(trimesh.Trimesh(CUBE.vertices, CUBE.faces[1:]), simplify=0.1)
    with pytest.raises(MeshError, match="it has no volume"):
        read_part(trimesh.Trimesh(CUBE.vertices * [1, 1, 0], CUBE.faces), simplify=0.1)


def test_the_hull_of_a_scan_is_simplified() -> None:
    mesh = trimesh.creation.icosphere(5)
    with pytest.raises(MeshError, match="more than 2000: let it be simplified with simplify"):
        read_part(mesh, hull=True)
    (piece,) = read_part(mesh, hull=True, simplify=0.02).pieces
    assert len(piece) < 2000
    assert distance(mesh, [piece]) <= 0.02


def test_hundreds_of_thousands_of_triangles_are_simplified() -> None:
    mesh = trimesh.creation.icosphere(7)
    assert len(mesh.faces) > 300_000
    part = read_part(mesh, simplify=0.05)
    assert part.volume == pytest.approx(4 / 3 * np.pi, rel=1e-3)
    assert part.simplification is not None
    assert part.simplification.deviation <= 0.05
    # Its corners are the ball's, so that the flattest of its faces says how far it is.
    heights = ConvexHull(part.pieces[0]).equations[:, 3]
    assert 1 + heights.max() <= part.simplification.deviation + 1e-3


def test_the_same_simplification_again() -> None:
    mesh, bound, _ = SCANS["L"]
    again = read_part(mesh, simplify=bound)
    assert [a.tobytes() for a in simplified("L").pieces] == [b.tobytes() for b in again.pieces]


def test_what_cannot_be_simplified_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    ring = trimesh.creation.torus(1, 0.3, major_sections=64, minor_sections=32)
    with pytest.raises(MeshError, match=r"moves its surface by less than 0\.001: allow more"):
        read_part(ring, simplify=0.001)
    with pytest.raises(MeshError, match="simplify must be a positive length"):
        read_part(CUBE, simplify=-1)
    monkeypatch.setitem(sys.modules, "manifold3d", None)
    with pytest.raises(ds.MissingExtraError, match=r'pip install "drystone\[meshes\]"'):
        read_part(SCANS["cube"][0], simplify=0.01)


def test_from_the_command_line(cli: Callable[..., Ran], tmp_path: Path) -> None:
    mesh, bound, _ = SCANS["cube"]
    mesh.copy().apply_scale(1000).export(tmp_path / "cube.ply")
    arguments = ("import", tmp_path / "cube.ply", "--scale", "0.001")
    ran = cli(*arguments, "--pieces")
    assert (ran.status, ran.out) == (2, "")
    assert "let them be simplified with simplify" in ran.err
    ran = cli(*arguments, "--simplify", bound, "--json")
    (body,) = json.loads(ran.out)["bodies"]
    assert (ran.status, body["pieces"]) == (0, 1)
    assert body["volume"] == pytest.approx(mesh.volume, rel=1e-6)
    (tmp_path / "crate.xml").write_text("<mujoco/>")  # every format takes the option
    ran = cli("import", tmp_path / "crate.xml", "--simplify", bound)
    assert ran.status == 2
    assert "nothing in it can be taken" in ran.err
