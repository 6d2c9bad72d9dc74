"""The simulation benchmark: its measures, and that every simulator moves the scene it is given."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
import pytest

import drystone as ds

BENCHMARKS = str(Path(__file__).parents[2] / "benchmarks")
sys.path.insert(0, BENCHMARKS)

import hard_scene_list  # noqa: E402
import hard_scenes  # noqa: E402
import heaps  # noqa: E402
import heaps_in_plane  # noqa: E402
import impacts  # noqa: E402
import judge  # noqa: E402
import simulation  # noqa: E402
from simulators import SIMULATORS  # noqa: E402

sys.path.remove(BENCHMARKS)


def _two(offset: float, angle: float = 0.0) -> tuple[judge.Boxes, np.ndarray]:
    """Unit squares whose centres are so far apart, the second one turned."""
    scene = ds.Scene()
    scene.add_box(center=(0, 0), size=(1, 1), name="left", density=2.0)
    scene.add_box(center=(3, 0), size=(1, 1), name="right")
    frame = np.zeros((1, 2, 6))
    frame[0, 1, :3] = offset, 0.0, angle
    return judge.Boxes.of(scene), frame


@pytest.mark.parametrize(
    ("offset", "angle", "depth"),
    [(1.25, 0.0, 0.0), (0.75, 0.0, 0.25), (1.0, math.pi / 4, 0.5**0.5 - 0.5), (1.25, 0.78, 0.0)],
)
def test_penetration_of_two_squares(offset: float, angle: float, depth: float) -> None:
    assert judge.penetration(*_two(offset, angle)) == pytest.approx(depth, abs=1e-15)


def test_energy_rise_and_displacement() -> None:
    boxes, frame = _two(1.5)
    frames = np.repeat(frame, 4, axis=0)
    frames[:, 0, 1] = 0.0, -0.5, -0.25, -0.5  # Falls, rises by a quarter of a metre, falls again.
    frames[3, 1, 5] = 1.0  # And the other begins to turn.
    assert judge.energy_rise(boxes, frames) == pytest.approx(2.0 * 9.81 * 0.25)
    assert judge.displacement(frames, np.array([True, False])) == 0.5
    assert math.isnan(judge.displacement(frames, np.array([False, False])))


def _cubes(offset: tuple[float, float, float], turned: tuple[float, ...]) -> float:
    """How deep two unit cubes are in one another, the second turned by a quaternion."""
    scene = ds.Scene(dimension=3)
    scene.add_box((0, 0, 0), (1, 1, 1))
    scene.add_box((3, 0, 0), (1, 1, 1))
    frame = np.zeros((1, 2, 13))
    frame[0, :, 3] = 1.0
    frame[0, 1, :3], frame[0, 1, 3:7] = offset, turned
    return judge.penetration(judge.Boxes.of(scene), frame)


def test_penetration_of_two_cubes() -> None:
    straight, half = (1.0, 0.0, 0.0, 0.0), math.pi / 8
    about_z = (math.cos(half), 0.0, 0.0, math.sin(half))
    assert _cubes((1.25, 0, 0), straight) == 0.0
    assert _cubes((0.75, 0.1, 0.2), straight) == pytest.approx(0.25, abs=1e-15)
    assert _cubes((1.0, 0, 0), about_z) == pytest.approx(0.5**0.5 - 0.5, abs=1e-15)
    # Edge over edge: the upper edge of the first along y, the lower one of the other along x.
    lower = math.sqrt(2)
    frame = np.zeros((1, 2, 13))
    frame[0, 0, 3:7] = math.cos(half), 0.0, math.sin(half), 0.0
    frame[0, 1, 3:7] = math.cos(half), math.sin(half), 0.0, 0.0
    scene = ds.Scene(dimension=3)
    scene.add_box((0, 0, 0), (1, 1, 1))
    scene.add_box((3, 0, 0), (1, 1, 1))
    for height, depth in [(lower + 0.01, 0.0), (lower - 0.01, 0.01)]:
        frame[0, 1, 2] = height
        assert judge.penetration(judge.Boxes.of(scene), frame) == pytest.approx(depth, abs=1e-12)


def test_energy_in_space() -> None:
    """A brick that turns about its long side, wherever that points."""
    scene = ds.Scene(dimension=3, gravity=(0, 0, 0))
    scene.add_box((0, 0, 0), (3, 1, 2))
    frames = np.zeros((2, 1, 13))
    half = math.pi / 4  # The long side along y.
    frames[:, 0, 3], frames[:, 0, 6] = math.cos(half), math.sin(half)
    frames[1, 0, 11] = 2.0
    boxes = judge.Boxes.of(scene)
    assert judge.energy_rise(boxes, frames) == pytest.approx(0.5 * 6 * (1 + 4) / 12 * 4)


@pytest.mark.parametrize("key", [key for key in SIMULATORS if 3 in SIMULATORS[key].dimensions])
def test_simulators_in_space(key: str) -> None:
    """A turned box that spins falls freely for a twentieth of a second."""
    simulator = SIMULATORS[key]
    if simulator.missing():
        pytest.skip(simulator.missing())
    scene = ds.Scene(dimension=3)
    scene.add_box((0, 0, -0.5), (9, 9, 1), name="ground", fixed=True)
    scene.add_box((1, 2, 3), (1, 0.5, 0.25), orientation=(0.6, 0, 0.8, 0), name="block")
    motion = simulator.run(scene, 0.001, 50, 25)
    begin, end = motion.frames[0], motion.frames[-1]
    assert motion.frames.shape == (3, 2, 13)
    assert begin[1] == pytest.approx([1, 2, 3, 0.6, 0, 0.8, 0, *6 * [0]])
    fallen = 0.5 * 9.81 * 0.05**2
    expected = [1, 2, 3 - fallen, 0.6, 0, 0.8, 0, 0, 0, -9.81 * 0.05, 0, 0, 0]
    assert end[1] == pytest.approx(expected, abs=3e-4)


@pytest.mark.parametrize("key", SIMULATORS)
def test_every_simulator_moves_the_scene(key: str) -> None:
    """A turned box falls freely for a twentieth of a second, at the rates said."""
    simulator = SIMULATORS[key]
    if simulator.missing():
        pytest.skip(simulator.missing())
    if key == "rapier" and not simulator.built():
        pytest.skip("benchmarks/rapier is not built")
    scene = ds.Scene(friction=0.5)
    scene.add_box(center=(0, -0.5), size=(9, 1), name="ground", fixed=True)
    scene.add_box(center=(1, 2), size=(1, 0.5), angle=0.25, name="block")
    motion = simulator.run(scene, 0.001, 50, 25)
    assert not motion.stopped
    assert motion.seconds > 0
    begin, end = motion.frames[0], motion.frames[-1]
    assert len(motion.frames) == 3
    assert begin[1] == pytest.approx([1, 2, 0.25, 0, 0, 0])
    assert end[0] == pytest.approx([0, -0.5, 0, 0, 0, 0])
    fallen = 0.5 * 9.81 * 0.05**2
    assert end[1] == pytest.approx([1, 2 - fallen, 0.25, 0, -9.81 * 0.05, 0], abs=3e-4)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_scene_measured_in_turns(dimension: int) -> None:
    peers = {key: SIMULATORS[key] for key in ("full", "none")}
    case = simulation.measure("fall7", 240, peers, rounds=2, dimension=dimension)
    assert case.blocks == 7
    for result in case.results.values():
        assert len(result.times) == 2
        assert (result.displacement, result.stopped) == (0.0, "")
        assert result.penetration < 1e-12
        assert result.energy_rise < 1e-9
    assert case.ratio(case.results["full"]) == 1.0


def test_heaps_that_are_timed_obey_the_law() -> None:
    line = heaps.line(heaps.heap(10), 240)
    assert (line[2], len(line)) == ("0 of 240", 5)


def test_heaps_in_the_plane_obey_the_law() -> None:
    """Of 100 boxes too, of which one step in 720 was left to no method."""
    ours = heaps_in_plane.SIMULATORS["drystone"]
    lines = [next(heaps_in_plane.measure(boxes, 0.8, [ours])) for boxes in (25, 100)]
    assert [line["not_exact"] for line in lines] == [0, 0]
    assert set(lines[0]) == set(heaps_in_plane.COLUMNS)
    assert 0 < heaps_in_plane.exponent(lines, 0.8, ours.name) < 3


def test_hard_scenes_are_judged() -> None:
    lines = {
        name: next(hard_scenes.measure(name, [SIMULATORS["full"]]))
        for name in ("arch", "card house, 5")
    }
    for line in lines.values():
        assert (line["fallen"], line["drift"], line["penetration"], line["should"]) == (
            0,
            "0",
            "0",
            "stand",
        )
        assert set(line) == set(hard_scenes.COLUMNS)
    hard = hard_scene_list.overlap_recovery()
    frame = np.zeros((1, len(hard.scene), 6))
    frame[0, :, :2] = [body.center_of_mass for body in hard.scene.bodies]
    assert hard_scenes.deepest(hard.scene, frame) == pytest.approx(0.25)
    frame[0, 1:, 1] -= 0.3
    frame[0, 1, 2] = math.pi
    assert hard_scenes.fallen(hard, frame[0]) == 10


@pytest.mark.parametrize("key", SIMULATORS)
def test_every_simulator_throws_a_polygon(key: str) -> None:
    """A triangle that is thrown flies and turns for a twentieth of a second."""
    simulator = SIMULATORS[key]
    if simulator.missing():
        pytest.skip(simulator.missing())
    if key == "rapier" and not simulator.built():
        pytest.skip("benchmarks/rapier is not built")
    scene = ds.Scene(friction=0.5, gravity=(0, 0))
    scene.add_box(center=(0, -0.5), size=(9, 1), name="ground", fixed=True)
    scene.add_polygon([(0, 1), (3, 1), (0, 2.5)], name="triangle")
    motion = simulator.run(scene, 0.001, 50, 25, {"triangle": (1.0, 0.5, 2.0)})
    assert motion.frames[-1][1] == pytest.approx([1.05, 1.525, 0.1, 1, 0.5, 2], rel=1e-6)


def test_heaps_that_tumble_leave_no_overlaps() -> None:
    """Solids that cross have one contact at a time, another after each round of taking back."""
    run = ds.simulate(heaps.heap(54), heaps.DT, 360)
    assert run.penetration.max() < 1e-6
    assert run.projections.max() < 10


def test_what_is_hit_is_measured() -> None:
    ours = [heaps_in_plane.SIMULATORS["drystone"]]
    for name, kind in impacts.KINDS.items():
        (line,) = impacts.measure(name, kind.sizes[0], ours)
        assert set(line) == set(impacts.COLUMNS)
        assert float(str(line["microseconds"])) > 0
