"""Bodies with a mass, a centre of mass and an inertia of their own."""

from __future__ import annotations

import json
from typing import Any

import jsonschema
import numpy as np
import pytest

import drystone as ds
from conftest import ROOT


def ground(dimension: int) -> ds.Scene:
    scene = ds.Scene(dimension=dimension)
    if dimension == 2:
        scene.add_box((0, -0.5), (20, 1), name="ground", fixed=True)
    else:
        scene.add_box((0, 0, -0.5), (20, 20, 1), name="ground", fixed=True)
    return scene


@pytest.fixture
def leaning() -> ds.Scene:
    """A box whose weight is over its foot, turned by a quarter about z."""
    scene = ground(3)
    half = 0.5**0.5
    scene.add_box(
        (1, 0, 0.5),
        (0.4, 0.4, 1),
        name="crate",
        mass=30,
        center_of_mass=(0.15, 0, -0.3),
        inertia=np.diag([1.0, 2.0, 2.5]),
        orientation=(half, 0, 0, half),
    )
    return scene


def test_what_is_given_is_what_the_body_has(leaning: ds.Scene) -> None:
    body = leaning.body("crate")
    assert body.mass == 30
    assert body.center_of_mass == pytest.approx((1, 0.15, 0.2))
    assert body.position == body.center_of_mass
    assert body.centroid == pytest.approx((1, 0, 0.5))
    assert body.inertia == pytest.approx(np.diag([2.0, 1.0, 2.5]))
    assert body.vertices.min(axis=0) == pytest.approx((0.8, -0.2, 0))
    assert ds.check(leaning).stable
    heavier = ground(3)
    heavier.add_box((0, 0, 0.5), (0.4, 0.4, 1), mass=30, center_of_mass=(0.21, 0, 0))
    assert not ds.check(heavier).stable


def test_in_the_plane() -> None:
    scene = ground(2)
    center = (0.2, -0.5)
    scene.add_box((0, 1), (1, 2), 0.0, "own", mass=3, center_of_mass=center, inertia=2)
    scene.add_polygon([(3, 0), (5, 0), (5, 1), (3, 1)], "fallen", center_of_mass=(2.9, 0.5))
    own, fallen = scene.body("own"), scene.body("fallen")
    assert (own.mass, own.inertia) == (3, 2)
    assert own.center_of_mass == pytest.approx((0.2, 0.5))
    assert own.centroid == pytest.approx((0, 1))
    assert (fallen.mass, fallen.centroid) == (2, pytest.approx((4, 0.5)))
    assert ds.check(scene).falling == ("fallen",)


def test_they_come_back_from_a_file_and_a_copy(leaning: ds.Scene) -> None:
    schema = json.loads((ROOT / "docs" / "scene.schema.json").read_text())
    validator = jsonschema.validators.validator_for(schema)(schema)
    plane = ground(2)
    plane.add_box((0, 1), (1, 2), mass=3, center_of_mass=(0.2, -0.5), inertia=2)
    for scene in (leaning, plane):
        text = scene.to_json()
        validator.validate(json.loads(text))
        assert ds.Scene.from_json(text).to_json() == text
        body = json.loads(text)["bodies"][1]
        assert "mass" in body
        assert "density" not in body
    both = json.loads(leaning.to_json())
    both["bodies"][1]["density"] = 1.0
    with pytest.raises(jsonschema.ValidationError):
        validator.validate(both)
    with pytest.raises(ds.SceneError, match=r'"density" beside "mass"'):
        ds.Scene.from_json(json.dumps(both))


def test_a_thrown_hammer_turns_about_its_centre_of_mass() -> None:
    """Without gravity it goes straight on; its middle goes round it."""
    scene = ds.Scene(dimension=3, gravity=(0, 0, 0))
    scene.add_box((0, 0, 0), (1, 0.1, 0.1), name="hammer", mass=2, center_of_mass=(0.4, 0, 0))
    world = ds.World(scene)
    world.set_velocity("hammer", (1, 0, 0, 0, 0, 3))
    for _ in range(60):
        world.step()
    body = world.scene.body("hammer")
    assert body.center_of_mass == pytest.approx((0.4 + 0.25, 0, 0))
    away = np.array(body.centroid) - body.center_of_mass
    assert away == pytest.approx(-0.4 * np.array([np.cos(0.75), np.sin(0.75), 0]), abs=1e-3)
    # A world can be taken up again.
    again = ds.World.restore(world.snapshot())
    again.step()
    world.step()
    assert again.state_hash() == world.state_hash()


def test_pieces_of_one_body_may_overlap_if_its_mass_is_given() -> None:
    def cuboid(low: tuple[float, ...], high: tuple[float, ...]) -> list[tuple[Any, ...]]:
        return [tuple(np.where(c, high, low).tolist()) for c in np.ndindex(2, 2, 2)]

    pieces = [cuboid((-1, -1, 0.9), (1, 1, 1)), cuboid((-0.2, -0.2, 0), (0.2, 0.2, 0.95))]
    scene = ground(3)
    with pytest.raises(ds.SceneError, match="give the block's mass"):
        scene.add_solid(pieces, "table")
    scene.add_solid(pieces, "table", mass=12)
    scene.add_box((0.9, 0, 1.1), (0.2, 0.2, 0.2), name="cup", mass=0.2)
    verdict = ds.check(scene)
    assert verdict.stable
    assert {(c.a, c.b) for c in scene.contacts} == {("ground", "table"), ("table", "cup")}
    assert len(scene.contacts) == 8


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"mass": 0}, 'block "crate": mass is 0'),
        ({"mass": -2}, 'block "crate": mass is -2'),
        ({"inertia": np.diag([1, 1, 3])}, "none is greater than the sum"),
        ({"inertia": [[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]}, "not symmetric"),
        ({"inertia": np.diag([1, 1, -1])}, "greater than zero"),
        ({"inertia": [[1, 0, 0]]}, "3 rows of 3 numbers"),
        ({"center_of_mass": (0, 1)}, "center_of_mass must be three numbers"),
        ({"center_of_mass": (0, 1, float("nan"))}, r"center_of_mass\[2\]"),
    ],
)
def test_what_no_body_weighs_is_refused(given: dict[str, Any], said: str) -> None:
    scene = ground(3)
    with pytest.raises(ds.SceneError, match=said):
        scene.add_box((0, 0, 0.5), (1, 1, 1), name="crate", **given)
    assert scene.names == ["ground"]
    with pytest.raises(TypeError, match="must be a number"):
        ground(2).add_box((0, 0.5), (1, 1), inertia=np.eye(3))
