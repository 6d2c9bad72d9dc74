"""Robot and object models as they are published, in small: MJCF, URDF and what they weigh."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

import drystone as ds
from conftest import Ran
from drystone.imports import FormatError, Imported, load
from drystone.imports.weight import of_capsule, of_cylinder, of_ellipsoid, of_triangles

Cli = Callable[..., Ran]


def mjcf(folder: Path, world: str, rest: str = "", **options: Any) -> Imported:
    path = folder / "model.xml"
    path.write_text(f"<mujoco>{rest}<worldbody>{world}</worldbody></mujoco>")
    return load(path, **options)


def urdf(folder: Path, inside: str, **options: Any) -> Imported:
    path = folder / "model.urdf"
    path.write_text(f'<robot name="r">{inside}</robot>')
    return load(path, **options)


PLANE = '<geom name="floor" type="plane" size="0 0 1"/>'


def test_geoms_of_one_body_overlap_and_their_masses_add_up(tmp_path: Path) -> None:
    imported = mjcf(
        tmp_path,
        PLANE + '<body name="table" pos="0 0 .5"><freejoint/>'
        '<geom type="box" size=".5 .5 .05" pos="0 0 .45" mass="10"/>'
        '<geom type="box" size=".05 .05 .48" pos="-.4 0 -.02" mass="1"/>'
        '<geom type="box" size=".05 .05 .48" pos=".4 0 -.02" mass="1"/>'
        '<geom type="box" size=".02 .02 .02" pos="0 .3 .52" mass="0"/></body>',
    )
    body = imported.scene.body("table")
    assert (body.mass, len(body.pieces)) == (12, 4)
    assert body.center_of_mass == pytest.approx((0, 0, 0.5 + (10 * 0.45 - 2 * 0.02) / 12))
    # The top, and two legs .4 beside, each about its own middle and moved to the common one.
    high = (10 * 0.45 - 2 * 0.02) / 12
    top = 10 * ((1 + 1) / 12)
    legs = 2 * (0.1**2 + 0.1**2) / 12 + 2 * 0.4**2
    assert body.inertia[2, 2] == pytest.approx(top + legs)
    up = 10 * (1 + 0.1**2) / 12 + 10 * (0.45 - high) ** 2
    up += 2 * (0.1**2 + 0.96**2) / 12 + 2 * (0.02 + high) ** 2
    assert body.inertia[0, 0] == pytest.approx(up)
    assert ds.check(imported.scene).stable
    assert ds.Scene.from_json(imported.scene.to_json()).to_json() == imported.scene.to_json()
    # As many kilograms a cubic metre, distributed as before.
    dense = load(tmp_path / "model.xml", density=500)
    body = next(body for body in dense.bodies if body.name == "table")
    own = dense.scene.body("table")
    assert own.mass == pytest.approx(500 * body.volume)
    assert own.center_of_mass == pytest.approx((0, 0, 0.5 + high))


def test_inertials_are_taken_with_their_frames(tmp_path: Path) -> None:
    given = '<inertial pos=".1 0 0" euler="0 0 90" mass="7" diaginertia="1 2 2.5"/>'
    box = '<geom type="box" size=".1 .1 .1"/>'
    world = f'<body name="a" pos="0 0 2" euler="0 0 90"><freejoint/>{given}{box}</body>'
    body = mjcf(tmp_path, world).scene.body("a")
    assert (body.mass, body.center_of_mass) == (7, pytest.approx((0, 0.1, 2)))
    # Turned by two quarters: x is x again.
    assert body.inertia == pytest.approx(np.diag([1, 2, 2.5]))
    full = given.replace('diaginertia="1 2 2.5"', 'fullinertia="1 2 2.5 .3 0 0"')
    body = mjcf(tmp_path, world.replace(given, full)).scene.body("a")
    assert body.inertia == pytest.approx(np.array([[1, 0.3, 0], [0.3, 2, 0], [0, 0, 2.5]]))
    # Unless the compiler says that the geoms weigh.
    rest = '<compiler inertiafromgeom="true"/>'
    assert mjcf(tmp_path, world, rest).scene.body("a").mass == pytest.approx(8)
    # What no body has: as the compiler says, or the shape's.
    odd = world.replace("1 2 2.5", "1 1 4")
    balanced = mjcf(tmp_path, odd, '<compiler balanceinertia="true"/>').scene.body("a")
    assert balanced.inertia == pytest.approx(2 * np.eye(3))
    shaped = mjcf(tmp_path, odd)
    assert shaped.scene.body("a").inertia == pytest.approx(7 * 0.2**2 / 6 * np.eye(3))
    assert "a: no rigid body has its inertia: that of its shape is taken" in shaped.messages


def test_frames_replicas_includes_and_classes(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "domino.xml").write_text(
        '<mujocoinclude><body name="d" childclass="thin"><freejoint/><geom type="box"/></body>'
        "</mujocoinclude>"
    )
    rest = (
        '<compiler angle="radian"/><default><default class="thin">'
        '<geom size=".01 .04 .1" mass="0.3"/></default></default>'
    )
    imported = mjcf(
        tmp_path,
        PLANE + '<frame pos="0 0 .1" euler="0 0 1.5707963267948966">'
        '<replicate count="12" offset=".1 0 0" sep="-">'
        '<include file="parts/domino.xml"/></replicate></frame>',
        rest,
    )
    found = {body.name: body for body in imported.bodies}
    assert list(found) == [f"d-{k:02}" for k in range(12)] + ["floor"]
    scene = imported.scene
    assert scene.body("d-03").centroid == pytest.approx((0, 0.3, 0.1))
    assert np.ptp(scene.body("d-03").vertices, axis=0) == pytest.approx([0.08, 0.02, 0.2])
    assert scene.body("d-11").mass == pytest.approx(0.3)
    assert ds.check(scene).stable


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ('pos="0 0 x"', "box: pos: not numbers: '0 0 x'"),
        ('quat="0 0 0 0"', "box: quat: '0 0 0 0' is no orientation"),
        ('euler="0 0"', "box: euler: needs 3 numbers, not '0 0'"),
    ],
)
def test_a_frame_that_is_none_is_told_by_its_body(tmp_path: Path, given: str, message: str) -> None:
    with pytest.raises(FormatError) as raised:
        mjcf(tmp_path, f'<body name="box" {given}><geom type="box" size="1 1 1"/></body>')
    assert f"model.xml: {message}" in str(raised.value)


def test_a_file_that_includes_itself_is_told_by_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(FormatError, match=r"model\.xml: it includes 'model\.xml'"):
        mjcf(Path(), '<include file="model.xml"/>')


def test_a_body_that_cannot_be_taken_does_not_stop_the_rest(tmp_path: Path) -> None:
    imported = mjcf(
        tmp_path,
        '<body name="lost"><freejoint/><geom type="mesh" mesh="gone"/></body>'
        '<body name="kept"><freejoint/><geom type="box" size="1 1 1"/></body>',
        '<asset><mesh name="gone" file="gone.stl"/></asset>',
    )
    assert [body.name for body in imported.bodies] == ["kept"]
    (out,) = imported.left_out
    assert (out.what, "gone.stl" in out.why) == ("body lost", True)
    assert imported.messages[-1] == "the scene lacks 1 of the file's bodies: body lost"


def test_meshes_of_mujoco(tmp_path: Path) -> None:
    """`.msh`, scaled, mirrored, about a reference of its own; and built in."""
    box = trimesh.creation.box((2, 1, 1))
    counts = np.array([len(box.vertices), 0, 0, len(box.faces)], dtype="<i4")
    vertices = box.vertices.astype("<f4").tobytes()
    (tmp_path / "box.msh").write_bytes(
        counts.tobytes() + vertices + box.faces.astype("<i4").tobytes()
    )
    imported = mjcf(
        tmp_path,
        '<body name="a"><freejoint/><geom type="mesh" mesh="box" density="100"/></body>'
        '<body name="b" pos="9 0 0"><freejoint/><geom type="mesh" mesh="ball" mass="3"/></body>',
        '<asset><mesh file="box.msh" scale="-1 2 1" refpos="1 0 0"/>'
        '<mesh name="ball" builtin="sphere" params="1"/></asset>',
    )
    a, b = imported.scene.body("a"), imported.scene.body("b")
    assert a.mass == pytest.approx(400)
    assert a.center_of_mass == pytest.approx((1, 0, 0))
    assert b.mass == pytest.approx(3)
    (tmp_path / "box.msh").write_bytes(counts.tobytes() + vertices)
    with pytest.raises(ds.DrystoneError, match=r"no .msh of MuJoCo"):
        load(tmp_path / "box.msh")


BOX = '<collision><geometry><box size=".1 .1 1"/></geometry></collision>'


def test_a_urdf_weighs_what_it_says(tmp_path: Path) -> None:
    own = '<inertial><origin xyz=".2 0 0"/><mass value="1"/></inertial>'
    leaning = urdf(tmp_path, f'<link name="post">{own}{BOX}</link>', ground=True)
    assert leaning.scene.body("post").center_of_mass == pytest.approx((0.2, 0, 0))
    assert not ds.check(leaning.scene).stable
    tensor = '<inertia ixx="1" iyy="2" izz="2.5" ixy=".1" ixz="0" iyz="0"/>'
    turned = '<origin rpy="0 0 1.5707963267948966"/>'
    given = f'<inertial>{turned}<mass value="3"/>{tensor}</inertial>'
    body = urdf(tmp_path, f'<link name="a">{given}{BOX}</link>').scene.body("a")
    assert body.inertia == pytest.approx(np.array([[2, -0.1, 0], [-0.1, 1, 0], [0, 0, 2.5]]))
    # In millimetres: the mass stays, lengths of its inertia do not.
    small = urdf(tmp_path, f'<link name="a">{given}{BOX}</link>', scale=1e-3).scene.body("a")
    assert small.mass == 3
    assert small.inertia == pytest.approx(1e-6 * body.inertia)


def test_collisions_of_a_link_may_overlap(tmp_path: Path) -> None:
    """A box without a lid: its sides reach into its floor and into one another."""
    sides = [
        ("0 0 0.01", "1 0.8 0.02"),
        ("0.49 0 0.1", "0.02 0.8 0.2"),
        ("0 0.39 0.1", "1 0.02 0.2"),
    ]
    shapes = "".join(
        f'<collision><origin xyz="{at}"/><geometry><box size="{size}"/></geometry></collision>'
        for at, size in sides
    )
    given = '<inertial><origin xyz="0.1 0 0.05"/><mass value="2"/></inertial>'
    imported = urdf(tmp_path, f'<link name="box">{given}{shapes}</link>', ground=True)
    body = imported.scene.body("box")
    assert (body.mass, len(body.pieces)) == (2, 3)
    assert body.center_of_mass == pytest.approx((0.1, 0, 0.05))
    assert ds.check(imported.scene).stable


def test_a_urdf_link_without_mass_is_fixed(tmp_path: Path) -> None:
    inside = f'<link name="floor"><inertial><mass value="0"/></inertial>{BOX}</link>'
    imported = urdf(tmp_path, inside)
    assert [body.fixed for body in imported.bodies] == [True]
    assert "taken as fixed" in imported.messages[0]
    (body,) = urdf(tmp_path, inside, density=200).bodies
    assert not body.fixed
    assert urdf(tmp_path, inside, density=200).scene.body("floor").mass == pytest.approx(2)


def test_bullets_friction_and_a_namespace(tmp_path: Path) -> None:
    contact = (
        '<contact><lateral_friction value="0"/></contact><inertial><mass value="1"/></inertial>'
    )
    path = tmp_path / "ice.urdf"
    link = f'<link name="ice">{contact}{BOX}</link>'
    path.write_text(f'<robot xmlns="http://drake.mit.edu" name="r">{link}</robot>')
    imported = load(path)
    assert imported.bodies[0].friction == 0
    assert "friction 0" in imported.messages[0]


def test_hulls_of_every_format(tmp_path: Path) -> None:
    ell = trimesh.creation.extrude_triangulation(
        [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)],
        [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)],
        height=1,
    )
    ell.export(tmp_path / "ell.obj")
    mesh = '<collision><geometry><mesh filename="ell.obj" scale="2"/></geometry></collision>'
    link = f'<link name="a"><inertial><mass value="1"/></inertial>{mesh}</link>'
    assert len(urdf(tmp_path, link).bodies[0].pieces) == 2
    (body,) = urdf(tmp_path, link, hull=True).bodies
    assert (len(body.pieces), body.volume) == (1, pytest.approx(8 * 3.5))
    assert load(tmp_path / "ell.obj", hull=True).bodies[0].volume == pytest.approx(3.5)
    assert load(tmp_path, hull=True).bodies[0].volume == pytest.approx(3.5)


def test_round_shapes_weigh_what_they_do() -> None:
    """They are left out of the shape, not of the mass: against finely tessellated ones."""
    for weight, mesh in (
        (of_ellipsoid([0.3] * 3), trimesh.creation.icosphere(5, 0.3)),
        (of_cylinder(0.3, 0.5), trimesh.creation.cylinder(0.3, 1, sections=400)),
        (of_capsule(0.3, 0.5), trimesh.creation.capsule(1, 0.3, (200, 200))),
    ):
        weighed = of_triangles(mesh.triangles)
        assert weight.mass == pytest.approx(weighed.mass, rel=2e-3)
        assert weight.inertia == pytest.approx(weighed.inertia, rel=3e-3, abs=1e-6)


def test_overlapping_shells_are_pieces(tmp_path: Path) -> None:
    """As V-HACD writes them: two boxes that overlap, and a third with a dent within 5 %."""
    boxes = [trimesh.creation.box((1, 1, 1)) for _ in range(3)]
    for number, box in enumerate(boxes):
        box.apply_translation((0.9 * number, 0, 0))
    dented = boxes[2].subdivide()
    middle = np.linalg.norm(dented.vertices - (1.8, 0, 0.5), axis=1).argmin()
    dented.vertices[middle] -= (0, 0, 0.1)
    shells = trimesh.util.concatenate([*boxes[:2], dented])
    shells.export(tmp_path / "shells.obj")
    mesh = '<collision><geometry><mesh filename="shells.obj"/></geometry></collision>'
    link = f'<link name="a"><inertial><mass value="3"/></inertial>{mesh}</link>'
    imported = urdf(tmp_path, link)
    (body,) = imported.bodies
    assert (len(body.pieces), body.mass, body.volume) == (3, 3, pytest.approx(3))
    assert "3 nearly convex shells" in imported.messages[0]
    assert ds.check(urdf(tmp_path, link, ground=True).scene).stable
    # A hull of too many corners is left out, with what to do.
    trimesh.creation.icosphere(5).export(tmp_path / "ball.obj")
    imported = mjcf(
        tmp_path,
        '<geom type="box" size="1 1 1"/><body name="b"><geom type="mesh" mesh="ball"/></body>',
        '<asset><mesh file="ball.obj"/></asset>',
    )
    assert "simplified with simplify" in imported.left_out[0].why
    assert imported.scene.names == ["geom 1"]


# Files of other tools where a scene is wanted


@pytest.fixture
def others(tmp_path: Path) -> dict[str, Path]:
    trimesh.creation.box((1, 1, 1)).export(tmp_path / "x.stl")
    (tmp_path / "m.xml").write_text("<mujoco><worldbody/></mujoco>")
    (tmp_path / "r.json").write_text('<?xml version="1.0"?><robot name="r"/>')
    (tmp_path / "c.json").write_text('{"dtype": "compas.datastructures/Assembly", "data": {}}')
    kinds = {"a mesh": "x.stl", "an MJCF model": "m.xml", "a URDF model": "r.json"}
    return {kind: tmp_path / name for kind, name in {**kinds, "a file of COMPAS": "c.json"}.items()}


def test_files_of_other_tools_are_told(others: dict[str, Path], cli: Cli) -> None:
    for kind, path in others.items():
        with pytest.raises(ds.SceneError, match=f"this is {kind}, not a scene.*drystone import"):
            ds.Scene.load(path)
        ran = cli("check", path)
        assert (ran.status, f"this is {kind}" in " ".join(ran.err.split())) == (2, True)
        assert "drystone import" in " ".join(ran.err.split())


def test_a_file_that_is_not_there_is_said_to_be_missing(tmp_path: Path, cli: Cli) -> None:
    for name in ("x.stl", "m.xml", "wall.dxf"):
        with pytest.raises(FileNotFoundError):
            ds.Scene.load(tmp_path / name)
        for command in ("check", "import"):
            assert "No such file" in cli(command, tmp_path / name).err
    assert "name is empty" in cli("import", "").err


@pytest.mark.parametrize("name", ["wall.dxf", "Wall.DWG"])
def test_a_drawing_is_told_how_it_gets_here(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text("0\nSECTION\n")
    for read in (ds.Scene.load, ds.imports.load):
        with pytest.raises(ds.DrystoneError, match=r"is not read: .*closed meshes.*add_polygon"):
            read(tmp_path / name)


@pytest.mark.parametrize("name", ["page.html", "picture.SVG", "run.npz"])
def test_what_drystone_wrote_itself_is_no_scene(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text("<NaN>")
    with pytest.raises(ds.SceneError, match=r"no scene, by its name: a scene is a \.json file"):
        ds.Scene.load(tmp_path / name)


@pytest.mark.parametrize("name", ["a.json", "a.obj", "a.stl", "a.ply", "a.xml", "a.urdf"])
def test_an_empty_file_is_said_to_be_empty(name: str, tmp_path: Path) -> None:
    (tmp_path / name).touch()
    with pytest.raises(ds.DrystoneError, match="is empty"):
        ds.imports.load(tmp_path / name)


def test_names_that_lie_are_refused(block: ds.Scene, tmp_path: Path) -> None:
    for name in ("scene.stl", "scene.XML", "scene.svg", "scene.bmp", "scene.dxf"):
        with pytest.raises(ds.SceneError, match=r"let its name end in \.json"):
            block.save(tmp_path / name)
        assert not (tmp_path / name).exists()
    block.save(tmp_path / "scene.json")


def test_a_joint_is_never_taken_as_free(tmp_path: Path, cli: Cli) -> None:
    door = '<body name="door"><joint type="slide"/><geom type="box" size="1 1 1"/></body>'
    with pytest.raises(FormatError, match="door hangs on a slide joint"):
        mjcf(tmp_path, door)
    imported = mjcf(tmp_path, door, joints="fixed")
    assert [body.fixed for body in imported.bodies] == [True]
    assert "door: its slide joint is welded, to the world" in imported.messages
    ran = cli("import", tmp_path / "model.xml", "--joints", "fixed")
    assert (ran.status, "is welded" in ran.out) == (0, True)
    with pytest.raises(FormatError, match="joints must be"):
        mjcf(tmp_path, door, joints="free")


def test_one_piece_is_not_many(cli: Cli, tmp_path: Path) -> None:
    mjcf(tmp_path, '<body name="a"><freejoint/><geom type="box" size="1 1 1"/></body>')
    ran = cli("import", tmp_path / "model.xml")
    assert ran.out.splitlines()[0].rstrip() == "MJCF: 1 body, 0 of them fixed, 1 convex piece"
