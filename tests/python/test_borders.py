"""Corners on corners and edges along edges: docs/theory/touching-at-borders.md."""

from __future__ import annotations

import math

import numpy as np
import pytest

import drystone as ds


def beam(lean: float, length: float, thick: float) -> np.ndarray:
    """Corners of a beam that leans to the right by `lean`, degrees, from its foot at the left: the
    second of them is the lowest, the third the furthest right, which is at x = 0."""
    t = math.radians(lean)
    along, across = np.array([math.sin(t), math.cos(t)]), np.array([math.cos(t), -math.sin(t)])
    corners = [x * length * along + y * thick * across for x, y in ((0, 0), (0, 1), (1, 1), (1, 0))]
    return np.array(corners) - (max(c[0] for c in corners), min(c[1] for c in corners))


def add(scene: ds.Scene, corners: np.ndarray, name: str) -> None:
    """A planar shape; in space with a depth of 0.06 m."""
    if scene.dimension == 2:
        turn = np.linalg.det([corners[1] - corners[0], corners[2] - corners[1]])
        scene.add_polygon([tuple(c) for c in corners[:: 1 if turn > 0 else -1]], name=name)
    else:
        scene.add_polyhedron([(x, w, y) for x, y in corners for w in (0, 0.06)], name=name)


def table(dimension: int, friction: float) -> ds.Scene:
    scene = ds.Scene(dimension=dimension, friction=friction)
    if dimension == 2:
        scene.add_box((0, -0.1), (4, 0.2), name="table", fixed=True)
    else:
        scene.add_box((0, 0, -0.1), (4, 4, 0.2), name="table", fixed=True)
    return scene


def frame(
    lean: float, friction: float, dimension: int, length: float = 0.09, thick: float = 3e-4
) -> ds.Scene:
    """Two beams that lean on one another."""
    scene = table(dimension, friction)
    for name, side in (("left", 1), ("right", -1)):
        add(scene, beam(lean, length, thick) * (side, 1), name)
    return scene


def least_friction(lean: float, slenderness: float) -> float:
    """Moments about a foot, on the lower side of a beam as the head is: the weight stands half a
    thickness nearer to the foot than on a line."""
    return (math.tan(math.radians(lean)) - 1 / slenderness) / 2


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(
    ("lean", "slenderness"), [(5, 300), (10, 300), (25, 300), (40, 300), (45, 10), (60, 5), (30, 4)]
)
def test_beams_stand_as_long_as_their_feet_hold(
    dimension: int, lean: float, slenderness: float
) -> None:
    limit = least_friction(lean, slenderness)
    # A cone of eight edges within the round one has at least cos(pi / 8) = 0.92 of its friction.
    share = 1e-6 if dimension == 2 else 0.09
    for friction, stands in ((limit * (1 + share), True), (limit * (1 - share), False)):
        verdict = ds.check(frame(lean, friction, dimension, 0.09, 0.09 / slenderness))
        assert verdict.stable is stands, (lean, friction, limit)
        if stands:
            head = verdict.borders
            weight = verdict.scene.body("left").mass * 9.81
            assert len(head) == dimension - 1
            assert f"({len(head)} bearing where only corners or edges meet)" in str(verdict)
            assert sum(f.normal_force for f in head) == pytest.approx(weight * limit, rel=1e-9)
            for f in head:
                assert np.allclose(f.normal, (1, 0, 0)[:dimension], atol=1e-12)
    assert sum(f["at_borders"] for f in verdict.to_dict()["forces"]) == dimension - 1


def house(storeys: int, friction: float, dimension: int) -> ds.Scene:
    """A house of cards, with a row of cards lying on each row of tents but the highest."""
    scene = table(dimension, friction)
    lean, length, thick = 15.0, 0.09, 3e-4
    card = beam(lean, length, thick)
    pitch = -2 * card[:, 0].min() + 1e-3
    height = card[:, 1].max()
    for storey in range(storeys):
        base = storey * (height + thick)
        tents = storeys - storey
        heads = [(k - (tents - 1) / 2) * pitch for k in range(tents)]
        for k, head in enumerate(heads):
            for side, name in ((1, "left"), (-1, "right")):
                add(scene, card * (side, 1) + (head, base), f"{name} {storey} {k}")
        for k, head in enumerate(heads[:-1]):
            flat = np.array([(0, 0), (pitch, 0), (pitch, thick), (0, thick)])
            place = np.array((head, base + height))
            add(scene, flat + place, f"flat {storey} {k}")
    return scene


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_house_of_cards(dimension: int) -> None:
    # A card that bears V on its head pushes with (W / 2 + V) tan(lean), and its foot bears W + V.
    tangent = math.tan(math.radians(15))
    standing = ds.check(house(3, 1.1 * tangent, dimension))
    assert standing.stable
    assert {(f.a.split()[0], f.b.split()[0]) for f in standing.borders} == {("left", "right")}
    assert len({(f.a, f.b) for f in standing.borders}) == 6
    assert not ds.check(house(3, 0.49 * tangent, dimension)).stable
    assert ds.check(house(1, 0.51 * tangent * (1 if dimension == 2 else 1.09), dimension)).stable


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_frame_does_not_depend_on_how_it_is_described(dimension: int) -> None:
    rng = np.random.default_rng(7)
    scene = frame(25, 0.5, dimension, 2.0, 0.2)
    shapes = {body.name: (np.array(body.vertices), body.fixed) for body in scene.bodies}
    before = {frozenset((c.a, c.b)): c for c in scene.contacts if c.at_borders}
    assert len(before) == 1
    for _ in range(20):
        turn = rotation(rng, dimension)
        scale, shift = 10 ** rng.uniform(-3, 3), rng.uniform(-100, 100, dimension)
        down = turn @ np.array((0.0, -9.81) if dimension == 2 else (0.0, 0.0, -9.81))
        moved = ds.Scene(dimension=dimension, friction=0.5, gravity=tuple(down))
        for name in rng.permutation(list(shapes)):
            corners, fixed = shapes[name]
            placed = [tuple(c) for c in scale * (corners @ turn.T + shift)]
            if dimension == 2:
                moved.add_polygon(placed, name=name, fixed=fixed)
            else:
                moved.add_polyhedron(placed, name=name, fixed=fixed)
        after = [c for c in moved.contacts if c.at_borders]
        assert len(after) == dimension - 1
        for c in after:
            sign = 1 if (c.a, c.b) == ("left", "right") else -1
            expected = sign * turn @ np.array(before[frozenset((c.a, c.b))].normal)
            assert np.allclose(c.normal, expected, atol=1e-9)
        assert ds.check(moved).stable


def rotation(rng: np.random.Generator, dimension: int) -> np.ndarray:
    turn, _ = np.linalg.qr(rng.normal(size=(dimension, dimension)))
    turn[:, 0] *= np.linalg.det(turn)
    return turn


def diamond(at: tuple[float, float], heavy: float = 0.0) -> list[tuple[float, float]]:
    """A square on its corner; `heavy` pulls its right corner out, metres."""
    x, y = at
    return [(x, y - 1), (x + 1 + heavy, y), (x, y + 1), (x - 1, y)]


def test_a_diamond_stands_on_a_diamond_while_its_weight_is_above_the_corner() -> None:
    for heavy, friction, stands in ((0.0, 0.5, True), (0.0, 0.0, True), (0.01, 0.5, False)):
        scene = ds.Scene(friction=friction)
        scene.add_polygon(diamond((0, -1)), name="below", fixed=True)
        scene.add_polygon(diamond((0, 1), heavy), name="above")
        verdict = ds.check(scene)
        assert verdict.stable is stands
        assert len(verdict.forces) == 1
        assert verdict.forces[0].at_borders


def test_a_corner_on_an_edge_bears_in_space() -> None:
    """A cube on its corner, in the middle of a fixed ridge: an equilibrium, if no stable one."""
    scene = ds.Scene(dimension=3, friction=0.5)
    ridge = [(x, y, z) for x in (-2, 2) for y, z in ((0, 0), (-1, -1), (1, -1))]
    scene.add_polyhedron(ridge, name="ridge", fixed=True)
    axes = np.linalg.qr(np.array([[1.0, 1, 0], [1, -1, 0], [1, 0, 1]]).T)[0]
    corners = np.array([(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]) @ axes.T
    # The diagonal of the cube goes straight up.
    diagonal = axes.sum(axis=1) / math.sqrt(3)
    up = np.array((0.0, 0, 1))
    half = (diagonal + up) / np.linalg.norm(diagonal + up)
    corners = 2 * np.outer(corners @ half, half) - corners
    scene.add_polyhedron([tuple(c) for c in corners], name="cube")
    verdict = ds.check(scene)
    assert verdict.stable
    assert len(verdict.borders) == 1
    assert np.allclose(verdict.borders[0].normal, (0, 0, 1), atol=1e-12)


@pytest.mark.parametrize("dimension", [2, 3])
def test_flat_joints_stay_free_to_slide(dimension: int) -> None:
    """Four blocks in a point on a frictionless slope: a corner of each at a corner of the one
    across, and nothing there that would keep the upper two from sliding."""
    for blocks in ((0, 1, 2, 3), (1, 2, 3), (0, 1, 3)):
        scene = ds.Scene(
            dimension=dimension,
            friction=0.0,
            gravity=(-1, -9) if dimension == 2 else (-1, 0, -9),
        )
        for k in blocks:
            centre = (k % 2, 0, k // 2)
            scene.add_box(
                centre if dimension == 3 else centre[::2],
                (1,) * dimension,
                name=str(k),
                fixed=k < 2,
            )
        assert not any(c.at_borders for c in scene.contacts)
        assert not ds.check(scene).stable


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(("lean", "slenderness"), [(10, 300), (25, 300), (40, 300), (45, 10)])
def test_what_stands_does_not_move(dimension: int, lean: float, slenderness: float) -> None:
    limit = least_friction(lean, slenderness)
    share = 0.01 if dimension == 2 else 0.09
    for friction, stands in ((limit * (1 + share), True), (limit * (1 - share), False)):
        scene = frame(lean, friction, dimension, 0.09, 0.09 / slenderness)
        run = ds.simulate(scene, steps=120)
        assert bool(run.motionless.all()) is stands, (lean, friction)
        # What falls is not held in the air, nor does it fall through the table or the other beam.
        assert run.penetration.max() < 1e-5
        if not stands:
            fallen = run.poses[-1, :2, dimension - 1]
            assert fallen.max() < 0.045 * math.cos(math.radians(lean))


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_house_of_cards_stays(dimension: int) -> None:
    run = ds.simulate(house(3, 0.3, dimension), steps=30)
    assert run.motionless.all()
