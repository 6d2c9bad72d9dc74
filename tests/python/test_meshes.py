"""Meshes become convex pieces with the mesh's mass, or an error that says what to mend."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

import drystone as ds
from drystone.meshes import MeshError, MeshWarning, Part, read_part
from drystone.meshes.convex import winding_number

Points = NDArray[np.float64]


def box(size: tuple[float, float, float], at: tuple[float, float, float] = (0, 0, 0)) -> Any:
    mesh = trimesh.creation.box(size)
    mesh.apply_translation(at)
    return mesh


def moments(pieces: list[Points]) -> tuple[float, Points, Points]:
    """Volume, centroid, and inertia about it (density 1), of convex pieces."""
    meshes = [trimesh.convex.convex_hull(piece) for piece in pieces]
    volumes = np.array([mesh.volume for mesh in meshes])
    centroid = volumes @ np.array([mesh.center_mass for mesh in meshes]) / volumes.sum()
    inertia = np.zeros((3, 3))
    for mesh in meshes:
        r = mesh.center_mass - centroid
        inertia += mesh.moment_inertia + mesh.volume * (r @ r * np.eye(3) - np.outer(r, r))
    return float(volumes.sum()), centroid, inertia


def inside(piece: Points, rng: np.random.Generator, count: int = 20) -> Points:
    """Random points strictly inside a convex piece."""
    shares = rng.dirichlet(np.ones(len(piece)), size=count)
    return shares @ piece


def check_is_the_solid(part: Part, mesh: Any, seed: int = 0) -> None:
    """The pieces have the mesh's moments, lie in it, and do not overlap."""
    volume, centroid, inertia = moments(part.pieces)
    assert volume == pytest.approx(mesh.volume, rel=1e-6)
    assert centroid == pytest.approx(mesh.center_mass, abs=1e-6 * mesh.scale)
    assert inertia == pytest.approx(mesh.moment_inertia, abs=1e-5 * abs(mesh.moment_inertia).max())
    rng = np.random.default_rng(seed)
    hulls = [ConvexHull(piece).equations for piece in part.pieces]
    for number, piece in enumerate(part.pieces):
        for point in inside(piece, rng):
            assert winding_number(mesh.triangles, point) == pytest.approx(1, abs=1e-4)
            holders = [(h[:, :3] @ point + h[:, 3] < -1e-7).all() for h in hulls]
            assert holders.count(True) == holders[number]


def export(mesh: Any, path: Path) -> None:
    """Write a mesh; glTF comes in two files, which trimesh leaves open if it writes them itself."""
    if path.suffix != ".gltf":
        mesh.export(path)
        return
    for name, data in mesh.export(file_type="gltf").items():
        (path if name == "model.gltf" else path.with_name(name)).write_bytes(data)


# Solids whose moments are known


def l_shape() -> Any:
    """An L of 2 x 2 with legs 1 wide, 1 thick: 3 unit cubes."""
    outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    return prism(outline, 1.0)


def prism(outline: list[tuple[float, float]], height: float) -> Any:
    """A prism whose ends are one polygon each, fanned from its first corner as file readers do."""
    n = len(outline)
    vertices = [(*p, z) for z in (0.0, height) for p in outline]
    ends = [(0, i + 1, i) for i in range(1, n - 1)] + [
        (n, n + i, n + i + 1) for i in range(1, n - 1)
    ]
    sides = []
    for i in range(n):
        j = (i + 1) % n
        sides += [(i, j, n + j), (i, n + j, n + i)]
    return trimesh.Trimesh(vertices, ends + sides, process=False)


def test_l_shape() -> None:
    part = read_part(l_shape())
    volume, centroid, inertia = moments(part.pieces)
    assert len(part.pieces) == 2
    assert part.volume == pytest.approx(3)
    assert volume == pytest.approx(3)
    assert centroid == pytest.approx([5 / 6, 5 / 6, 1 / 2])
    # About z: three unit cubes, each 1/6, at squared distances 2/36, 17/36 ... from the centroid.
    squares = sum(
        (x - 5 / 6) ** 2 + (y - 5 / 6) ** 2 for x, y in [(0.5, 0.5), (1.5, 0.5), (0.5, 1.5)]
    )
    assert inertia[2, 2] == pytest.approx(3 / 6 + squares)


def test_a_convex_mesh_is_one_piece_of_its_corners() -> None:
    mesh = box((1, 2, 3))
    for _ in range(3):
        mesh = mesh.subdivide()  # 768 triangles, 386 vertices
    (piece,) = read_part(mesh).pieces
    assert len(piece) == 8


def test_hollow_box() -> None:
    cavity = box((1, 1, 1))
    cavity.invert()
    part = read_part(trimesh.util.concatenate([box((2, 2, 2)), cavity]))
    volume, centroid, inertia = moments(part.pieces)
    assert volume == pytest.approx(8 - 1)
    assert centroid == pytest.approx([0, 0, 0], abs=1e-12)
    assert inertia == pytest.approx(np.eye(3) * (8 * 4 / 6 - 1 / 6), abs=1e-9)
    assert part.messages == []


def test_notched_cube() -> None:
    notch = box((0.5, 2, 0.5), at=(0, 0, 0.5))
    mesh = trimesh.boolean.difference([box((1, 1, 1)), notch])
    part = read_part(mesh)
    volume, centroid, _ = moments(part.pieces)
    assert len(part.pieces) == 3
    assert volume == pytest.approx(1 - 0.5 * 0.25)
    assert centroid == pytest.approx([0, 0, -0.125 * 0.375 / 0.875])


def test_a_concave_polygon_given_as_a_fan() -> None:
    """A U: the fan from its first corner covers the gap twice, in opposite directions."""
    outline = [(0, 0), (3, 0), (3, 2), (2, 2), (2, 1), (1, 1), (1, 2), (0, 2)]
    part = read_part(prism(outline, 1.0))
    assert moments(part.pieces)[0] == pytest.approx(5)
    assert moments(part.pieces)[1] == pytest.approx([1.5, 4.5 / 5, 0.5])


def test_parts_that_touch_are_one_body() -> None:
    part = read_part(trimesh.util.concatenate([box((1, 1, 1)), box((1, 1, 1), at=(1, 0, 0))]))
    assert part.messages == ["merged 4 duplicate vertices"]
    assert [len(piece) for piece in part.pieces] == [8]
    apart = read_part(trimesh.util.concatenate([box((1, 1, 1)), box((1, 1, 1), at=(3, 0, 0))]))
    assert apart.messages == ["its 2 separate parts are one rigid body"]
    assert [len(piece) for piece in apart.pieces] == [8, 8]


@pytest.mark.parametrize("seed", range(12))
def test_random_unions(seed: int) -> None:
    """Boxes turned at random, joined by an independent library (manifold)."""
    rng = np.random.default_rng(seed)
    boxes = []
    for _ in range(3):
        mesh = trimesh.creation.box(rng.uniform(0.5, 2.0, 3))
        mesh.apply_transform(trimesh.transformations.random_rotation_matrix(rng.random(3)))
        mesh.apply_translation(rng.uniform(-0.3, 0.3, 3))
        boxes.append(mesh)
    mesh = trimesh.boolean.union(boxes)
    check_is_the_solid(read_part(mesh), mesh, seed)


@pytest.mark.parametrize("seed", range(6))
def test_random_unions_in_single_precision(seed: int, tmp_path: Path) -> None:
    """An STL file keeps 24 bits: faces that were flat are so only within a tolerance."""
    rng = np.random.default_rng(100 + seed)
    boxes = [
        box(tuple(rng.uniform(0.5, 2.0, 3)), tuple(rng.uniform(-0.7, 0.7, 3))) for _ in range(4)
    ]
    mesh = trimesh.boolean.union(boxes)
    mesh.apply_transform(trimesh.transformations.random_rotation_matrix(rng.random(3)))
    if len(mesh.split()) > 1:
        pytest.skip("these boxes do not meet")
    mesh.export(tmp_path / "union.stl")
    part = read_part(tmp_path / "union.stl")
    check_is_the_solid(part, mesh, seed)
    assert len(part.pieces) <= 60


@pytest.mark.parametrize("seed", range(5))
def test_faces_are_plane_whatever_the_file(seed: int, tmp_path: Path) -> None:
    """A turned box in single precision has triangles in twelve planes; ours has six faces."""
    rng = np.random.default_rng(seed)
    mesh = box((1, 2, 3))
    mesh.apply_transform(trimesh.transformations.random_rotation_matrix(rng.random(3)))
    mesh.export(tmp_path / "turned.stl")
    (piece,) = read_part(tmp_path / "turned.stl").pieces
    planes = ConvexHull(piece).equations
    assert len(piece) == 8
    assert len({tuple(plane) for plane in (planes + 10).round(9)}) == 6
    radii = np.linalg.norm(piece - piece.mean(axis=0), axis=1)
    assert radii == pytest.approx(np.full(8, np.sqrt(14) / 2), abs=1e-6)


def test_the_same_bits_again() -> None:
    mesh = trimesh.creation.torus(1, 0.3, major_sections=12, minor_sections=6)
    one, two = read_part(mesh), read_part(mesh)
    assert [a.tobytes() for a in one.pieces] == [b.tobytes() for b in two.pieces]
    check_is_the_solid(one, mesh)


# Files


@pytest.mark.parametrize("ending", ["obj", "stl", "ply", "off", "glb", "gltf"])
def test_every_format(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"block.{ending}"
    export(box((1, 2, 3)), path)
    part = read_part(path, scale=0.1)
    assert part.name == "block"
    assert part.volume == pytest.approx(6e-3)
    assert part.messages == []


@pytest.mark.parametrize("ending", ["obj", "stl", "ply", "off", "glb", "gltf"])
@pytest.mark.parametrize("damage", ["cut", "noise", "empty"])
def test_broken_files_name_themselves(ending: str, damage: str, tmp_path: Path) -> None:
    path = tmp_path / f"block.{ending}"
    export(l_shape(), path)
    data = path.read_bytes()
    noise = np.random.default_rng(1).bytes(500)
    path.write_bytes({"cut": data[: len(data) // 2], "noise": noise, "empty": b""}[damage])
    with pytest.raises(MeshError, match=f"block.{ending}: "):
        read_part(path)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        read_part(tmp_path / "none.obj")


def test_a_name_that_says_nothing(tmp_path: Path) -> None:
    (tmp_path / "block.txt").write_text("v 0 0 0")
    with pytest.raises(MeshError, match=r"block\.txt: not a mesh file by its name"):
        read_part(tmp_path / "block.txt")


# Meshes that are no solids

CUBE = box((1, 1, 1))


def faces(change: list[Any]) -> Any:
    return trimesh.Trimesh(CUBE.vertices, np.array(change), process=False)


def mirrored() -> Any:
    mesh = l_shape()
    mesh.vertices *= [-1, 1, 1]
    return trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)


def test_inside_out_is_turned() -> None:
    part = read_part(mirrored())
    assert part.messages == ["was inside out: turned its faces outwards"]
    assert moments(part.pieces)[0] == pytest.approx(3)
    assert moments(part.pieces)[1] == pytest.approx([-5 / 6, 5 / 6, 1 / 2])


def test_a_mirroring_scale_keeps_the_outside_outside() -> None:
    part = read_part(l_shape(), scale=(-1, 1, 1))
    assert part.messages == []
    assert moments(part.pieces)[1] == pytest.approx([-5 / 6, 5 / 6, 1 / 2])


def test_faces_turned_the_wrong_way() -> None:
    mixed = [face if i % 3 else face[::-1] for i, face in enumerate(CUBE.faces)]
    part = read_part(faces(mixed))
    assert part.messages == ["turned 4 faces that faced the other way than their neighbours"]
    assert part.volume == pytest.approx(1)


def test_duplicates_are_merged() -> None:
    soup = trimesh.Trimesh(
        CUBE.triangles.reshape(-1, 3), np.arange(36).reshape(-1, 3), process=False
    )
    assert read_part(soup).messages == ["merged 28 duplicate vertices"]
    twice = faces([*CUBE.faces, CUBE.faces[0], np.roll(CUBE.faces[1], 1)])
    assert read_part(twice).messages == ["left out 2 duplicate faces"]
    pointed = faces([*CUBE.faces, [0, 0, 1]])
    assert read_part(pointed).messages == ["left out 1 faces without area"]


def broken(kind: str) -> Any:
    """A mesh with one fault."""
    if kind == "open":
        return faces(CUBE.faces[:-1])
    if kind == "inner wall":
        return faces([*CUBE.faces, *([v, w, x] for v, w, x in [(0, 1, 7), (0, 7, 6)])])
    if kind == "flat":
        return trimesh.Trimesh(CUBE.vertices * [1, 1, 0], CUBE.faces, process=False)
    if kind == "not finite":
        return trimesh.Trimesh(np.where(CUBE.vertices > 0, np.nan, 0), CUBE.faces, process=False)
    if kind == "Klein":
        return klein_bottle()
    inner = box((0.5, 0.5, 0.5), at=(0.4 if kind == "overlapping" else 0, 0, 0))
    return trimesh.util.concatenate([CUBE, inner])


def klein_bottle(n: int = 8) -> Any:
    """A closed surface without inside: a grid whose ends are joined, one pair of them turned."""
    triangles = []

    def at(i: int, j: int) -> int:
        if i == n:
            i, j = 0, -j
        return i * n + j % n

    for i in range(n):
        for j in range(n):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            triangles += [(a, b, c), (a, c, d)]
    vertices = np.random.default_rng(0).random((n * n, 3))
    return trimesh.Trimesh(vertices, triangles, process=False)


@pytest.mark.parametrize(
    ("kind", "says"),
    [
        ("open", "it is not closed: a hole around .* with a rim of 3 edges, 3.414 long"),
        ("inner wall", "it is not manifold: .* remove inner walls"),
        ("flat", "it has no volume"),
        ("not finite", "some of its vertices are not finite numbers"),
        ("Klein", "its faces cannot be given an outer side"),
        ("nested", "one of its parts lies inside another"),
        ("overlapping", "one of its parts lies inside another or overlaps it"),
    ],
)
def test_what_is_no_solid_is_refused(kind: str, says: str) -> None:
    with pytest.raises(MeshError, match=f"^crate: {says}"):
        read_part(broken(kind), name="crate")


@pytest.mark.filterwarnings("ignore::drystone.meshes.MeshWarning")
def test_a_surface_through_itself_is_refused() -> None:
    """A leg folded back through the other: the surface encloses their common part twice."""
    mesh = l_shape()
    mesh.vertices[mesh.vertices[:, 0] > 1.5, 0] = -3.0
    with pytest.raises(MeshError, match="goes through itself"):
        read_part(mesh, surface=False)
    with pytest.raises(ds.SceneError, match=r'block "L": the surface goes through itself at \('):
        ds.Scene(dimension=3).add_mesh(mesh, name="L", surface=True)


def test_the_largest_hole_is_named() -> None:
    """Two holes: a triangle of one face, and the whole of the opposite one."""
    opposite = CUBE.face_normals[:, 0] > 0.5
    one_of = np.flatnonzero(CUBE.face_normals[:, 0] < -0.5)[:1]
    kept = np.delete(CUBE.faces, [*np.flatnonzero(opposite), *one_of], axis=0)
    with pytest.raises(
        MeshError, match=r"2 holes, the largest around \(0.5, 0, 0\) .* 4 edges, 4 "
    ):
        read_part(faces(kept))


@pytest.mark.parametrize("scale", [0.0, float("nan"), (1, 1, 0)])
def test_scales_that_cannot_be(scale: Any) -> None:
    with pytest.raises(MeshError, match="scale must be finite"):
        read_part(CUBE, scale=scale)


# Meshes that are too much


def test_too_many_pieces_says_what_to_do() -> None:
    mesh = trimesh.creation.torus(1, 0.3, major_sections=16, minor_sections=8)
    with pytest.raises(MeshError, match="more than 10 convex pieces: let it be simplified"):
        read_part(mesh, max_pieces=10)
    (piece,) = read_part(mesh, hull=True).pieces
    assert ConvexHull(piece).volume == pytest.approx(mesh.convex_hull.volume)


@pytest.mark.parametrize("kind", ["ball", "ring"])
def test_a_large_smooth_mesh_is_refused_soon(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """From a sample: neither its edges nor its hull are looked for."""
    for work in ("repaired", "hull_volume", "Decomposition"):
        monkeypatch.delattr(f"drystone.meshes.part.{work}")
    if kind == "ball":
        mesh = trimesh.creation.icosphere(7)
    else:
        mesh = trimesh.creation.torus(1, 0.3, major_sections=500, minor_sections=320)
    assert len(mesh.faces) >= 300_000
    with pytest.raises(
        MeshError, match="triangles lie in more than 4000 planes: let them be simplified"
    ):
        read_part(mesh, surface=False)


def test_two_hundred_thousand_triangles_of_a_box_are_a_box() -> None:
    mesh = CUBE
    for _ in range(7):
        mesh = mesh.subdivide()
    part = read_part(mesh)
    assert part.volume == pytest.approx(1)
    assert [len(piece) for piece in part.pieces] == [8]


# In a scene


def test_a_scene_takes_a_mesh(tmp_path: Path) -> None:
    l_shape().export(tmp_path / "ell.stl")
    scene = ds.Scene(dimension=3, friction=0.6)
    scene.add_box((0, 0, -0.5), (20, 20, 1), name="ground", fixed=True)
    half = np.sqrt(0.5)
    name = scene.add_mesh(
        tmp_path / "ell.stl", (5, 0, 0), (half, 0, 0, half), 2, name="ell", density=10.0
    )
    body = scene.body(name)
    # Twice as large, turned a quarter about z, then moved.
    assert body.mass == pytest.approx(240)
    assert body.centroid == pytest.approx((5 - 10 / 6, 10 / 6, 1))
    assert len(body.pieces) == 2
    assert ds.check(scene).stable


def test_inertia_in_a_scene_is_the_meshs() -> None:
    mesh = trimesh.boolean.difference([box((1, 2, 3)), box((2, 1, 0.5), at=(0.5, 0.8, 1))])
    scene = ds.Scene(dimension=3)
    body = scene.body(scene.add_mesh(mesh, density=2.0))
    assert body.mass == pytest.approx(2 * mesh.volume)
    assert body.centroid == pytest.approx(tuple(mesh.center_mass))
    assert body.inertia == pytest.approx(2 * mesh.moment_inertia, abs=1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_a_scene_takes_every_union(seed: int) -> None:
    """Its own check that pieces do not overlap passes."""
    rng = np.random.default_rng(seed)
    boxes = [
        box(tuple(rng.integers(1, 4, 3) * 1.0), tuple(rng.integers(-1, 2, 3) * 0.5)) for _ in "abcd"
    ]
    mesh = trimesh.boolean.union(boxes)
    scene = ds.Scene(dimension=3)
    assert scene.body(scene.add_mesh(mesh)).mass == pytest.approx(mesh.volume)


def test_what_is_mended_is_a_warning() -> None:
    scene = ds.Scene(dimension=3)
    with pytest.warns(MeshWarning, match="ell: was inside out"):
        scene.add_mesh(mirrored(), name="ell")


# glTF


def test_a_gltf_with_nodes_is_read_as_it_stands(tmp_path: Path) -> None:
    """Written byte by byte: a node turns, a node in it moves and scales the mesh of 2 x 3 x 4."""
    corners = np.array([(x, y, z) for x in (0, 2) for y in (0, 3) for z in (0, 4)], dtype="<f4")
    triangles = trimesh.creation.box().faces.astype("<u2")
    data = corners.tobytes() + triangles.tobytes()
    half = float(np.sqrt(0.5))
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        # A quaternion x, y, z, w: a quarter turn about z, (x, y, z) becomes (-y, x, z).
        "nodes": [
            {"rotation": [0, 0, half, half], "children": [1]},
            {"translation": [10, 0, 0], "scale": [0.5, 1, 1], "mesh": 0},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": 8,
                "type": "VEC3",
                "min": [0, 0, 0],
                "max": [2, 3, 4],
            },
            {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": corners.nbytes},
            {"buffer": 0, "byteOffset": corners.nbytes, "byteLength": triangles.nbytes},
        ],
        "buffers": [{"byteLength": len(data), "uri": "block.bin"}],
    }
    (tmp_path / "block.bin").write_bytes(data)
    (tmp_path / "block.gltf").write_text(json.dumps(document))
    text = json.dumps({**document, "buffers": [{"byteLength": len(data)}]}).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    chunks += struct.pack("<II", len(data), 0x004E4942) + data
    header = struct.pack("<III", 0x46546C67, 2, 12 + len(chunks))
    (tmp_path / "block.glb").write_bytes(header + chunks)
    for file in ("block.gltf", "block.glb"):
        scene = ds.Scene(dimension=3)
        # Its unit is the metre, unless the file was written with another.
        body = scene.body(scene.add_mesh(tmp_path / file, scale=0.1, density=1000))
        points = np.concatenate([piece.vertices for piece in body.pieces]) + body.centroid
        assert points.min(axis=0) == pytest.approx([-0.3, 1.0, 0.0], abs=1e-7)
        assert points.max(axis=0) == pytest.approx([0.0, 1.1, 0.4], abs=1e-7)
        assert body.mass == pytest.approx(1000 * 0.1 * 0.3 * 0.4, rel=1e-6)
        imported = ds.imports.load(tmp_path / file, scale=0.1, up="y")
        (piece,) = imported.bodies[0].pieces
        # What was up along y is up along z: (x, y, z) becomes (x, -z, y).
        assert piece.min(axis=0) == pytest.approx([-0.3, -0.4, 1.0], abs=1e-7)
        assert piece.max(axis=0) == pytest.approx([0.0, 0.0, 1.1], abs=1e-7)
