"""Many load cases at once, beside the verdict of each by itself."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import drystone as ds
from limit_programs import case_of

G = 9.81


def some_loads(scene: ds.Scene, random: np.random.Generator, space: bool) -> list[Any]:
    """An earthquake, a lift, a push on a block and a weight on another."""
    names = [body.name for body in scene.bodies if not body.fixed]
    weight = G * scene.body(names[0]).mass
    side = (0.0,) if space else ()
    along = (G, *side, 0.0), (0.0, *side, G)
    push = random.normal(size=scene.dimension) * weight
    return [
        *along,
        {str(random.choice(names)): tuple(push)},
        {names[-1]: (0.0, *side, -weight)},
    ]


@pytest.mark.parametrize("seed", range(4))
def test_cases_beside_verdicts(seed: int) -> None:
    space = seed == 3
    random = np.random.default_rng(seed)
    scene = [
        ds.scenes.wall(5, 4, friction=0.5),
        ds.scenes.arch(9, thickness=0.3, friction=0.7),
        ds.scenes.random_stack(12, seed=6, friction=0.6),
        ds.scenes.wall(3, 3, friction=0.5).extruded(1.0),
    ][seed]
    loads = some_loads(scene, random, space)
    factors = random.uniform((-0.5, -0.4, -0.4, -0.5), (0.5, 0.4, 0.4, 2.0), (60, 4))
    cases = ds.load_cases(scene, loads, factors)
    assert cases.decided.all()
    assert 0 < cases.stands.sum() < 60
    assert cases.solved < 40
    verdicts = [ds.check(case_of(scene, loads, row)).stable for row in factors]
    assert cases.stands.tolist() == verdicts


def test_on_both_sides_of_a_limit() -> None:
    """A block slides at mu; and a push that is known to be too much at once."""
    scene = ds.scenes.column(2, friction=0.5)
    near = [(0.5 - 1e-7,), (0.5 + 1e-7,), (-0.5 + 1e-7,), (-0.5 - 1e-7,), (3.0,), (0.1,)]
    cases = ds.load_cases(scene, [(G, 0)], near)
    assert cases.stands.tolist() == [True, False, True, False, False, True]
    again = ds.load_cases(scene, [(G, 0)], near)
    assert np.array_equal(again.stands, cases.stands)
    assert again.solved == cases.solved
    assert str(cases).startswith("Can stand in 3 of 6 load cases, falls in 3; ")
    assert cases.falling.tolist() == [1, 3, 4]


def test_what_stands_only_with_a_load() -> None:
    """A slope of 20 degrees and mu .2: it slides, unless it is held."""
    scene = ds.scenes.slope(20, friction=0.2)
    low, high = ds.limit(scene, gravity=(G, 0)).bounds
    middle = 0.5 * (low + high)
    cases = ds.load_cases(scene, [(G, 0)], [(0.0,), (middle,), (high + 0.01,), (low + 1e-3,)])
    assert cases.stands.tolist() == [False, True, False, True]


def test_many_directions_take_few_computations() -> None:
    scene = ds.scenes.wall(8, 8, friction=0.5)
    angles = np.linspace(0.0, 2 * math.pi, 200, endpoint=False)
    factors = np.column_stack((0.6 * np.cos(angles), 0.6 * np.sin(angles)))
    cases = ds.load_cases(scene, [(G, 0), (0, G)], factors)
    assert cases.solved < 30
    assert cases.decided.all()
    # Symmetric to left and right.
    assert np.array_equal(cases.stands, cases.stands[(100 - np.arange(200)) % 200])


def test_no_cases_and_no_loads() -> None:
    scene = ds.scenes.column(3)
    assert ds.load_cases(scene, [(G, 0)], np.zeros((0, 1))).stands.tolist() == []
    assert ds.load_cases(scene, [], np.zeros((2, 0))).stands.tolist() == [True, True]
    part = ds.load_cases(scene, [{"1": (0.0, -1.0)}], [[1.0]], blocks=["1"])
    assert part.stands.tolist() == [True]
    assert part.to_dict()["stands"] == [True]


@pytest.mark.parametrize(
    ("loads", "factors", "says"),
    [
        ([(G, 0)], [[1, 2]], r"\(cases, 1\), not of shape \(1, 2\)"),
        ([(G, 0)], [1.0], "shape"),
        ([(G, 0)], [[math.nan]], "from -1e9 to 1e9"),
        ([(G,)], [[1.0]], "two numbers"),
        ([{"9": (1, 0)}], [[1.0]], "9"),
    ],
)
def test_what_is_wrong_is_said(loads: Any, factors: Any, says: str) -> None:
    with pytest.raises(ds.SceneError, match=says):
        ds.load_cases(ds.scenes.column(3), loads, factors)


def test_loads_are_a_list() -> None:
    with pytest.raises(TypeError, match="list of loads"):
        ds.load_cases(ds.scenes.column(3), {"1": (1.0, 0.0)}, [[1.0]])  # type: ignore[arg-type]
