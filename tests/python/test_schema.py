"""Every scene written keeps to the documented schema, and the schema refuses what is wrong."""

from __future__ import annotations

import json
from typing import Any

import jsonschema
import pytest

import drystone as ds
from conftest import ROOT


@pytest.fixture(scope="module")
def validator() -> Any:
    schema = json.loads((ROOT / "docs" / "scene.schema.json").read_text())
    kind = jsonschema.validators.validator_for(schema)
    kind.check_schema(schema)
    return kind(schema)


@pytest.mark.parametrize("name", ds.scenes.__all__)
def test_built_in_scenes_keep_to_the_schema(validator: Any, name: str) -> None:
    validator.validate(json.loads(getattr(ds.scenes, name)().to_json()))


def test_every_kind_of_body_keeps_to_the_schema(validator: Any) -> None:
    scene = ds.Scene(gravity=(0.1, -1.6), friction=0.0, contact_tolerance=1e-4)
    scene.add_box((0, 0), (1, 1), angle=0.3, density=2.0, friction=0.9, fixed=True)
    scene.add_polygon([(4, 0), (5, 0), (5, 1)], name="wedge", friction=0.1)
    validator.validate(json.loads(scene.to_json()))


def test_the_schema_refuses_what_the_reader_refuses(validator: Any, block: ds.Scene) -> None:
    good = json.loads(block.to_json())
    key = next(
        key
        for key, value in good.items()
        if isinstance(value, list) and len(value) == 2 and isinstance(value[0], dict)
    )
    for damaged in (
        {**good, "version": 99},
        {**good, "colour": "red"},
        {**good, key: [{**good[key][0], "density": "heavy"}]},
    ):
        with pytest.raises(jsonschema.ValidationError):
            validator.validate(damaged)
        with pytest.raises(ds.SceneError):
            ds.Scene.from_json(json.dumps(damaged))
