"""3MF, glTF scenes and STEP: units, transforms and instances."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

import drystone as ds
from conftest import ROOT

TOWER = ROOT / "tests" / "data" / "tower.step"
"""Two bricks of 200 x 100 x 50 mm, instances of one part, the upper turned by 90 degrees, and a rod
of 40 mm across and 60 mm high on it."""


def brick_scene() -> trimesh.Scene:
    """Two instances of one brick, 20 x 10 x 5, the upper in a node that is moved and turned."""
    brick = trimesh.creation.box((20, 10, 5))
    turned = trimesh.transformations.rotation_matrix(np.pi / 2, (0, 0, 1))
    turned[:3, 3] = (0, 5, 5)
    scene = trimesh.Scene()
    scene.add_geometry(brick, node_name="lower", geom_name="brick")
    scene.graph.update(frame_to="arm", frame_from=scene.graph.base_frame, matrix=turned)
    scene.graph.update(frame_to="upper", frame_from="arm", geometry="brick")
    return scene


def bounds(imported: ds.imports.Imported, name: str) -> np.ndarray:
    (body,) = (body for body in imported.bodies if body.name == name)
    points = np.concatenate(body.pieces)
    return np.array([points.min(axis=0), points.max(axis=0)])


@pytest.mark.parametrize("ending", [".glb", ".gltf"])
def test_nodes_of_gltf_stand_where_their_transforms_put_them(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"bricks{ending}"
    exported = brick_scene().export(file_type=ending[1:])
    if isinstance(exported, bytes):
        path.write_bytes(exported)
    else:
        for name, data in exported.items():
            (path if name.endswith(ending) else tmp_path / name).write_bytes(data)
    imported = ds.imports.load(path, fixed=["lower"])
    assert sorted(body.name for body in imported.bodies) == ["lower", "upper"]
    assert bounds(imported, "upper") == pytest.approx(
        np.array([[-5, -5, 2.5], [5, 15, 7.5]]), abs=1e-5
    )
    assert len(imported.scene.contacts) == 4
    assert ds.check(imported.scene).stable


@pytest.mark.parametrize(("unit", "metres"), [("millimeter", 1e-3), ("inch", 0.0254)])
def test_3mf_says_its_unit(tmp_path: Path, unit: str, metres: float) -> None:
    pytest.importorskip("lxml")
    scene = brick_scene()
    scene.units = unit
    path = tmp_path / "bricks.3mf"
    path.write_bytes(scene.export(file_type="3mf"))
    text = as_3mf_of(path, unit)
    imported = ds.imports.load(text, fixed=["lower"])
    assert bounds(imported, "lower") == pytest.approx(
        metres * np.array([[-10, -5, -2.5], [10, 5, 2.5]])
    )
    assert any(f"{metres:g} m" in message for message in imported.messages)
    raw = ds.imports.load(text, scale=1.0)
    assert bounds(raw, "lower")[1] == pytest.approx((10, 5, 2.5))
    with pytest.warns(ds.meshes.MeshWarning, match=f"{metres:g} m"):
        ds.Scene(dimension=3).add_mesh(one_brick(tmp_path, unit))


def as_3mf_of(path: Path, unit: str) -> Path:
    """The same file with another unit: trimesh writes millimetres whatever the scene says."""
    import zipfile

    changed = path.with_name(f"in-{unit}.3mf")
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(changed, "w") as new:
        for name in old.namelist():
            data = old.read(name).replace(b'unit="millimeter"', f'unit="{unit}"'.encode())
            new.writestr(name, data)
    return changed


def one_brick(folder: Path, unit: str) -> Path:
    scene = trimesh.Scene([trimesh.creation.box((20, 10, 5))])
    path = folder / "one.3mf"
    path.write_bytes(scene.export(file_type="3mf"))
    return as_3mf_of(path, unit)


def test_step_is_in_metres_with_names_and_instances() -> None:
    pytest.importorskip("cascadio")
    imported = ds.imports.load(TOWER, ground=True, tolerance=1e-6)
    assert sorted(body.name for body in imported.bodies) == ["ground", "lower", "rod", "upper"]
    assert bounds(imported, "upper") == pytest.approx(
        np.array([[0.06, -0.02, 0.05], [0.16, 0.18, 0.1]]), abs=1e-7
    )
    (rod,) = (body for body in imported.bodies if body.name == "rod")
    # A prism in a cylinder: less by no more than 2 % with 64 sides.
    assert 0.98 < rod.volume / (np.pi * 0.02**2 * 0.06) <= 1
    assert ds.check(imported.scene).stable
    assert ds.plan(imported.scene, clear_path=True).order == ("rod", "upper", "lower")


def test_without_the_package_the_error_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "cascadio", None)
    for read in (ds.meshes.read_part, ds.imports.load):
        with pytest.raises(ds.DrystoneError, match=r'STEP files need cascadio.*"drystone\[cad\]"'):
            read(TOWER)
