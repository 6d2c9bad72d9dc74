"""The contact forces of least norm: docs/theory/canonical-forces.md."""

from __future__ import annotations

import json
import pickle
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import nnls

import drystone as ds
from drystone.cli import run
from drystone.recording.of_plan import plan_recording

G = 9.81


def _named(
    scene: ds.Scene, forces: tuple[ds.ContactForce, ...] | None = None
) -> dict[object, float]:
    """Every component of every force by what it is of: the names of the bodies, the point."""
    found = ds.check(scene).forces if forces is None else forces
    return {
        (*sorted((f.a, f.b)), *np.round(f.point, 6), axis): value * (1 if f.a < f.b else -1)
        for f in found
        for axis, value in zip("xyz", f.force, strict=False)
    }


def _same(one: dict[object, float], other: dict[object, float]) -> None:
    scale = max(map(abs, one.values()))
    assert one.keys() == other.keys()
    assert max(abs(value - other[key]) for key, value in one.items()) <= 1e-9 * scale


SCENES = {
    "column": lambda: ds.scenes.column(5, friction=0.6),
    "pyramid": lambda: ds.scenes.pyramid(5, friction=0.6),
    "arch": lambda: ds.scenes.arch(15),
    "square pyramid": lambda: ds.scenes.square_pyramid(3, friction=0.6),
    "leaning wall": lambda: _under(ds.scenes.wall(6, friction=0.5), (0.3 * G, -G)),
}
SYMMETRIC = ["column", "pyramid", "arch", "square pyramid"]


def _under(scene: ds.Scene, gravity: tuple[float, ...]) -> ds.Scene:
    content = json.loads(scene.to_json())
    return ds.Scene.from_json(json.dumps({**content, "gravity": list(gravity)}))


def _reordered(scene: ds.Scene, seed: int) -> ds.Scene:
    content = json.loads(scene.to_json())
    np.random.default_rng(seed).shuffle(content["bodies"])
    return ds.Scene.from_json(json.dumps(content))


@pytest.mark.parametrize("name", SYMMETRIC)
def test_as_symmetric_as_the_structure(name: str) -> None:
    """Mirrored at its middle: the mirrored force at the mirrored point."""
    verdict = ds.check(SCENES[name]())
    centers = {body.name: np.array(body.centroid) for body in verdict.scene.bodies}
    moving = np.array([centers[name] for name in verdict.names])
    middle = (moving.min(axis=0) + moving.max(axis=0)) / 2
    ground = next(body.name for body in verdict.scene.bodies if body.fixed)
    centers[ground] = middle

    def key(*places: NDArray[np.float64]) -> tuple[float, ...]:
        return tuple((np.round(np.concatenate(places), 6) + 0.0).tolist())

    forces = {}
    for f in verdict.forces:
        a, b, point, force = centers[f.a], centers[f.b], np.array(f.point), np.array(f.force)
        forces[key(a, b, point)], forces[key(b, a, point)] = force, -force
    assert len(forces) == 2 * len(verdict.forces)
    scale = max(f.normal_force for f in verdict.forces)
    for axis in range(len(middle) - 1):
        flip = np.where(np.arange(len(middle)) == axis, -1.0, 1.0)
        shift = (1 - flip) * middle
        for f in verdict.forces:
            places = [centers[f.a], centers[f.b], np.array(f.point)]
            mirrored = forces[key(*(flip * place + shift for place in places))]
            assert np.abs(mirrored - flip * np.array(f.force)).max() <= 1e-9 * scale


@pytest.mark.parametrize("name", SCENES)
def test_the_same_for_every_method_order_and_past(name: str) -> None:
    scene = SCENES[name]()
    found = _named(scene)
    for method in ("lcp", "interior"):
        _same(found, _named(scene, ds.check(scene, method=method).forces))
    for seed in range(2):
        _same(found, _named(_reordered(scene, seed)))
    names = [body.name for body in scene.bodies if not body.fixed]
    structure = ds.Structure(scene, names)
    _same(found, _named(scene, structure.check().forces))
    for gone in (names[-2:], names[1:3]):
        structure.remove(*gone)
        structure.stands()
        structure.add(*reversed(gone))
    _same(found, _named(scene, structure.check().forces))


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_the_same_in_other_units(unit: float) -> None:
    """Lengths in other units: areas of joints, and with them masses, by the square."""

    def stack(unit: float) -> ds.Scene:
        scene = ds.Scene(friction=0.6)
        scene.add_box((0, -0.5 * unit), (4 * unit, unit), fixed=True, name="ground")
        for k, x in enumerate([-0.5, 0.5, 0.1]):
            scene.add_box((x * unit, (0.5 + k // 2) * unit), (unit, unit), name=str(k))
        return scene

    forces = np.array([f.force for f in ds.check(stack(1)).forces])
    other = np.array([f.force for f in ds.check(stack(unit)).forces])
    assert other == pytest.approx(forces * unit**2, rel=1e-9, abs=1e-9 * unit**2)


def test_a_straight_column_has_no_friction_and_no_lean() -> None:
    verdict = ds.check(ds.scenes.column(6, friction=0.6))
    assert max(abs(f.tangential_force) for f in verdict.forces) <= 1e-9
    for one, other in pairwise(verdict.forces):
        if (one.a, one.b) == (other.a, other.b):
            assert one.normal_force == pytest.approx(other.normal_force, rel=1e-9)


def test_a_brick_in_space_presses_on_its_four_corners_alike() -> None:
    scene = ds.Scene(dimension=3, friction=0.5)
    scene.add_box((0, 0, -0.5), (4, 4, 1), fixed=True, name="ground")
    scene.add_box((0, 0, 0.5), (2, 1, 1), name="brick")
    for method in ("equilibrium", "lcp", "interior"):
        forces = ds.check(scene, method=method).forces
        assert [f.normal_force for f in forces] == pytest.approx([2 * G / 4] * 4, rel=1e-9)


def test_seams_within_a_face_change_nothing() -> None:
    """A block of two pieces has more contact points, on the sides of the same rectangle."""

    def table(pieces: int) -> ds.Scene:
        scene = ds.Scene(dimension=3, friction=0.5)
        for x in (-1.0, 1.0):
            scene.add_box((x, 0, 0.5), (1, 1, 1), fixed=True, name=f"leg {x}")
        edges = np.linspace(-1.5, 1.5, pieces + 1)
        parts = [
            [(x, y, z) for x in pair for y in (-0.5, 0.5) for z in (1, 1.2)]
            for pair in pairwise(edges)
        ]
        scene.add_solid(parts, name="top")
        scene.add_box((0.3, 0.1, 1.45), (1, 0.5, 0.5), name="load")
        return scene

    one, other = (ds.check(table(pieces)) for pieces in (1, 4))
    scale = max(f.normal_force for f in one.forces)
    of = {tuple(np.round(f.point, 6)): np.array(f.force) for f in one.forces}
    for f in other.forces:
        expected = of.get(tuple(np.round(f.point, 6)), np.zeros(3))
        assert np.abs(np.array(f.force) - expected).max() <= 1e-9 * scale


def _layer(
    points: NDArray[np.float64], least: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The middle of a planar face, and Q^-1 of it for (N, T, M)."""
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    one, other = np.unravel_index(apart.argmax(), apart.shape)
    length = max(apart.max(), least)
    return (points[one] + points[other]) / 2, np.array([length, length, length**3 / 12])


def _least_norm(scene: ds.Scene) -> dict[tuple[str, str], NDArray[np.float64]]:
    """(N, T, M) of every pair of a planar scene in which pairs touch on one plane each.

    By least distance programming: min |w| over A w >= 0 and C w = h, w the wrenches in units of
    Q^1/2. With the solutions of the equations as w0 + Z v it is the least |v| of A Z v >= -A w0,
    which Lawson and Hanson (1974, chapter 23) make a problem of nonnegative least squares.
    """
    bodies = {body.name: body for body in scene.bodies}
    moving = [body.name for body in scene.bodies if not body.fixed]
    pairs: dict[tuple[str, str], list[ds.Contact]] = {}
    for contact in scene.contacts:
        pairs.setdefault((contact.a, contact.b), []).append(contact)
    balance = np.zeros((3 * len(moving), 3 * len(pairs)))
    cones, roots = [], []
    for k, ((a, b), contacts) in enumerate(pairs.items()):
        points = np.array([contact.point for contact in contacts])
        sizes = [
            np.linalg.norm(bodies[x].vertices - bodies[x].centroid, axis=1).max() for x in (a, b)
        ]
        middle, stiffness = _layer(points, 0.1 * min(sizes))
        root = np.sqrt(stiffness)
        n = np.array(contacts[0].normal)
        t = np.array([-n[1], n[0]])
        for name, sign in ((a, -1.0), (b, 1.0)):
            if name in moving:
                r = middle - bodies[name].centroid
                rows = slice(3 * moving.index(name), 3 * moving.index(name) + 3)
                arm = [r[0] * n[1] - r[1] * n[0], r[0] * t[1] - r[1] * t[0], 1.0]
                wrench = np.array([[n[0], t[0], 0], [n[1], t[1], 0], arm])
                balance[rows, 3 * k : 3 * k + 3] = sign * wrench * root
        ends = (points - middle) @ t
        mu = contacts[0].friction
        rows_of = [[mu, 1, 0], [mu, -1, 0]]
        rows_of += [
            [ends.max(), 0, sign] if sign > 0 else [-ends.min(), 0, sign] for sign in (1, -1)
        ]
        own = np.zeros((4, 3 * len(pairs)))
        # The moment of a normal force N at s along t is -N s.
        own[:, 3 * k : 3 * k + 3] = np.array(rows_of) * root
        cones.append(own)
        roots.append(root)
    load = np.concatenate([[0, bodies[name].mass * G, 0] for name in moving])
    w0, *_ = np.linalg.lstsq(balance, load, rcond=None)
    _, singular, turned = np.linalg.svd(balance)
    rank = int((singular > 1e-10 * singular[0]).sum())
    free = turned[rank:].T
    inequalities = np.concatenate(cones)
    inequalities /= np.linalg.norm(inequalities, axis=1)[:, None]
    scale = np.abs(w0).max()
    a, b = inequalities @ free, -inequalities @ w0 / scale
    e = np.vstack([a.T, b])
    target = np.zeros(len(e))
    target[-1] = 1.0
    u, _ = nnls(e, target, maxiter=10000)
    r = e @ u - target
    w = w0 + free @ (-r[:-1] / r[-1]) * scale
    return {pair: w[3 * k : 3 * k + 3] * roots[k] for k, pair in enumerate(pairs)}


@pytest.mark.parametrize(
    "scene",
    [
        ds.scenes.column(4, friction=0.6),
        ds.scenes.pyramid(4, friction=0.6),
        ds.scenes.pyramid(4, friction=0.3),
        ds.scenes.arch(9),
        ds.scenes.wall(3, friction=0.5),
        ds.scenes.random_stack(8),
    ],
    ids=["column", "pyramid", "slippery pyramid", "arch", "wall", "random stack"],
)
def test_the_same_as_by_least_distance_programming(scene: ds.Scene) -> None:
    expected = _least_norm(scene)
    verdict = ds.check(scene)
    scale = max(np.abs(wrench[0]) for wrench in expected.values())
    for pair, wrench in expected.items():
        own = [f for f in verdict.forces if (f.a, f.b) == pair]
        normal = sum(f.normal_force for f in own)
        tangential = sum(f.tangential_force for f in own)
        assert [normal, tangential] == pytest.approx(wrench[:2], abs=1e-7 * scale), pair


def test_what_falls_has_forces_that_give_its_accelerations() -> None:
    scene = ds.scenes.five_blocks()
    for blocks in (["1", "3"], ["1", "2", "3", "5"]):
        verdict = ds.check(scene, blocks)
        if verdict.stable:
            continue
        found = np.array([f.force for f in verdict.forces])
        for name, row in zip(verdict.names, verdict.accelerations, strict=True):
            total = sum(
                (1 if f.b == name else -1) * np.array(f.force)
                for f in verdict.forces
                if name in (f.a, f.b)
            )
            mass = scene.body(name).mass
            assert total + np.array([0, -mass * G]) == pytest.approx(mass * row[:2], abs=1e-8)
        other = ds.check(scene, blocks, "lcp")
        assert np.array([f.force for f in other.forces]) == pytest.approx(found, abs=1e-8)


def test_any_forces_are_those_of_the_method() -> None:
    scene = ds.scenes.pyramid(4, friction=0.6)
    canonical = ds.check(scene)
    any_of = ds.check(scene, forces="any")
    structure = ds.Structure(scene, canonical.names)
    assert any_of.forces == ds.check(scene, forces="any").forces != canonical.forces
    assert structure.check(forces="any").forces != canonical.forces
    with pytest.raises(ValueError, match="unknown forces 'some'"):
        ds.check(scene, forces="some")


def test_a_verdict_is_pickled_with_its_forces() -> None:
    verdict = ds.check(ds.scenes.pyramid(3))
    again = pickle.loads(pickle.dumps(verdict))
    assert again.forces == verdict.forces
    assert again.borders == verdict.borders
    assert str(again) == str(verdict)


@pytest.mark.parametrize("name", ["column", "pyramid", "square pyramid"])
def test_a_world_at_rest_shows_them_and_carries_its_own(name: str) -> None:
    scene = SCENES[name]()
    expected = {key: value for key, value in _named(scene).items() if abs(value) > 1e-9}
    world, untold = ds.World(scene), ds.World(scene)
    for _ in range(3):
        world.step()
        untold.step()
        shown = _named(scene, world.forces)
        _same(expected, {key: shown.get(key, 0.0) for key in expected})
    assert world.snapshot() == untold.snapshot()
    recorded = ds.simulate(scene, steps=2, forces=True)
    told = np.array([f.force for f in world.forces])
    assert recorded.forces[recorded.force_starts[1] :] == pytest.approx(told, abs=1e-9)


def test_a_plan_page_shows_them_and_what_hands_bear() -> None:
    plan = ds.plan(SCENES["pyramid"]())
    forces = plan_recording(plan).forces
    assert forces is not None
    whole = np.asarray(forces.vectors)[: forces.offsets[1]]
    of_check = [f.force for f in ds.check(plan.scene).forces if any(f.force)]
    assert whole == pytest.approx(np.array(of_check), abs=1e-9)
    held = ds.plan(ds.scenes.arch(7), hold=1)
    captions = dict(plan_recording(held).captions)
    step = next(step for step, names in enumerate(held.holds) if names)
    assert f"The hand on {held.holds[step][0]} bears" in captions[step]


def test_the_command_line_computes_them_of_scenes_that_are_not_too_large(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def kind(*options: str) -> str:
        assert run(["check", "pyramid:3", "--json", *options]) == 0
        return str(json.loads(capsys.readouterr().out)["forces_kind"])

    assert [kind(), kind("--forces", "any")] == ["canonical", "any"]

    def kind_of_plan() -> str:
        assert run(["plan", "pyramid:3", "--json"]) == 0
        return str(json.loads(capsys.readouterr().out)["whole"]["forces_kind"])

    assert kind_of_plan() == "canonical"
    monkeypatch.setattr("drystone.cli.forces.MOST_POINTS", 10)
    assert [kind(), kind("--forces", "canonical")] == ["any", "canonical"]
    assert kind_of_plan() == "any"


def test_the_kind_says_where_they_are_not_found() -> None:
    verdict = ds.check(ds.scenes.wall(3, 3), forces="any")
    found = verdict.forces._core

    class Unfound:
        """Of a structure for which they cannot be found."""

        def canonical(self) -> None:
            return None

        def any(self) -> object:
            return found

    forces = ds.ContactForces(Unfound(), "canonical")  # type: ignore[arg-type]
    assert forces.kind == "any"
    assert forces == verdict.forces
    assert ds.check(ds.scenes.wall(3, 3)).forces.kind == "canonical"


def test_an_arch_in_space_is_found_to_stand_with_them() -> None:
    """Its joints neither part nor slide: no pivot, no iteration, and no other forces are looked
    for. They are those of the other methods."""
    scene = ds.scenes.arch(15).extruded(0.4)
    verdict = ds.check(scene)
    assert verdict.stable
    assert (verdict.pivots, verdict.iterations) == (0, 0)
    _same(_named(scene, verdict.forces), _named(scene, ds.check(scene, forces="any").forces))
    _same(_named(scene, verdict.forces), _named(scene, ds.check(scene, method="interior").forces))
    falls = ds.check(ds.scenes.arch(15, thickness=0.08).extruded(0.4))
    assert (falls.stable, falls.status) == (False, "solved")
