"""Mesh files with several objects: a body for each, or one for all."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import trimesh
from trimesh.transformations import translation_matrix

import drystone as ds
from drystone.imports import FormatError, load
from drystone.meshes import MeshError

WALL = {"lower": (0.0, 0.0), "middle": (0.2, 1.0), "overhanging": (0.9, 2.0)}


def obj(places: dict[str, tuple[float, float]], keyword: str = "o", relative: bool = False) -> str:
    """Unit cubes of quads at (x, z), as a file of objects or groups."""
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    text, count = "# a wall\nmtllib none.mtl\n", 0
    for name, (x, z) in places.items():
        text += f"{keyword} {name}\n"
        text += "".join(f"v {x + i} {j} {z + k}\n" for i in (0, 1) for j in (0, 1) for k in (0, 1))
        for quad in quads:
            numbers = [k - 8 if relative else count + 1 + k for k in quad]
            text += "f " + " ".join(f"{k}//1" for k in numbers) + "\n"
        count += 8
    return text


@pytest.mark.parametrize("keyword", ["o", "g"])
@pytest.mark.parametrize("relative", [False, True])
def test_each_object_is_a_body(keyword: str, relative: bool, tmp_path: Path) -> None:
    (tmp_path / "wall.obj").write_text(obj(WALL, keyword, relative))
    imported = load(tmp_path / "wall.obj", ground=True)
    assert imported.format == "mesh of objects"
    assert [body.name for body in imported.bodies] == [*WALL, "ground"]
    assert (imported.messages, imported.left_out) == ([], [])
    verdict = ds.check(imported.scene)
    # The top block's middle is .7 beyond the edge of the one below it.
    assert verdict.falling == ("overhanging",)
    assert ds.check(load(tmp_path / "wall.obj", ground=True, split="none").scene).stable


def test_fixed_density_and_friction_by_name(tmp_path: Path) -> None:
    (tmp_path / "wall.obj").write_text(obj(WALL))
    imported = load(
        tmp_path / "wall.obj",
        fixed=["lower", "overhanging"],
        density={"middle": 2400.0},
        friction={"middle": 0.7},
    )
    assert [body.fixed for body in imported.bodies] == [True, False, True]
    bodies = [imported.scene.body(name) for name in WALL]
    assert [body.friction for body in bodies] == [0.5, 0.7, 0.5]
    assert bodies[1].mass == pytest.approx(2400.0)
    for wrong in ({"density": {"top": 1.0}}, {"friction": {"top": 1.0}}, {"fixed": ["top"]}):
        with pytest.raises(FormatError, match="no body is called 'top': there are lower, middle"):
            load(tmp_path / "wall.obj", **wrong)


def test_names_are_unique(tmp_path: Path) -> None:
    text = obj({"stone": (0.0, 0.0)}) + obj({"stone": (0.0, 1.0)}, relative=True)
    (tmp_path / "wall.obj").write_text(text)
    imported = load(tmp_path / "wall.obj")
    assert imported.scene.names == ["stone", "stone 2"]
    assert imported.messages == ["stone: named twice, the second is called stone 2"]


def test_add_mesh_makes_one_body(tmp_path: Path) -> None:
    (tmp_path / "wall.obj").write_text(obj(WALL))
    scene = ds.Scene(dimension=3)
    with pytest.warns(ds.meshes.MeshWarning, match="its 3 separate parts are one rigid body"):
        assert scene.add_mesh(tmp_path / "wall.obj", name="wall") == "wall"
    assert len(scene) == 1


def test_groups_of_an_object_are_one_body_unless_asked_for(tmp_path: Path) -> None:
    (tmp_path / "wall.obj").write_text("o wall\n" + obj(WALL, "g"))
    imported = load(tmp_path / "wall.obj")
    assert imported.scene.names == ["wall"]
    assert "its 3 groups are one rigid body: split='groups'" in imported.messages[0]
    assert load(tmp_path / "wall.obj", split="groups").scene.names == [*WALL]
    assert load(tmp_path / "wall.obj", split="objects").scene.names == ["wall"]


def test_groups_that_are_parts_of_one_surface_are_one_body(tmp_path: Path) -> None:
    lines = obj({"front": (0.0, 0.0)}, "g").splitlines()
    lines.insert(len(lines) - 2, "g back")
    (tmp_path / "block.obj").write_text("\n".join(lines))
    imported = load(tmp_path / "block.obj")
    assert imported.scene.names == ["block"]
    assert imported.messages == [
        "block.obj: its 2 groups are parts of one surface: taken as one body"
    ]
    with pytest.raises(MeshError, match=r"block\.obj: object 'front': it is not closed"):
        load(tmp_path / "block.obj", split="groups")


def test_an_object_that_is_no_solid_is_named(tmp_path: Path) -> None:
    text = obj(WALL).rsplit("f ", 1)[0] + "o curve\nv 0 0 0\nl 1 2\n"
    (tmp_path / "wall.obj").write_text(text)
    with pytest.raises(MeshError, match=r"wall\.obj: object 'overhanging': it is not closed"):
        load(tmp_path / "wall.obj")
    (tmp_path / "wall.obj").write_text(obj(WALL) + "o curve\nv 0 0 0\nl 1 2\n")
    (left,) = load(tmp_path / "wall.obj").left_out
    assert (left.what, left.why) == ("object curve", "it has no faces")


@pytest.mark.parametrize("line", ["f 1 2", "f 1 2 0", "f 1 a 3", "v 0 0", "v 0 0 zero"])
def test_a_damaged_line_is_named(line: str, tmp_path: Path) -> None:
    (tmp_path / "wall.obj").write_text(obj(WALL) + line + "\n")
    with pytest.raises(MeshError, match=rf"wall\.obj: cannot be read as OBJ: line 48 is '{line}'"):
        load(tmp_path / "wall.obj")


@pytest.mark.parametrize("ending", ["glb", "gltf"])
def test_each_node_of_a_scene_is_a_body(ending: str, tmp_path: Path) -> None:
    scene = trimesh.Scene()
    for number, name in enumerate(["stone 10", "stone 2"]):
        place = translation_matrix([0, 0, number])
        scene.add_geometry(trimesh.creation.box(), node_name=name, transform=place)
    (tmp_path / "parts").mkdir()
    scene.export(str(tmp_path / "parts" / f"wall.{ending}"))
    imported = load(tmp_path / "parts" / f"wall.{ending}")
    assert imported.scene.names == ["stone 2", "stone 10"]
    assert imported.scene.body("stone 2").centroid == pytest.approx((0, 0, 1))
    one = load(tmp_path / "parts" / f"wall.{ending}", split="none")
    assert one.scene.names == ["wall"]
    with pytest.raises(MeshError, match="only OBJ files have groups"):
        load(tmp_path / "parts" / f"wall.{ending}", split="groups")


def test_from_the_command_line(cli, tmp_path: Path) -> None:
    (tmp_path / "wall.obj").write_text(obj(WALL))
    ran = cli("import", tmp_path / "wall.obj", "--json")
    assert [body["name"] for body in json.loads(ran.out)["bodies"]] == [*WALL]
    ran = cli("import", tmp_path / "wall.obj", "--split", "none", "--json")
    assert [body["name"] for body in json.loads(ran.out)["bodies"]] == ["wall"]


def test_split_is_for_mesh_files(tmp_path: Path) -> None:
    (tmp_path / "wall.obj").write_text(obj(WALL))
    with pytest.raises(FormatError, match="split is for one mesh file"):
        load(tmp_path, split="none")
    with pytest.raises(MeshError, match="split must be one of objects, groups, none"):
        load(tmp_path / "wall.obj", split="shells")


def test_what_is_done_to_many_bodies_is_said_once(tmp_path: Path) -> None:
    stones = {f"stone {k}": (0.0, float(k)) for k in range(6)}
    doubled = ""
    for line in obj(stones).splitlines():
        doubled += line + "\n" + (line + "\n" if line.startswith("f ") else "")
    (tmp_path / "wall.obj").write_text(doubled)
    assert load(tmp_path / "wall.obj").messages == [
        "stone 0 and 5 others: left out 12 duplicate faces"
    ]
