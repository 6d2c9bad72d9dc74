"""Assemblies of other tools become scenes, and nothing is left out in silence."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

import drystone as ds
from conftest import Ran
from drystone.imports import FormatError, Imported, load

Cli = Callable[..., Ran]


def corners(imported: Imported, name: str) -> list[list[float]]:
    """All corners of a body, sorted."""
    body = next(body for body in imported.bodies if body.name == name)
    points = np.concatenate(body.pieces).round(9) + 0.0
    return sorted(map(list, points.tolist()))


def box_at(
    center: tuple[float, float, float], size: tuple[float, float, float]
) -> list[list[float]]:
    """The corners of a box, sorted."""
    signs = np.array(list(np.ndindex(2, 2, 2))) - 0.5
    return sorted(map(list, (np.array(center) + signs * size).round(9).tolist()))


def bodies(imported: Imported) -> dict[str, Any]:
    return {body.name: body for body in imported.bodies}


def left_out(imported: Imported) -> dict[str, str]:
    return {out.what: out.why for out in imported.left_out}


# COMPAS


def compas_block(size: tuple[float, float, float], center: tuple[float, float, float]) -> Any:
    """A block as compas_assembly writes it: a mesh of six quadrilaterals."""
    signs = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    number = {corner: i for i, corner in enumerate(signs)}
    points = np.array(center) + (np.array(signs) - 0.5) * size
    quads = [
        [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)],
        [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
        [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)],
        [(0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)],
        [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)],
        [(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)],
    ]
    return {
        "dtype": "compas_assembly.datastructures/Block",
        "data": {
            "attributes": {"name": None},
            "default_vertex_attributes": {"x": 0.0, "y": 0.0, "z": 0.0},
            "vertex": {
                str(i): dict(zip("xyz", point, strict=True))
                for i, point in enumerate(points.tolist())
            },
            "face": {str(i): [number[c] for c in quad] for i, quad in enumerate(quads)},
        },
    }


def compas_assembly() -> Any:
    """Two cubes on each other; the lower one is a support."""
    return {
        "dtype": "compas_assembly.datastructures/Assembly",
        "data": {
            "attributes": {"name": "Assembly"},
            "graph": {
                "dtype": "compas.datastructures/Graph",
                "data": {
                    "node": {
                        "0": {"block": compas_block((1, 1, 1), (0, 0, 0.5)), "is_support": True},
                        "1": {"block": compas_block((1, 1, 2), (0, 0, 2)), "density": 3.5},
                    },
                    "edge": {"0": {"1": {"interfaces": []}}},
                },
            },
        },
    }


@pytest.fixture
def assembly(tmp_path: Path) -> Path:
    path = tmp_path / "assembly.json"
    path.write_text(json.dumps(compas_assembly()))
    return path


def test_compas(assembly: Path) -> None:
    imported = load(assembly)
    assert imported.format == "COMPAS assembly"
    assert corners(imported, "0") == box_at((0, 0, 0.5), (1, 1, 1))
    assert corners(imported, "1") == box_at((0, 0, 2), (1, 1, 2))
    assert [body.fixed for body in imported.bodies] == [True, False]
    assert [body.density for body in imported.bodies] == [1000.0, 3.5]
    assert left_out(imported) == {"1 edges with interfaces": "contacts are found anew"}
    assert imported.messages == []
    assert imported.scene.names == ["0", "1"]
    assert imported.scene.body("1").mass == pytest.approx(7.0)
    assert ds.check(imported.scene).stable


def compas_arch(voussoirs: int, thickness: float) -> Any:
    """A semicircular arch of inner radius 5, 0.5 deep; the outer two voussoirs are supports."""

    def voussoir(number: int) -> Any:
        block = compas_block((1, 1, 1), (0, 0, 0))
        vertices = list(block["data"]["vertex"].values())
        for vertex, (i, j, k) in zip(vertices, np.ndindex(2, 2, 2), strict=True):
            angle = np.pi * (1 - (number + i) / voussoirs)
            radius = 5 + thickness * k
            point = (radius * np.cos(angle), 0.5 * j, radius * np.sin(angle))
            vertex.update(zip("xyz", point, strict=True))
        return {"block": block, "is_support": number in (0, voussoirs - 1)}

    nodes = {str(number): voussoir(number) for number in range(voussoirs)}
    graph = {"node": nodes}
    return {"dtype": "compas_assembly.datastructures/Assembly", "data": {"graph": graph}}


@pytest.mark.parametrize(("thickness", "stands"), [(0.5, True), (0.3, False)])
def test_compas_arch(thickness: float, stands: bool, tmp_path: Path) -> None:
    """compas_cra's example: 20 voussoirs, height 5, span 10, thickness 0.5, mu 0.7 stands.

    Fixed up to 9 degrees above the springing, it may be thinner than a half circle, whose limit is
    0.1075 of the mean radius: 0.5 m are 0.095 of it. But 0.3 m, 0.058 of it, are too thin.
    """
    path = tmp_path / "arch.json"
    path.write_text(json.dumps(compas_arch(20, thickness)))
    scene = load(path, friction=0.7).scene
    assert len(scene.contacts) == 19 * 4
    for cone in ("inscribed", "circumscribed"):
        assert ds.check(scene, cone=cone).stable is stands


def test_compas_1(tmp_path: Path) -> None:
    """The older spelling of the same, with bare graphs."""
    old = compas_assembly()
    graph = old["data"]["graph"]["data"]
    for node in graph["node"].values():
        block = node["block"]
        node["block"] = {"datatype": block["dtype"], "value": block["data"]}
    text = {"datatype": old["dtype"], "value": {"graph": graph}}
    (tmp_path / "old.json").write_text(json.dumps(text))
    assert corners(load(tmp_path / "old.json"), "1") == box_at((0, 0, 2), (1, 1, 2))


@pytest.mark.parametrize(
    ("damage", "says"),
    [
        (lambda d: d["node"].clear(), "no nodes"),
        (lambda d: d["node"]["1"]["block"]["data"].pop("vertex"), "block 1 has no vertices"),
        (lambda d: d["node"]["1"]["block"]["data"].pop("face"), "block 1 has no faces"),
        (lambda d: d["node"]["1"]["block"]["data"]["face"].pop("0"), "block 1: it is not closed"),
        (
            lambda d: d["node"]["1"]["block"]["data"]["face"].update({"0": [1, 99, 3]}),
            "face 0 uses",
        ),
        (lambda d: d["node"]["1"]["block"]["data"]["vertex"]["0"].update(x="a"), "finite number"),
        (lambda d: d["node"]["1"].update(density=float("nan")), "density must be a finite"),
    ],
)
def test_broken_assemblies(damage: Callable[[Any], Any], says: str, tmp_path: Path) -> None:
    data = compas_assembly()
    damage(data["data"]["graph"]["data"])
    path = tmp_path / "broken.json"
    path.write_text(json.dumps(data))
    with pytest.raises(ds.SceneError, match=rf"broken\.json: .*{says}"):
        load(path)


# What holds for every format


def test_millimetres_and_y_up(assembly: Path) -> None:
    imported = load(assembly, scale=0.001, up="y")
    # x, y, z of the file are x, -z, y of the scene.
    assert corners(imported, "1") == box_at((0, -0.002, 0), (0.001, 0.002, 0.001))


def test_options(assembly: Path) -> None:
    imported = load(
        assembly, density=2.0, friction=0.3, fixed=["1"], ground=True, gravity=(0, 0, -1)
    )
    assert [body.fixed for body in imported.bodies] == [True, True, True]
    assert imported.scene.body("1").mass == pytest.approx(4.0)
    assert imported.scene.gravity == (0, 0, -1)
    assert imported.scene.friction == 0.3
    low, high = (
        np.ptp(np.array(corners(imported, "ground")), axis=0),
        corners(imported, "ground")[-1][2],
    )
    assert low.tolist() == [4, 4, 1.5]  # half the height of 3 beyond them all round
    assert high == 0


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"fixed": ["7"]}, "no body is called '7': there are 0, 1"),
        ({"fixed": ["GROUND"], "ground": True}, "did you mean 'ground'"),
        ({"up": "x"}, "up must be"),
        ({"scale": 0.0}, "scale must be"),
    ],
)
def test_options_that_cannot_be(assembly: Path, options: Any, says: str) -> None:
    with pytest.raises(FormatError, match=says):
        load(assembly, **options)


@pytest.mark.parametrize(
    ("name", "text", "says"),
    [
        ("a.json", "{", "not a JSON file"),
        ("a.json", "[" * 100_000, "not a JSON file"),
        ("a.json", "{}", "neither a COMPAS assembly nor a manifest"),
        ("a.json", '{"bodies": []}', "a scene of drystone already"),
        ("a.xml", "<mujoco>", "not an XML file"),
        ("a.xml", "<sdf/>", "neither <mujoco> nor <robot>"),
        ("a.xml", '<!DOCTYPE x [<!ENTITY y "z">]><mujoco/>', "document type"),
        ("a.xml", "<a>" * 200 + "</a>" * 200, "more than 100 deep"),
        ("a.iges", "", "not known by its name"),
        ("a.xml", "<mujoco/>", "nothing in it can be taken"),
    ],
)
def test_files_that_are_something_else(name: str, text: str, says: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(FormatError, match=says) as caught:
        load(tmp_path / name)
    assert str(tmp_path / name) in str(caught.value)


def test_one_mesh(tmp_path: Path) -> None:
    trimesh.creation.box((1, 2, 3)).export(tmp_path / "stone.stl")
    imported = load(tmp_path / "stone.stl")
    assert (imported.format, list(bodies(imported))) == ("mesh", ["stone"])


# Folders


@pytest.fixture
def parts(tmp_path: Path) -> Path:
    """Three boxes in their own frames."""
    for name in ("0", "2", "10"):
        trimesh.creation.box((1, 2, 3)).export(tmp_path / f"{name}.obj")
    return tmp_path


def test_a_folder_alone(parts: Path) -> None:
    trimesh.creation.box().export(parts / "2.obj")
    (parts / "2.obj").write_text((parts / "2.obj").read_text().replace("0.5", "5.5"))
    (parts / "10.obj").unlink()
    imported = load(parts, fixed=["0"])
    assert list(bodies(imported)) == ["0", "2"]


def test_a_folder_of_asap(parts: Path) -> None:
    """Final states of three or six numbers, as its config.json has them."""
    config = {
        "0": {"initial_state": [9, 9, 9], "final_state": [5, 0, 0]},
        "2": {"final_state": [0, 10, 0, 0, 0, np.pi / 2]},
        "10": {"final_state": [0, 0, 20, np.pi / 2, 0, np.pi / 2]},
        "gone": {"final_state": [0, 0, 0]},
    }
    (parts / "config.json").write_text(json.dumps(config))
    imported = load(parts)
    assert list(bodies(imported)) == ["0", "2", "10"]
    assert corners(imported, "0") == box_at((5, 0, 0), (1, 2, 3))
    assert corners(imported, "2") == box_at((0, 10, 0), (2, 1, 3))
    # About x first: (1, 2, 3) is (1, 3, 2), then about z (3, 1, 2).
    assert corners(imported, "10") == box_at((0, 0, 20), (3, 1, 2))
    assert left_out(imported) == {"part gone of config.json": "there is no mesh of that name"}


def test_a_manifest(parts: Path) -> None:
    manifest = {
        "parts": [
            {"name": "base", "file": "0.obj", "fixed": True, "friction": 0.7},
            {
                "name": "beam",
                "file": "0.obj",
                "position": [0, 0, 10],
                "orientation": [np.sqrt(0.5), 0, np.sqrt(0.5), 0],
                "density": 7.0,
                "scale": 2,
            },
        ],
        "author": "someone",
    }
    (parts / "manifest.json").write_text(json.dumps(manifest))
    for path in (parts, parts / "manifest.json"):
        imported = load(path)
        base, beam = imported.bodies
        assert (base.name, base.fixed, base.friction) == ("base", True, 0.7)
        assert (beam.density, beam.friction, beam.volume) == (7.0, None, pytest.approx(48))
        assert corners(imported, "beam") == box_at((0, 0, 10), (6, 4, 2))
        assert left_out(imported) == {"'author' in manifest.json": "no field of a manifest"}


@pytest.mark.parametrize(
    ("part", "says"),
    [
        ({}, "part 0 must be an object with a file"),
        ({"name": "x"}, "file is needed"),
        ({"file": "0.obj", "colour": 1}, "unknown field 'colour'"),
        ({"file": "0.obj", "densty": 1}, r"'densty' \(did you mean 'density'\?\)"),
        ({"file": "0.obj", "position": [0, 0]}, "position must be 3 numbers"),
        ({"file": "0.obj", "orientation": [0, 0, 0, 0]}, "orientation must be a quaternion"),
        ({"file": "0.obj", "density": "heavy"}, "density must be a finite number"),
        ({"file": "0.obj", "fixed": 1}, "fixed must be true or false"),
    ],
)
def test_broken_manifests(parts: Path, part: Any, says: str) -> None:
    (parts / "manifest.json").write_text(json.dumps({"parts": [part]}))
    with pytest.raises(FormatError, match=rf"manifest\.json: .*{says}"):
        load(parts)


def test_a_folder_without_parts(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="no mesh files in it"):
        load(tmp_path)


def test_a_manifest_with_a_file_that_is_not_there(tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_text('{"parts": [{"file": "brik.obj"}]}')
    says = r"manifest\.json: part 0: there is no file 'brik.obj' beside the manifest"
    with pytest.raises(FormatError, match=f"{says}$"):
        load(tmp_path)
    trimesh.creation.box().export(tmp_path / "brick.obj")
    with pytest.raises(FormatError, match=rf"{says} \(did you mean 'brick.obj'\?\)"):
        load(tmp_path)


# MJCF

ONLY = "only bodies made of boxes, meshes and planes are taken"

MJCF = """
<mujoco>
  <compiler angle="degree" meshdir="meshes"/>
  <option gravity="0 0 -5"/>
  <default>
    <geom friction="0.8 0.1 0.1" density="500"/>
    <default class="heavy"><geom density="2000"/></default>
  </default>
  <asset><mesh name="ell" file="ell.obj" scale="2 2 2"/></asset>
  <worldbody>
    <light pos="0 0 9"/>
    <flexcomp name="cloth"/>
    <geom name="floor" type="plane" size="0 0 1"/>
    <geom name="step" type="box" size="1 1 1" pos="-4 0 1"/>
    <body name="crate" pos="0 0 1">
      <freejoint/>
      <geom type="box" size="0.5 0.5 1" euler="0 90 0"/>
      <geom type="sphere" size="1"/>
      <body name="lid" pos="0 0 0.75" childclass="heavy"><geom type="box" size="1 .5 .25"/></body>
    </body>
    <body name="piece" pos="4 0 0"><freejoint/><geom type="mesh" mesh="ell" mass="3"/></body>
    <body name="door" pos="0 9 0.5"><joint type="hinge"/><geom type="box" size=".5 .5 .5"/></body>
    <body name="wall" pos="0 20 1"><geom type="box" size="1 1 1"/></body>
    <body name="ghost"><geom type="box" size="1 1 1" contype="0" conaffinity="0"/></body>
  </worldbody>
  <actuator><motor joint="x"/><motor joint="y"/></actuator>
</mujoco>
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    (tmp_path / "meshes").mkdir()
    ell = trimesh.util.concatenate(
        [
            trimesh.creation.box(bounds=[[0, 0, 0], [2, 1, 1]]),
            trimesh.creation.box(bounds=[[0, 1, 0], [1, 2, 1]]),
        ]
    )
    ell.export(tmp_path / "meshes" / "ell.obj")
    (tmp_path / "model.xml").write_text(MJCF)
    return tmp_path / "model.xml"


def test_mjcf(model: Path) -> None:
    with pytest.raises(FormatError, match=r"door hangs on a hinge joint.*joints='fixed'"):
        load(model)
    imported = load(model, joints="fixed")
    found = bodies(imported)
    assert list(found) == ["step", "crate", "piece", "door", "wall", "floor"]
    fixed = {"step", "door", "wall", "floor"}
    assert {name for name, body in found.items() if body.fixed} == fixed
    assert {body.friction for body in found.values()} == {0.8}
    assert corners(imported, "step") == box_at((-4, 0, 1), (2, 2, 2))
    crate = sorted(box_at((0, 0, 1), (2, 1, 1)) + box_at((0, 0, 1.75), (2, 1, 0.5)))
    assert corners(imported, "crate") == crate
    # Two cubic metres of 500 kg/m^3, one of 2000, and a ball, which weighs although it is left out.
    ball = 500 * 4 / 3 * np.pi
    assert found["crate"].mass == pytest.approx(3000 + ball)
    own = imported.scene.body("crate")
    assert own.mass == pytest.approx(3000 + ball)
    high = (1000 * 1 + 2000 * 1.75 + ball * 1) / (3000 + ball)
    assert own.center_of_mass == pytest.approx((0, 0, high))
    # The hull of an L is a box without a corner: 8 (4 - 1 / 2).
    assert found["piece"].volume == pytest.approx(8 * 3.5)
    assert found["piece"].mass == pytest.approx(3)
    # It weighs as the L does: its centre of mass is that of three cubes of two metres.
    assert imported.scene.body("piece").center_of_mass == pytest.approx((4 + 10 / 6, 10 / 6, 1))
    assert imported.scene.gravity == (0, 0, -5)
    top = max(point[2] for point in corners(imported, "floor"))
    assert top == 0
    assert left_out(imported) == {
        "actuator (2)": ONLY,
        "sphere geom of crate 2": ONLY,
        "flexcomp in the world": ONLY,
        "box geom of ghost 1": "it collides with nothing",
        "body ghost": "it has no box and no mesh that collides",
    }
    assert imported.messages == [
        "door: its hinge joint is welded, to the world",
        "friction: the smaller coefficient of two bodies counts, in MuJoCo the larger",
        "floor: a plane, taken as a fixed box under the others",
        "the scene lacks 1 of the file's bodies: body ghost",
    ]


@pytest.mark.parametrize(
    ("turn", "size"),
    [
        ('quat="0.7071067811865476 0 0 0.7071067811865476"', (2, 1, 3)),
        ('axisangle="0 0 2 90"', (2, 1, 3)),
        ('euler="90 0 90"', (3, 1, 2)),
        ('xyaxes="0 1 0 -1 0 0"', (2, 1, 3)),
        ('zaxis="1 0 0"', (3, 2, 1)),
    ],
)
def test_mjcf_orientations(turn: str, size: tuple[float, float, float], tmp_path: Path) -> None:
    """A box of (1, 2, 3). Euler angles turn along: about x, then about the box's own z."""
    if turn.startswith("euler"):
        size = (2, 3, 1)  # Rx Rz of a box: its z edge ends along y, its x along z
    geom = f'<geom name="a" type="box" size=".5 1 1.5" {turn}/>'
    path = tmp_path / "a.xml"
    path.write_text(f"<mujoco><worldbody>{geom}</worldbody></mujoco>")
    assert corners(load(path), "a") == box_at((0, 0, 0), size)


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ('<geom type="box" size="1 1"/>', "needs 3 numbers"),
        ('<geom type="box" size="1 -1 1"/>', "size must be positive"),
        ('<geom type="mesh" mesh="none"/>', "no mesh is called 'none'"),
        ('<geom type="box" size="1 1 1" class="none"/>', "no default class is called 'none'"),
        ('<geom type="box" size="1 1 1" quat="0 0 0 0"/>', "orientation"),
        ('<geom type="box" size="1 1 1" mass="-1"/>', "mass must not be negative"),
        ('<geom type="box" size="1 1 nan"/>', "needs finite numbers"),
        ('<include file="none.xml"/>', "includes 'none.xml', and there is no such file"),
        ('<include file="a.xml"/>', "as file number 100, or itself"),
        ('<geom type="mesh" mesh="cone"/>', "builtin mesh 'cone' is not known"),
        ('<body><freejoint/><geom type="box" size="1 1 1" mass="0"/></body>', "weighs nothing"),
    ],
)
def test_broken_mjcf(body: str, says: str, tmp_path: Path) -> None:
    path = tmp_path / "a.xml"
    asset = '<asset><mesh name="cone" builtin="cone" params="8 1"/></asset>'
    path.write_text(f"<mujoco>{asset}<worldbody>{body}</worldbody></mujoco>")
    with pytest.raises(FormatError, match=says) as caught:
        load(path)
    assert str(path) in str(caught.value)


# URDF

URDF = """
<robot name="table">
  <material name="red"/>
  <link name="world"/>
  <link name="base">
    <collision><origin xyz="0 0 .5"/><geometry><box size="1 1 1"/></geometry></collision>
  </link>
  <link name="top">
    <inertial><mass value="7"/></inertial>
    <collision><geometry><box size="2 1 .5"/></geometry></collision>
    <collision><geometry><cylinder radius="1" length="1"/></geometry></collision>
  </link>
  <link name="foot">
    <inertial><mass value="1"/></inertial>
    <collision>
      <origin rpy="0 1.5707963267948966 0"/>
      <geometry><mesh filename="package://table/meshes/foot.stl" scale="1 1 2"/></geometry>
    </collision>
  </link>
  <link name="arm"><visual/></link>
  <joint name="a" type="fixed"><parent link="world"/><child link="base"/></joint>
  <joint name="b" type="floating">
    <parent link="base"/><child link="top"/><origin xyz="0 0 3"/>
  </joint>
  <joint name="c" type="fixed"><parent link="top"/><child link="foot"/><origin xyz="0 0 1"/></joint>
  <joint name="d" type="revolute"><parent link="top"/><child link="arm"/></joint>
  <transmission/>
</robot>
"""


def test_urdf(tmp_path: Path) -> None:
    (tmp_path / "meshes").mkdir()
    (tmp_path / "urdf").mkdir()
    trimesh.creation.box((1, 1, 1)).export(tmp_path / "meshes" / "foot.stl")
    (tmp_path / "urdf" / "table.urdf").write_text(URDF)
    with pytest.raises(FormatError, match="arm hangs on a revolute joint"):
        load(tmp_path / "urdf" / "table.urdf")
    imported = load(tmp_path / "urdf" / "table.urdf", joints="fixed")
    base, top = imported.bodies
    assert (base.name, base.fixed, base.density) == ("base", True, 1000.0)
    assert corners(imported, "base") == box_at((0, 0, 0.5), (1, 1, 1))
    assert (top.name, top.fixed) == ("top", False)
    assert corners(imported, "top") == sorted(
        box_at((0, 0, 3), (2, 1, 0.5)) + box_at((0, 0, 4), (2, 1, 1))
    )
    assert top.mass == pytest.approx(8)
    # 7 kg where the link stands, 1 kg a metre above it.
    assert imported.scene.body("top").center_of_mass == pytest.approx((0, 0, 3 + 1 / 8))
    assert left_out(imported) == {
        "cylinder, collision 1 of top": "only boxes and meshes are taken",
        "transmission (1)": "only links and fixed joints are taken",
    }
    assert imported.messages == ["arm: its revolute joint is welded, to top"]


@pytest.mark.parametrize(
    ("inside", "says"),
    [
        ("", "it has no links"),
        ("<link/>", "a link has no name"),
        ('<link name="a"/><joint><parent link="a"/><child link="b"/></joint>', "no child link 'b'"),
        (
            '<link name="a"/><link name="b"/><joint><parent link="a"/><child link="b"/></joint>'
            '<joint><parent link="b"/><child link="a"/></joint>',
            "run in a circle",
        ),
        ('<link name="a"><collision/></link>', "has no geometry"),
        (
            '<link name="a"><collision><geometry><mesh filename="package://x/no.stl"/></geometry>'
            "</collision></link>",
            "neither beside it nor in a folder above",
        ),
    ],
)
def test_broken_urdf(inside: str, says: str, tmp_path: Path) -> None:
    path = tmp_path / "a.urdf"
    path.write_text(f"<robot>{inside}</robot>")
    with pytest.raises(FormatError, match=says) as caught:
        load(path)
    assert str(path) in str(caught.value)


# The command line


def test_the_command(cli: Cli, assembly: Path, tmp_path: Path) -> None:
    scene = tmp_path / "scene.json"
    ran = cli("import", assembly, "-o", scene, "--density", "2", "--ground", "--fixed", "0")
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith("COMPAS assembly: 3 bodies, 2 of them fixed, 3 convex pieces")
    assert "contacts are found anew" in ran.out
    assert ds.Scene.load(scene).names == ["0", "1", "ground"]
    assert cli("check", scene).status == 0


def test_the_command_in_json(cli: Cli, assembly: Path) -> None:
    ran = cli("import", assembly, "--json")
    assert ran.status == 0
    assert json.loads(ran.out) == load(assembly).to_dict()


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["none.json"], "none.json: No such file"),
        (["--gravity", "0,0"], "--gravity must be three numbers"),
        (["--fixed", "9"], "no body is called '9'"),
    ],
)
def test_what_cannot_be_imported(cli: Cli, assembly: Path, arguments: list[str], says: str) -> None:
    first = [] if arguments[0] == "none.json" else [str(assembly)]
    ran = cli("import", *first, *arguments)
    assert ran.status == 2
    assert says in ran.err
    assert ran.err.count("\n") == 1
