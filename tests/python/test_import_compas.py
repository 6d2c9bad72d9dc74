"""COMPAS: faces that are not plane, models of compas_dem, and live objects."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import drystone as ds
from drystone.imports import FormatError, load

CUBE = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
FACES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]


class Live:
    """What a COMPAS object looks like from outside."""

    def __init__(self, kind: str, data: Any) -> None:
        self.__dtype__ = kind
        self.data = data

    @property
    def __data__(self) -> Any:
        return self.data


def mesh(points: list[tuple[float, ...]]) -> dict[str, Any]:
    return {
        "vertex": {k: dict(zip("xyz", p, strict=True)) for k, p in enumerate(points)},
        "face": dict(enumerate(FACES)),
    }


def moved(by: float) -> Live:
    rows = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, by], [0, 0, 0, 1]]
    return Live("compas.geometry/Transformation", {"matrix": rows})


def model() -> Live:
    """Two cubes of a material, the lower one a support, as compas_dem 0.6 keeps them."""

    def element(height: float, support: bool) -> Live:
        data = {
            "transformation": moved(height),
            "features": [],
            "name": "Block",
            "material": "stone",
            "geometry": Live("compas.datastructures/Mesh", mesh(CUBE)),
            "is_support": support,
        }
        return Live("compas_dem.elements/Block", data)

    stone = Live("compas_dem.material/Stone", {"density": 2200})
    data = {
        "transformation": None,
        "elements": {"g-low": element(0, True), "g-high": element(1, False)},
        "materials": {"stone": stone},
        "tree": {},
        "graph": {
            "node": {3: {"element": "g-low"}, 4: {"element": "g-high"}},
            "edge": {3: {4: {}}},
        },
    }
    return Live("compas_dem.models/BlockModel", data)


def written(value: Any) -> Any:
    if isinstance(value, Live):
        return {"dtype": value.__dtype__, "data": written(value.data)}
    if isinstance(value, dict):
        return {str(key): written(item) for key, item in value.items()}
    return [written(item) for item in value] if isinstance(value, list) else value


def test_a_model_of_compas_dem(tmp_path: Path) -> None:
    path = tmp_path / "model.json"
    path.write_text(json.dumps(written(model())))
    imported = load(path)
    assert imported.format == "COMPAS model"
    found = [(body.name, body.fixed, body.density) for body in imported.bodies]
    assert found == [("3", True, 2200), ("4", False, 2200)]
    assert imported.scene.body("4").centroid == pytest.approx((0.5, 0.5, 1.5))
    assert [out.what for out in imported.left_out] == ["1 edges with interfaces"]
    assert ds.check(imported.scene).stable


def test_live_objects_need_no_compas() -> None:
    assert load(model()).scene.names == ["3", "4"]
    assert ds.check(ds.Scene.from_compas(model(), friction=0.7)).stable
    block = Live("compas_assembly.datastructures/Block", mesh(CUBE))
    nodes = {0: {"block": block, "is_support": True}}
    graph = Live("compas.datastructures/Graph", {"node": nodes, "edge": {}})
    scene = ds.Scene.from_compas(Live("compas_assembly.datastructures/Assembly", {"graph": graph}))
    assert scene.body("0").fixed
    one = load(Live("compas.datastructures/Mesh", mesh(CUBE)), density=3)
    assert (one.format, one.scene.body("mesh").mass) == ("COMPAS mesh", pytest.approx(3))
    with pytest.raises(FormatError, match="neither a COMPAS assembly"):
        load(Live("compas.geometry/Point", [0, 0, 0]))


def test_faces_that_are_not_plane_are_filled_alike_from_both_sides() -> None:
    """Two blocks share a warped face. The volume under it is what it is from either diagonal's
    mean, and the two neither overlap nor part."""
    raised = [(x, y, z + (0.1 if (x, y, z) == (1, 1, 1) else 0)) for x, y, z in CUBE]
    above = [(x, y, z + 1 + (0.1 if (x, y, z) == (1, 1, 0) else 0)) for x, y, z in CUBE]
    elements = {
        name: Live(
            "compas_dem.elements/Block",
            {
                "geometry": Live("compas.datastructures/Mesh", mesh(points)),
                "is_support": name == "a",
            },
        )
        for name, points in (("a", raised), ("b", above))
    }
    imported = load(Live("compas_dem.models/BlockModel", {"elements": elements, "graph": {}}))
    low, high = imported.bodies
    assert low.volume == pytest.approx(1 + 0.1 / 4)
    assert high.volume == pytest.approx(1 - 0.1 / 4)
    assert "1 of its faces are not plane, by up to 0.025 in its unit" in imported.messages[0]
    assert ds.check(imported.scene).stable
