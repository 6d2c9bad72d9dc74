"""Must it stand? `check(strong=True)` beside closed forms, laws, and a mixed-integer program."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import drystone as ds
from conftest import Ran
from contact_laws import check_escape, cut_stone, most_power


def between_walls(lean: float, friction: float = 0.84) -> ds.Scene:
    """A block 2 m high between two walls that lean by an angle; it widens downwards where that is
    positive, and nothing is below it."""
    k = math.tan(math.radians(lean))
    scene = ds.Scene(friction=friction)
    scene.add_polygon([(-1 - k, 0), (1 + k, 0), (1 - k, 2), (-1 + k, 2)], name="block")
    for name, side in (("left", -1), ("right", 1)):
        corners = [(side * (1 + 2 * k), -1), (side * 6, -1), (side * 6, 3), (side * (1 - 2 * k), 3)]
        scene.add_polygon(corners[::side], name=name, fixed=True)
    return scene


def turned(scene: ds.Scene, degrees: float) -> ds.Scene:
    """The same with gravity turned."""
    a = math.radians(degrees)
    return scene.with_gravity((9.81 * math.sin(a), -9.81 * math.cos(a)))


def plank(degrees: float, friction: float) -> ds.Scene:
    """A plank of 2 m that leans on a wall."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    corners = [(c * x - s * y, s * x + c * y) for x, y in ((0, 0), (2, 0), (2, 0.1), (0, 0.1))]
    right = max(x for x, _ in corners)
    scene = ds.Scene(friction=friction)
    scene.add_polygon([(-5, -1), (5, -1), (5, 0), (-5, 0)], name="floor", fixed=True)
    wall = [(right, 0), (right + 1, 0), (right + 1, 5), (right, 5)]
    scene.add_polygon(wall, name="wall", fixed=True)
    scene.add_polygon(corners, name="plank")
    return scene


def test_what_stands_without_friction_must_stand() -> None:
    scenes = [
        ds.scenes.column(2),
        ds.scenes.column(11),
        ds.scenes.pyramid(5),
        ds.scenes.wall(rows=10, columns=10),
        between_walls(-20.0),
        ds.scenes.square_pyramid(3),
    ]
    for scene in scenes:
        verdict = ds.check(scene, strong=True)
        assert verdict.stable
        assert verdict.must_stand
        assert verdict.escape is None
        assert verdict.nodes == 1
        assert str(verdict).startswith("Must stand: ")


@pytest.mark.parametrize("lean", [0.0, 10.0, 25.0])
def test_a_block_that_hangs_between_walls_can_also_fall_freely(lean: float) -> None:
    scene = between_walls(lean)
    verdict = ds.check(scene, strong=True)
    assert verdict.stable
    assert verdict.certain
    assert verdict.must_stand is False
    assert verdict.escape is not None
    assert verdict.escape.falling == ("block",)
    assert verdict.escape.acceleration("block") == pytest.approx([0, -9.81, 0], abs=1e-9)
    check_escape(scene, verdict.escape)
    assert "need not" in str(verdict)


def needing_friction() -> dict[str, ds.Scene]:
    return {
        "slope": turned(ds.scenes.column(2, friction=0.5), 26.0),
        "plank": plank(60.0, 0.5),
        "steep plank": plank(75.0, 0.3),
        "arch of 5": ds.scenes.arch(voussoirs=5, thickness=0.2, friction=0.7),
        "arch of 20": ds.scenes.arch(voussoirs=20, thickness=0.2, friction=0.7),
        "row": turned(ds.scenes.wall(rows=1, columns=3, friction=0.7), 10.0),
        "wall": turned(ds.scenes.wall(rows=2, columns=2, friction=0.7), 20.0),
    }


@pytest.mark.parametrize("name", needing_friction())
def test_what_needs_friction_and_must_stand(name: str) -> None:
    scene = needing_friction()[name]
    without = ds.Scene(friction=0.0, gravity=scene.gravity)
    for body in scene.bodies:
        without.add_polygon(body.vertices, name=body.name, fixed=body.fixed, friction=0.0)
    assert not ds.check(without).stable
    verdict = ds.check(scene, strong=True)
    assert verdict.stable
    assert verdict.must_stand is True
    assert verdict.nodes is not None
    assert verdict.nodes <= 20


def test_courses_bear_what_no_single_face_must() -> None:
    """Under its neighbours' arching each face of a course may bear nothing."""
    for rows, columns, most in ((2, 3, 5), (3, 3, 150)):
        wall = turned(ds.scenes.wall(rows=rows, columns=columns, friction=0.5), 10.0)
        verdict = ds.check(wall, strong=True)
        assert verdict.must_stand
        assert verdict.nodes is not None
        assert verdict.nodes <= most


def test_a_slope_at_its_limit() -> None:
    """tan(angle) = mu, a little less and a little more: it slides with g (sin - mu cos)."""
    mu = 0.5
    limit = math.degrees(math.atan(mu))
    assert ds.check(turned(ds.scenes.column(2, friction=mu), limit - 1e-3), strong=True).must_stand
    scene = turned(ds.scenes.column(2, friction=mu), limit + 5.0)
    verdict = ds.check(scene, strong=True)
    assert not verdict.stable
    assert verdict.must_stand is False
    assert verdict.escape is not None
    a = math.radians(limit + 5.0)
    slides = 9.81 * (math.sin(a) - mu * math.cos(a))
    assert verdict.escape.acceleration("1") == pytest.approx([slides, 0, 0], abs=1e-6)
    check_escape(scene, verdict.escape)


def test_random_structures_beside_a_mixed_integer_program() -> None:
    decided = agreed = hung = 0
    for seed in range(150):
        scene = cut_stone(seed)
        if not ds.check(scene).stable:
            continue
        verdict = ds.check(scene, strong=True)
        decided += 1
        assert verdict.must_stand is not None, seed
        if verdict.escape is not None:
            hung += 1
            check_escape(scene, verdict.escape)
        if len(scene.contacts) > 8:
            continue
        power = most_power(scene, 10.0)
        if power is not None:
            agreed += 1
            # Its integers are off by up to 1e-6.
            assert verdict.must_stand == (power < 1e-5), seed
    assert decided >= 30
    assert hung >= 5
    assert agreed >= 15


def test_a_budget_is_kept() -> None:
    scene = turned(ds.scenes.wall(rows=3, columns=3, friction=0.5), 20.0)
    verdict = ds.check(scene, strong=True, strong_budget=2)
    assert verdict.stable
    assert verdict.must_stand is None
    assert verdict.nodes == 2
    assert "undecided whether it must" in str(verdict)
    with pytest.raises(ValueError, match="strong_budget"):
        ds.check(scene, strong=True, strong_budget=0)


def test_a_search_says_how_far_it_is_and_may_be_left() -> None:
    """By default the budget is an effort, of which the root of this wall alone takes a part that
    no count of nodes would show."""
    scene = turned(ds.scenes.wall(rows=4, columns=4, friction=0.5), 10.0)
    told: list[tuple[int, float]] = []

    class EnoughError(Exception):
        pass

    def progress(nodes: int, share: float) -> None:
        told.append((nodes, share))
        if share > 0.02:
            raise EnoughError

    with pytest.raises(EnoughError):
        ds.check(scene, strong=True, progress=progress)
    assert told[0][0] == 1
    assert 0.0 < told[0][1] < told[-1][1] <= 0.2
    told.clear()
    with pytest.raises(EnoughError):
        ds.check(scene, strong=True, strong_budget=49, progress=progress)
    assert told[-1] == (2, pytest.approx(1 / 49))
    with pytest.raises(TypeError, match="progress"):
        ds.check(scene, strong=True, progress=7)  # type: ignore[arg-type]


def with_gaps(scene: ds.Scene, random: np.random.Generator, gap: float = 1e-8) -> ds.Scene:
    """Every corner of a block moved towards its centroid by up to a gap, m."""
    apart = ds.Scene(friction=scene.friction, gravity=scene.gravity)
    for body in scene.bodies:
        corners = np.asarray(body.vertices)
        if not body.fixed:
            inward = np.asarray(body.centroid) - corners
            inward /= np.linalg.norm(inward, axis=1)[:, None]
            corners = corners + gap * random.uniform(0.1, 1.0, (len(corners), 1)) * inward
        apart.add_polygon(corners, name=body.name, fixed=body.fixed, friction=body.friction)
    return apart


def test_joints_that_close_first_drop_what_need_not_stand_and_nothing_else() -> None:
    must = needing_friction()
    scenes = {True: [must["arch of 5"], must["wall"]], False: [between_walls(10.0)]}
    for seed in range(40):
        scene = cut_stone(seed)
        verdict = ds.check(scene, strong=True)
        if verdict.stable and (not verdict.must_stand or ds.margin(scene).acceleration > 1e-3):
            scenes[bool(verdict.must_stand)].append(scene)
    for stands, some in scenes.items():
        assert len(some) >= 2
        for run, scene in enumerate(some):
            apart = with_gaps(scene, np.random.default_rng(run))
            moved = ds.simulate(apart, steps=240)
            way = np.abs(moved.poses[-1] - moved.poses[0])[:, :2].max()
            assert (way < 1e-6) == stands, (stands, run, way)


def test_parts_and_what_was_not_asked() -> None:
    scene = between_walls(10.0)
    scene.add_polygon([(20, 0), (21, 0), (21, 1), (20, 1)], name="aside")
    scene.add_polygon([(19, -1), (22, -1), (22, 0), (19, 0)], name="floor", fixed=True)
    assert ds.check(scene, ["aside"], strong=True).must_stand is True
    assert ds.check(scene, ["block"], strong=True).must_stand is False
    plain = ds.check(scene)
    assert plain.must_stand is None
    assert plain.nodes is None
    assert "must_stand" not in plain.to_dict()
    assert str(plain).startswith("Stands: ")


def in_space(between: ds.Scene) -> ds.Scene:
    """Planar bodies, 1 m deep."""
    scene = ds.Scene(dimension=3, friction=0.84)
    for body in between.bodies:
        corners = [(x, y, z) for x, z in body.vertices for y in (0.0, 1.0)]
        scene.add_polyhedron(corners, name=body.name, fixed=body.fixed)
    return scene


def test_in_space() -> None:
    """What stands without friction, and what a step from rest moves; the rest is left open."""
    hung = ds.check(in_space(between_walls(10.0)), strong=True)
    assert hung.stable
    assert hung.must_stand is False
    assert hung.escape is not None
    falls = [0, 0, -9.81, 0, 0, 0]
    assert hung.escape.acceleration("block") == pytest.approx(falls, abs=1e-6)
    assert ds.check(in_space(between_walls(-20.0)), strong=True).must_stand is True
    tilted = ds.Scene(dimension=3, friction=0.5, gravity=(2.0, 0.0, -9.6))
    tilted.add_box((0, 0, -0.5), (3, 3, 1), name="floor", fixed=True)
    tilted.add_box((0, 0, 0.5), (1, 1, 1), name="box")
    verdict = ds.check(tilted, strong=True)
    assert verdict.stable
    assert verdict.must_stand is None


def test_plans_of_structures_that_must_stand() -> None:
    """Each step of a tilted wall must stand; what hangs between walls need not, as a whole."""
    scene = turned(ds.scenes.wall(rows=2, columns=2, friction=0.7), 10.0)
    plan = ds.plan(scene, strong=True)
    assert plan.found
    assert plan.strong
    assert "each must stand" in str(plan)
    assert plan.to_dict()["strong"] is True
    for k in range(len(plan.order)):
        assert ds.check(scene, plan.order[k:], strong=True).must_stand
    hangs = ds.plan(between_walls(10.0), strong=True)
    assert hangs.status == "whole_falls"
    assert str(hangs).startswith("No order: the complete assembly need not stand")
    assert ds.plan(between_walls(10.0)).found


def test_what_hangs_comes_after_what_bears_it() -> None:
    """A block between two leaning walls with a foot below it: the foot has to come first."""
    scene = between_walls(10.0)
    scene.add_box((0.0, -0.5), (0.5, 1.0), name="a foot")
    scene.add_box((0.0, -1.5), (12.0, 1.0), name="ground", fixed=True)
    assert ds.check(scene, ["block"]).stable
    assert ds.check(scene, ["block"], strong=True).must_stand is False
    plan = ds.plan(scene, strong=True)
    assert plan.found
    assert plan.order == ("block", "a foot")


def test_what_does_not_go_with_strong() -> None:
    scene = ds.scenes.column(3)
    for wrong in ({"hold": 1}, {"margin": 0.1}, {"order": "robust"}, {"test": "lcp"}):
        with pytest.raises(ValueError, match="strong"):
            ds.plan(scene, strong=True, **wrong)  # type: ignore[arg-type]


def test_the_same_search_in_every_run() -> None:
    scene = turned(ds.scenes.wall(rows=2, columns=2, friction=0.7), 20.0)
    first, second = (ds.check(scene, strong=True) for _ in range(2))
    assert first.nodes == second.nodes


def test_the_command_line(cli: Callable[..., Ran], tmp_path: Path) -> None:
    for name, scene in {"hangs": between_walls(10.0), "stands": ds.scenes.column(3)}.items():
        scene.save(tmp_path / f"{name}.json")
    hangs, picture = tmp_path / "hangs.json", tmp_path / "escape.svg"
    assert cli("check", hangs).status == 0
    found = cli("check", hangs, "--strong", "--json", "--output", picture)
    assert found.status == 1
    told = json.loads(found.out)
    assert told["must_stand"] is False
    assert told["nodes"] >= 1
    assert np.allclose(told["escape"]["accelerations"]["block"], [0, -9.81, 0], atol=1e-9)
    assert "m/s²" in picture.read_text(encoding="utf-8")
    assert cli("check", tmp_path / "stands.json", "--strong").status == 0
    assert "--strong" in cli("check", hangs, "--strong-budget", "5").err
    wall = tmp_path / "wall.json"
    turned(ds.scenes.wall(rows=3, columns=2, friction=0.7), 10.0).save(wall)
    planned = cli("plan", wall, "--strong", "--json")
    assert planned.status == 0
    assert json.loads(planned.out)["strong"] is True
    assert cli("plan", hangs, "--strong").status == 1
    for wrong in (("--hold", "1"), ("--margin", "0.1"), ("--test", "lcp")):
        refused = cli("plan", wall, "--strong", *wrong)
        assert refused.status == 2
        assert "--strong" in refused.err
    turned(ds.scenes.wall(rows=3, columns=3, friction=0.5), 20.0).save(wall)
    open_question = cli("check", wall, "--strong", "--strong-budget", "1")
    assert open_question.status == 2
    assert "not decided whether it must stand" in open_question.err


def test_a_quarter_turn_of_all_velocities_tells_what_faces_bear_times_how_fast_they_slide() -> None:
    """sum f_n a_t = sum F' R a + alpha V, (5) of docs/theory/strong-stability.md, of escapes."""
    told = 0
    for seed in range(60):
        scene = cut_stone(seed)
        escape = ds.check(scene, strong=True).escape
        if escape is None:
            continue
        bodies = {body.name: body for body in scene.bodies}
        names = [body.name for body in scene.bodies]
        still = np.zeros(3)
        motion = {n: escape.acceleration(n) if n in escape.names else still for n in names}
        virial, slides, size = dict.fromkeys(names, 0.0), 0.0, 0.0
        forces = escape.forces
        for (a, b), point, n, f in zip(
            forces.bodies, forces.points, forces.normals, forces.vectors, strict=True
        ):
            relative = np.zeros(2)
            for name, sign in ((names[a], -1.0), (names[b], 1.0)):
                arm = point - np.array(bodies[name].center_of_mass)
                x, y, turn = motion[name]
                relative += sign * np.array([x - turn * arm[1], y + turn * arm[0]])
                virial[name] += sign * float(f @ arm)
            slides += float(f @ n) * float(relative @ [-n[1], n[0]])
            size += float(np.linalg.norm(f)) * float(np.linalg.norm(relative))
        turned_loads = 0.0
        for name in escape.names:
            x, y, turn = motion[name]
            load = bodies[name].mass * np.array(scene.gravity)
            turned_loads += float(load @ [-y, x]) + turn * virial[name]
            size += float(np.linalg.norm(load)) * math.hypot(x, y) + abs(turn * virial[name])
        assert slides == pytest.approx(turned_loads, abs=1e-7 * size), seed
        told += size > 0 and abs(slides) > 1e-3 * size
    assert told >= 3


@pytest.mark.parametrize(
    ("rows", "columns", "degrees", "friction"),
    [(3, 3, 5, 0.5), (3, 3, 10, 0.5), (4, 3, 5, 0.5), (3, 4, 5, 0.7)],
)
def test_tilted_walls_must_stand_as_they_do_upright(
    rows: int, columns: int, degrees: float, friction: float
) -> None:
    """By turned loads, in the root or soon after: 45 to 1,855 nodes without."""
    wall = turned(ds.scenes.wall(rows=rows, columns=columns, friction=friction), degrees)
    verdict = ds.check(wall, strong=True, strong_budget=10)
    assert verdict.must_stand is True
