"""Meshes whose numbers are rounded: the pieces that they have in full precision."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

import drystone as ds
from drystone.meshes import MeshError, part_of, read_part
from drystone.meshes.convex import cleaned
from drystone.meshes.hull import hull_volume
from drystone.meshes.polygons import triangulated
from drystone.meshes.rounding import assumed

Mesh = tuple[Any, Any]
OUTLINES = {
    "ell": [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)],
    "tee": [(0, 0), (1, 0), (1, 1), (2, 1), (2, 2), (-1, 2), (-1, 1), (0, 1)],
    "you": [(0, 0), (3, 0), (3, 2), (2, 2), (2, 1), (1, 1), (1, 2), (0, 2)],
    "stairs": [(0, 0), (3, 0), (3, 1), (2, 1), (2, 2), (1, 2), (1, 3), (0, 3)],
    "dovetail": [(0, 0), (3, 0), (3, 1), (2, 1), (2.3, 2), (0.7, 2), (1, 1), (0, 1)],
    "brick": [(0, 0), (2, 0), (2, 1), (0, 1)],
}
PIECES = {"ell": 2, "tee": 2, "you": 3, "stairs": 3, "dovetail": 2, "brick": 1}


def prism(outline: list[tuple[float, float]], height: float = 1.0) -> Mesh:
    count = len(outline)
    flat = np.array(outline, dtype=float)
    vertices = np.concatenate([np.c_[flat, np.full(count, z)] for z in (0.0, height)])
    triangles = []
    for a, b, c in triangulated(vertices[:count]):
        triangles += [(a, c, b), (a + count, b + count, c + count)]
    for i in range(count):
        j = (i + 1) % count
        triangles += [(i, j, j + count), (i, j + count, i + count)]
    return vertices, np.array(triangles)


def with_points(mesh: Mesh, count: int, rng: np.random.Generator) -> Mesh:
    """The same surface with further points on faces and edges."""
    vertices, triangles = list(mesh[0]), [tuple(t) for t in mesh[1].tolist()]
    for number in range(count):
        a, b, c = triangles[rng.integers(len(triangles))]
        new = len(vertices)
        if number % 2:
            vertices.append(rng.dirichlet([2, 2, 2]) @ np.array([vertices[k] for k in (a, b, c)]))
            triangles.remove((a, b, c))
            triangles += [(a, b, new), (b, c, new), (c, a, new)]
            continue
        share = rng.uniform(0.3, 0.7)
        vertices.append(share * vertices[a] + (1 - share) * vertices[b])
        cut = [t for t in triangles if {a, b} <= set(t)]
        triangles = [t for t in triangles if t not in cut]
        for t in cut:
            triangles += [tuple(new if k == end else k for k in t) for end in (a, b)]
    return np.array(vertices), np.array(triangles)


def volume(mesh: Mesh) -> float:
    a, b, c = np.moveaxis(mesh[0][mesh[1]] - mesh[0][0], 1, 0)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


@pytest.mark.parametrize("name", OUTLINES)
@pytest.mark.parametrize("points", [0, 10])
def test_as_many_pieces_as_in_full_precision(name: str, points: int) -> None:
    rng = np.random.default_rng(len(name) + points)
    for decimals, size in itertools.product((8, 6, 5, 4, 3), (1e-3, 1.0, 1e3)):
        vertices, triangles = with_points(prism(OUTLINES[name]), points, rng)
        turn = Rotation.random(random_state=int(rng.integers(1 << 30))).as_matrix()
        written = (size * (vertices @ turn.T + rng.uniform(-3, 3, 3))).round(
            decimals - round(np.log10(size))
        )
        part = part_of(name, written, triangles)
        assert len(part.pieces) <= PIECES[name], (decimals, size)
        unit = size * 10.0**-decimals
        got = sum(map(hull_volume, part.pieces))
        assert abs(got - volume((written, triangles))) < unit * 40 * size**2
        corners = np.concatenate(part.pieces)
        for vertex in written[: 2 * len(OUTLINES[name])]:
            # Each of the first corners is one of a piece, within what the numbers explain, or
            # what any mesh is exact to.
            assert np.linalg.norm(corners - vertex, axis=1).min() < max(2 * unit, 1e-6 * size)
        assert decimals == 8 or "decimals: faces that are plane" in part.messages[0]


def test_single_precision_far_from_the_origin() -> None:
    vertices, triangles = prism(OUTLINES["ell"])
    for seed in range(5):
        turn = Rotation.random(random_state=seed).as_matrix()
        written = (vertices @ turn.T + 1000.0).astype(np.float32).astype(float)
        part = part_of("ell", written, triangles)
        assert len(part.pieces) == 2
        assert part.messages[0].startswith("its coordinates are of single precision")


def test_a_given_tolerance() -> None:
    import trimesh

    vertices, triangles = prism(OUTLINES["you"])
    turn = Rotation.random(random_state=3).as_matrix()
    noise = np.random.default_rng(3).uniform(-1e-3, 1e-3, vertices.shape)
    mesh = trimesh.Trimesh(vertices @ turn.T + noise, triangles, process=False)
    part = read_part(mesh, tolerance=3e-3)
    assert (len(part.pieces), part.tolerance) == (3, 3e-3)
    assert "its tolerance is given" in part.messages[0]
    scene = ds.Scene(dimension=3)
    with pytest.warns(ds.meshes.MeshWarning, match="its tolerance is given"):
        scene.add_mesh(mesh, tolerance=3e-3)
    with pytest.raises(MeshError, match="its tolerance must be a length in metres, not -1"):
        read_part(mesh, tolerance=-1)
    rounded = trimesh.Trimesh((vertices @ turn.T).round(3), triangles, process=False)
    assert len(read_part(rounded).pieces) == 3
    assert read_part(rounded, scale=0.001).tolerance == pytest.approx(2e-6)
    try:
        exact = read_part(rounded, tolerance=0, surface=False)
    except MeshError:
        return
    assert len(exact.pieces) > 3


@pytest.mark.parametrize("number", [float, np.float64, np.float32])
def test_a_tolerance_may_be_any_kind_of_number(number: Any, tmp_path: Path) -> None:
    trimesh.creation.box().export(tmp_path / "cube.stl")
    imported = ds.imports.load(tmp_path / "cube.stl", tolerance=number(0.25))
    assert imported.scene.contact_tolerance == 0.25


def test_round_numbers_are_not_rounded_ones() -> None:
    # A step as high as the last place, in whole millimetres: chosen so.
    outline = [(0, 0), (100, 0), (100, 20), (50, 20), (50, 21), (0, 21)]
    part = part_of("step", *prism(outline, 30.0))
    assert (len(part.pieces), part.tolerance, part.messages) == (2, 0.0, [])
    assert sum(map(hull_volume, part.pieces)) == pytest.approx((100 * 20 + 50) * 30)


@pytest.mark.parametrize(
    ("numbers", "tolerance", "reason"),
    [
        ([[0.125, -3.5, 20.0]], 2e-3, "its coordinates have 3 decimals"),
        ([[1200.0, 300.0, 0.0]], 200.0, "its coordinates have -2 decimals"),
        ([[1e-4, 2.3e-3, 0.0]], 2e-4, "its coordinates have 4 decimals"),
        ([[1 / 3, 0.5, 1.0]], 0.0, "its coordinates are exact"),
        ([[np.float32(1 / 3), 0.5, 1.0]], 2.0**-22, "its coordinates are of single precision"),
        ([[0.0, 0.0, 0.0]], 0.0, ""),
        ([[np.nan, 0.5, 1.0]], 0.0, ""),
        ([[np.inf, 0.5, 1.0]], 0.0, ""),
    ],
)
def test_how_exact_numbers_are(numbers: Any, tolerance: float, reason: str) -> None:
    found = assumed(np.array(numbers, dtype=float))
    assert found.tolerance == pytest.approx(tolerance)
    assert found.reason == reason


def wall(folder: Path, rotation: Rotation, decimals: int) -> None:
    """Five rows of bricks of quads, each a file."""
    unit = np.array(list(itertools.product((0, 1), repeat=3)), float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    for row, column in itertools.product(range(4), range(3)):
        at = [column + 0.3 * (row % 2), 0, 0.5 * row]
        place = rotation.apply(unit * [1, 0.5, 0.5] + at)
        text = "".join("v {:.{d}f} {:.{d}f} {:.{d}f}\n".format(*p, d=decimals) for p in place)
        text += "".join("f " + " ".join(str(i + 1) for i in quad) + "\n" for quad in quads)
        (folder / f"{row}-{column}.obj").write_text(text)


@pytest.mark.parametrize("decimals", [9, 5, 3])
@pytest.mark.parametrize("seed", [0, 1])
def test_a_wall_of_bricks_stands(decimals: int, seed: int, tmp_path: Path) -> None:
    rotation = Rotation.random(random_state=seed)
    wall(tmp_path, rotation, decimals)
    fixed, gravity = [f"0-{k}" for k in range(3)], rotation.apply([0, 0, -9.81])
    imported = ds.imports.load(tmp_path, fixed=fixed, gravity=gravity)
    assert [len(body.pieces) for body in imported.bodies] == [1] * 12
    assert ds.check(imported.scene).stable
    if decimals < 9:
        assert imported.scene.contact_tolerance == pytest.approx(3 * 10.0**-decimals)
        assert "bodies touch that are up to" in imported.messages[-1]
    given = ds.imports.load(tmp_path, fixed=fixed, gravity=gravity, tolerance=3 * 10.0**-decimals)
    assert ds.check(given.scene).stable


def test_a_piece_whose_planes_meet_far_away_stays_as_it_is() -> None:
    # Of a block of the curved cubes of compas_cra 0.8.0.
    front = [(-0.093535393, -0.242970314), (-0.125095867, -0.281168552)]
    front += [(-0.125096694, -0.281169501), (0.03579302, -0.067669967)]
    front += [(-0.040765487, -0.174289884), (-0.000443809, -0.118269624)]
    back = [(-0.096146934, -0.246785255), (-0.000443809, -0.118269624)]
    back += [(-0.047562950, -0.183552833), (-0.12001096, -0.274177998)]
    back += [(0.039292862, -0.062782929), (-0.02391458, -0.151043208)]
    points = [(0.399727567, y, z) for y, z in front] + [(0.499727591, y, z) for y, z in back]
    piece = np.array([*points, (0.499706548, -0.02391262, -0.151040531)])
    whole = hull_volume(piece)
    assert hull_volume(cleaned(piece, 5.03e-7, 100)) == pytest.approx(whole, rel=0.02)
    flat = np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 1e-9)])
    assert len(cleaned(flat, 1e-7, 100)) == 0


def test_concave_polygons_do_not_fold() -> None:
    outline = np.array([(x, y, 0.1 * x) for x, y in OUTLINES["you"]], dtype=float)
    for first in range(len(outline)):
        points = np.roll(outline, first, axis=0)
        corners = points[np.array(triangulated(points))]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert (normals[:, 2] > 0).all()
        assert normals[:, 2].sum() / 2 == pytest.approx(5.0)
    bow = np.array([(0, 0, 0), (1, 1, 0), (1, 0, 0), (0, 1, 0)], dtype=float)
    assert len(triangulated(bow)) == 2
