"""Recordings and pages: what they hold, how large they are, what is refused."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, get_type_hints

import numpy as np
import pytest
from matplotlib.patches import FancyArrow

import drystone as ds
from conftest import ROOT, Ran, orderless
from drystone import _core, pictures
from drystone.pictures.axonometry import rotation
from drystone.recording import budget, contract
from drystone.recording.contract import ABSENT, FALLING, MOTIONLESS, NEXT, PRESENT, unpacked
from drystone.recording.of_plan import plan_recording
from drystone.recording.recording import FrameForces, Recording, Series
from drystone.viewer import page

FIXTURES = {
    ROOT / "viewer" / "test" / "plan.json": lambda: ds.scenes.five_blocks(),
    ROOT / "viewer" / "test" / "space" / "plan.json": lambda: ds.scenes.column(2).extruded(),
}
"""Plans as Python writes them, in the plane and in space, which the front end's tests read."""


def _form(value: Any) -> Any:
    """JSON without its values: keys, types, and of packed arrays the type and the axes."""
    if isinstance(value, dict) and set(value) == {"dtype", "shape", "data"}:
        return value["dtype"], unpacked(value).ndim
    if isinstance(value, dict):
        return {key: _form(part) for key, part in value.items()}
    if isinstance(value, list):
        return [_form(part) for part in value[:1]]
    return type(value).__name__


def _written(scene: ds.Scene) -> str:
    recording = ds.plan(scene).view().recording
    return json.dumps(recording.to_json(), indent=1) + "\n"


def _embedded(text: str) -> dict[str, Any]:
    found = re.search(r'<script id="recording" type="application/json">(.*?)</script>', text, re.S)
    assert found is not None
    recording: dict[str, Any] = json.loads(found[1])
    return recording


def _run(steps: int = 6, **changes: Any) -> ds.viewer.Page:
    """A block that rests and one that falls beside it, with one force a frame."""
    scene = ds.Scene()
    scene.add_box((0, -0.5), (6, 1), name="ground", fixed=True)
    scene.add_box((0, 0.5), (1, 1), name="still")
    scene.add_box((2, 3), (1, 1), angle=0.3, name="falls")
    times = np.arange(steps + 1) / 240
    poses = np.tile([[*b.centroid, b.angle] for b in scene.bodies], (steps + 1, 1, 1))
    poses[:, 2, 1] -= 4.905 * times**2
    arguments: dict[str, Any] = {
        "times": times,
        "poses": poses,
        "motionless": np.tile([True, True, False], (steps + 1, 1)),
        "pivots": np.arange(steps),
        "solve_seconds": np.full(steps, 2e-6),
        "forces": FrameForces(
            np.arange(steps + 2),
            np.tile([0, 1], (steps + 1, 1)),
            np.tile([0.5, 0.0], (steps + 1, 1)),
            np.tile([0.0, 9.81], (steps + 1, 1)),
        ),
    }
    return ds.viewer.run_page(scene, **{**arguments, **changes})


def test_a_plan_is_a_frame_for_each_block_taken_away() -> None:
    plan = ds.plan(ds.scenes.five_blocks())
    recording = plan_recording(plan)
    names = plan.scene.names
    assert recording.states.shape == (6, len(names))
    for step in range(6):
        gone = {names[i] for i in np.flatnonzero(recording.states[step] == ABSENT)}
        following = [names[i] for i in np.flatnonzero(recording.states[step] == NEXT)]
        assert gone == set(plan.order[:step])
        assert following == list(plan.order[step : step + 1])


def test_the_forces_of_every_step_balance_the_weights() -> None:
    """On each block, from points and vectors alone: what pushes it, its weight, and the moments."""
    plan = ds.plan(ds.scenes.wall(3, 4))
    recording = plan_recording(plan)
    forces, bodies = recording.forces, plan.scene.bodies
    assert forces is not None
    offsets = np.asarray(forces.offsets)
    pairs, points = np.asarray(forces.bodies), np.asarray(forces.points)
    vectors = np.asarray(forces.vectors)
    assert offsets[-1] == offsets[-2], "nothing is left in the last frame"
    for step in range(len(plan.order)):
        span = slice(offsets[step], offsets[step + 1])
        for i, body in enumerate(bodies):
            if body.fixed or body.name in plan.order[:step]:
                assert body.fixed or not np.any(pairs[span] == i)
                continue
            sign = (pairs[span, 1] == i).astype(float) - (pairs[span, 0] == i)
            arm = points[span] - np.asarray(body.centroid)
            f = sign[:, None] * vectors[span]
            assert f.sum(axis=0) == pytest.approx([0, 9.81 * body.mass], abs=1e-9)
            assert np.sum(arm[:, 0] * f[:, 1] - arm[:, 1] * f[:, 0]) == pytest.approx(0, abs=1e-9)


def test_the_forces_of_every_step_balance_the_weights_in_space() -> None:
    """As in the plane, with three numbers a moment."""
    plan = ds.plan(ds.scenes.wall(3, 4).extruded(0.4))
    recording = plan_recording(plan)
    forces = recording.forces
    assert recording.dimension == 3
    assert forces is not None
    offsets = np.asarray(forces.offsets)
    pairs, points = np.asarray(forces.bodies), np.asarray(forces.points)
    vectors = np.asarray(forces.vectors)
    for step in range(len(plan.order)):
        span = slice(offsets[step], offsets[step + 1])
        for i, body in enumerate(plan.scene.bodies):
            if body.fixed or body.name in plan.order[:step]:
                continue
            sign = (pairs[span, 1] == i).astype(float) - (pairs[span, 0] == i)
            f = sign[:, None] * vectors[span]
            moment = np.cross(points[span] - np.asarray(body.centroid), f).sum(axis=0)
            assert f.sum(axis=0) == pytest.approx([0, 0, 9.81 * body.mass], abs=1e-9)
            assert moment == pytest.approx(np.zeros(3), abs=1e-9)


def test_a_run_in_space_has_positions_and_quaternions() -> None:
    scene = ds.scenes.column(2).extruded()
    first = [[*body.centroid, *body.orientation] for body in scene.bodies]
    arrays = (np.arange(4) / 240, np.tile(first, (4, 1, 1)), np.ones((4, len(scene)), dtype=bool))
    shown = ds.viewer.run_page(scene, *arrays, np.zeros(3), np.zeros(3))
    embedded = _embedded(shown.html())
    assert embedded["dimension"] == 3
    assert unpacked(embedded["frames"]["poses"]).shape == (4, len(scene), 7)
    assert embedded["bodies"][0]["vertices"] is None
    with pytest.raises(ValueError, match=r"poses has the shape \(4, \d, 3\): .* 7\)"):
        ds.viewer.run_page(scene, arrays[0], arrays[1][:, :, :3], arrays[2], [0] * 3, [0] * 3)


def test_pieces_are_in_the_body_s_own_frame() -> None:
    """Corners of a turned cuboid, placed by its pose, are those of the scene."""
    scene = ds.Scene(dimension=3)
    scene.add_box((1, 2, 3), (1, 2, 0.5), name="b", orientation=(0.8, 0, 0.6, 0))
    body = _embedded(ds.plan(scene).view().html())["bodies"][0]
    turned = rotation(body["pose"][3:])
    corners = np.array(body["pieces"][0]["vertices"]) @ turned.T + body["pose"][:3]
    assert corners == pytest.approx(scene.body("b").vertices)
    faces = body["pieces"][0]["faces"]
    assert sorted(len(face) for face in faces) == [4] * 6


def test_charts_hold_every_test_once() -> None:
    plan = ds.plan(ds.scenes.random_stack(84))
    pivots, seconds, tests = plan_recording(plan).series
    assert np.nansum(pivots.values) == plan.pivots
    assert np.nansum(tests.values) == plan.tests
    assert np.nansum(seconds.values) == pytest.approx(sum(r.seconds for r in plan.records))
    assert np.isnan(np.asarray(pivots.values)[[0, -1]]).all(), "whole and nothing are not tested"


@pytest.mark.parametrize("space", [False, True])
def test_loads_are_in_pages_of_plans_scenes_and_runs(space: bool) -> None:
    scene = ds.scenes.column(3).extruded() if space else ds.scenes.column(3)
    top = scene.body("2")
    force = (1.0, 0.0, -2.0) if space else (1.0, -2.0)
    at = (*top.center_of_mass[:-1], top.center_of_mass[-1] + 0.5)
    scene.add_load("2", force=force, at=at)
    scene.add_load("1", moment=(0.0, 0.1, 0.0) if space else 0.1)  # no arrow
    pages = ds.plan(scene).view(), scene.view(), ds.simulate(scene, 0.1).view()
    for shown in pages:
        (load,) = _embedded(shown.html())["loads"]
        assert load["body"] == scene.names.index("2")
        assert load["force"] == pytest.approx(force)
        assert load["at"] == pytest.approx(at)
    assert _embedded(ds.plan(ds.scenes.column(2)).view().html())["loads"] == []


def test_margins_are_shown_where_they_were_asked_for() -> None:
    """Four unit blocks on each other bear 1/4 g, three 1/3 g, two 1/2 g, the last one 1 g."""
    expected = [1 / 4, 1 / 3, 1 / 2, 1]
    tower = ds.scenes.column(5, friction=2.0)
    asked, plain = ds.plan(tower, margin=0.2), ds.plan(tower)
    assert "margin" not in [series.name for series in plan_recording(plain).series]
    assert plain.margins == pytest.approx(expected)  # now they have been read
    for plan in (asked, plain):
        recording = plan_recording(plan)
        assert (recording.series[0].name, recording.series[0].unit) == ("margin", "g")
        assert np.asarray(recording.series[0].values)[:-1] == pytest.approx(expected)
        assert np.isnan(np.asarray(recording.series[0].values)[-1])
        said = [f"It bears {m:.3g} g sideways." for m in expected]
        assert all(s in text for s, (_, text) in zip(said, recording.captions, strict=False))
        assert "with nothing held" in recording.details[0]


def test_a_chart_of_margins_has_the_least_of_steps_left_out() -> None:
    recording = plan_recording(ds.plan(ds.scenes.column(9, friction=2.0), margin=0.1))
    frames = recording.states.nbytes // 3
    small = budget.bounded(recording, replace(budget.FILE, frames=frames))
    assert small.series[0].name == "margin, least of 3"
    values = np.asarray(recording.series[0].values)
    assert np.asarray(small.series[0].values)[0] == values[0]
    assert np.asarray(small.series[0].values)[1] == np.nanmin(values[1:4])


def test_what_is_held_is_recorded_step_by_step() -> None:
    plan = ds.plan(ds.scenes.arch(7), hold=1)
    recording = plan_recording(plan)
    names = plan.scene.names
    assert recording.held is not None
    held = [{names[i] for i in np.flatnonzero(row)} for row in recording.held]
    assert held == [set(names) for names in plan.holds] + [set()] * (len(held) - len(plan.holds))
    assert any(held)
    assert np.array_equal(unpacked(recording.to_json()["frames"]["held"]), recording.held)
    assert plan_recording(ds.plan(ds.scenes.column(3))).held is None


def test_without_an_order_the_largest_structure_is_shown() -> None:
    plan = ds.plan(orderless(1))
    recording = plan_recording(plan)
    names = plan.scene.names
    assert len(recording.states) == len(plan.reached) + 1
    falling = {names[i] for i in np.flatnonzero(recording.states[0] == FALLING)}
    assert falling == set(plan.falls_next)
    assert "With plank something falls." in recording.captions[0][1]


def test_an_assembly_that_falls_is_one_frame() -> None:
    plan = ds.plan(ds.scenes.diamond(5))
    recording = plan_recording(plan)
    assert plan.whole is not None
    assert np.sum(recording.states == FALLING) == len(plan.whole.falling)
    assert recording.forces is not None
    assert len(recording.forces.vectors) == len(plan.whole.forces)


@pytest.mark.parametrize("scene", [ds.Scene(), ds.scenes.column(2)])
def test_nothing_to_take_apart_is_a_page(scene: ds.Scene) -> None:
    assert _embedded(ds.plan(scene).view().html())["frames"]["count"] >= 1


@pytest.mark.parametrize("path", FIXTURES)
def test_what_the_front_end_is_tested_with_is_what_python_writes(path: Path) -> None:
    texts = path.read_text(), _written(FIXTURES[path]())
    kept, now = (_form(json.loads(text)) for text in texts)
    assert kept == now, f"write it anew: .venv/bin/python {Path(__file__).relative_to(ROOT)}"


def test_both_sides_of_the_contract_name_the_same_fields() -> None:
    text = (ROOT / "viewer" / "src" / "contract.ts").read_text()
    pairs = {
        "Recording": contract.RecordingJson,
        "Body": contract.BodyJson,
        "Piece": contract.PieceJson,
        "Frames": contract.FramesJson,
        "Forces": contract.ForcesJson,
        "Load": contract.LoadJson,
        "Series": contract.SeriesJson,
        "Packed": contract.Packed,
    }
    for name, side in pairs.items():
        block = re.search(rf"export interface {name} \{{(.*?)\n\}}", text, re.S)
        assert block is not None
        fields = re.findall(r"^    (\w+): ", block[1], re.M)
        assert fields == list(get_type_hints(side)), name
    assert f'FORMAT = "{contract.FORMAT}"' in text
    assert f"VERSION = {contract.VERSION};" in text
    for name in ("ABSENT", "PRESENT", "MOTIONLESS", "NEXT", "FALLING"):
        assert f"    {name.lower()}: {getattr(contract, name)}," in text


def test_arrays_are_packed_and_come_back() -> None:
    for kind in (np.uint8, np.uint32, np.float32, np.float64):
        array = np.arange(12, dtype=kind).reshape(3, 4)
        value = contract.packed(array)
        assert np.array_equal(unpacked(value), array)
        assert value["shape"] == [3, 4]
    with pytest.raises(KeyError):
        contract.packed(np.zeros(3, dtype=np.int16))


def test_the_run_has_poses_states_and_charts() -> None:
    frames = _embedded(_run().html())["frames"]
    assert unpacked(frames["poses"])[0, 2] == pytest.approx([2, 3, 0.3])
    assert unpacked(frames["states"])[3].tolist() == [MOTIONLESS, MOTIONLESS, PRESENT]
    assert unpacked(frames["times"])[-1] == pytest.approx(6 / 240)
    series = _embedded(_run().html())["series"]
    assert [one["name"] for one in series] == ["pivots per step", "solve time per step"]
    assert unpacked(series[0]["values"])[1:].tolist() == [0, 1, 2, 3, 4, 5]


def test_outlines_are_in_the_body_s_own_frame() -> None:
    """A box turned by 0.3 is upright in its own frame, and turned by its pose."""
    vertices = np.array(_embedded(_run().html())["bodies"][2]["vertices"])
    assert np.abs(vertices) == pytest.approx(np.full((4, 2), 0.5))


def test_a_body_that_is_not_there_has_no_pose() -> None:
    poses = np.zeros((7, 3, 3))
    poses[4:, 2] = np.nan
    recording = _run(poses=poses).recording
    assert (recording.states[:, 2] == ABSENT).tolist() == [False] * 4 + [True] * 3


def test_what_the_steps_found_motionless_is_shown_after_them() -> None:
    still = np.zeros((6, 3), dtype=bool)
    still[2] = True
    states = _run(motionless=still).recording.states
    assert np.flatnonzero((states == MOTIONLESS).all(axis=1)).tolist() == [3]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"poses": np.zeros((7, 2, 3))}, r"poses has the shape \(7, 2, 3\)"),
        ({"motionless": np.zeros((5, 3), dtype=bool)}, r"motionless has the shape \(5, 3\)"),
        ({"times": np.zeros(6)}, r"times has the shape \(6,\): it must be \(7,\)"),
        ({"times": np.arange(7)[::-1]}, "times must ascend"),
        ({"times": np.full(7, np.nan)}, "times holds a NaN"),
        ({"poses": np.full((7, 3, 3), np.inf)}, "poses holds a NaN or an infinity"),
        ({"pivots": np.zeros(7)}, r"pivots per step has the shape \(7,\)"),
        ({"forces": FrameForces([0, 0], *[np.zeros((0, 2))] * 3)}, "offsets of the forces"),
        ({"series": [Series("rows reused", np.zeros(3))]}, "rows reused has the shape"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        _run(**changes)


def test_forces_that_do_not_fit_are_refused() -> None:
    with pytest.raises(ValueError, match="ascending from 0"):
        FrameForces([0, 2, 1], *[np.zeros((1, 2))] * 3)
    with pytest.raises(ValueError, match="points has the shape"):
        FrameForces([0, 1], np.zeros((1, 2)), np.zeros((2, 2)), np.zeros((1, 2)))


def test_a_page_loads_nothing() -> None:
    text = ds.plan(ds.scenes.column(3)).view().html()
    assert "default-src 'none'" in text
    assert not re.search(r"""(src|href)\s*=\s*["']|@import|url\(""", text)


def test_names_cannot_break_out_of_the_page() -> None:
    scene = ds.Scene()
    scene.add_box((0, -0.5), (4, 1), name="{{recording}}", fixed=True)
    scene.add_box((0, 0.5), (1, 1), name="</script><script>alert(1)</script>")
    shown = ds.plan(scene).view()
    recording = replace(shown.recording, title="<b>{{recording}}</b>")
    text = ds.viewer.Page(recording).html()
    assert "<script>alert" not in text
    assert "<b>" not in text
    assert text.count('"drystone-recording"') == 1 + _template_count('"drystone-recording"')
    assert _embedded(text)["bodies"][1]["name"] == "</script><script>alert(1)</script>"


def _template_count(text: str) -> int:
    return page._template(2).count(text)


def test_long_runs_are_thinned_and_say_so() -> None:
    steps = 999
    long = _run(steps)
    whole = long.recording
    a_frame = 3 * (budget.STATE_BYTES + budget.POSE_BYTES[2])
    small = budget.bounded(whole, budget.Budget(frames=250 * a_frame, forces=budget.MIB))
    assert len(small.states) == 251
    assert small.steps is not None
    assert small.times is not None
    assert small.steps[[0, 1, -1]].tolist() == [0, 4, 999]
    assert small.times[-1] == whole.times[-1]  # type: ignore[index]
    assert small.poses is not None
    assert np.array_equal(small.poses[1], whole.poses[4])  # type: ignore[index]
    pivots = np.asarray(small.series[0].values)
    assert np.nansum(pivots) == np.arange(steps).sum(), "sums of the steps between"
    assert pivots[1] == 0 + 1 + 2 + 3
    assert small.series[0].name == "pivots per step, sums of 4"
    assert small.forces is not None
    assert np.asarray(small.forces.offsets).tolist() == list(range(252))
    assert any("Every 4th step is shown" in note for note in small.notes)
    assert len(long.html(budget.Budget(frames=10 * a_frame))) < len(long.html())


def test_too_many_forces_are_kept_of_every_few_frames() -> None:
    recording = _run(99).recording
    small = budget.bounded(recording, budget.Budget(forces=34 * budget.FORCE_BYTES[2]))
    forces = small.to_json()["forces"]
    assert forces is not None
    assert unpacked(forces["frames"]).tolist() == list(range(0, 100, 3))
    assert unpacked(forces["vectors"]).shape == (2, 34)
    assert any("kept of 34 of 100 frames" in note for note in small.notes)
    none = budget.bounded(recording, budget.Budget(forces=0))
    assert none.to_json()["forces"] is not None
    assert any("kept of 0 of 100 frames" in note for note in none.notes)


def test_what_fits_is_left_as_it_is() -> None:
    recording = _run().recording
    assert budget.bounded(recording, budget.FILE) is recording


def test_the_largest_page_keeps_its_bound() -> None:
    """Noise cannot be deflated: poses and forces of all frames, far beyond the budget."""
    rng = np.random.default_rng(0)
    limit = budget.Budget(200_000, 200_000)
    frames, bodies, count = 3000, 40, 100_000
    scene = ds.Scene()
    for i in range(bodies):
        scene.add_box((2 * i, 0), (1, 1), fixed=True)
    recording = Recording(
        kind="run",
        title="noise",
        bodies=scene.bodies,
        states=rng.integers(0, 3, (frames, bodies)).astype(np.uint8),
        poses=rng.random((frames, bodies, 3)),
        times=np.arange(frames) / 240,
        forces=FrameForces(
            np.linspace(0, count, frames + 1).astype(int),
            rng.integers(0, bodies, (count, 2)),
            rng.random((count, 2)),
            rng.random((count, 2)),
        ),
    )
    base = len(ds.viewer.Page(replace(recording, forces=None)).html(budget.Budget(1, 0)))
    size = len(ds.viewer.Page(recording).html(limit))
    assert size - base <= 4 / 3 * (limit.frames + limit.forces) + 10_000


def test_pages_are_written_whole_or_not_at_all(tmp_path: Path) -> None:
    plan = ds.plan(ds.scenes.column(3))
    plan.draw(tmp_path / "plan.html")
    assert (tmp_path / "plan.html").read_text().startswith("<!doctype html>")
    with pytest.raises(ValueError, match=r"ends in \.html"):
        plan.view().save(tmp_path / "plan.svg")
    with pytest.raises(FileNotFoundError):
        plan.draw(tmp_path / "no" / "plan.html")
    assert [path.name for path in tmp_path.iterdir()] == ["plan.html"]


def test_the_same_plan_is_the_same_page() -> None:
    plan = ds.plan(ds.scenes.random_stack(20))
    assert plan.view().html() == plan.view().html()


def test_frames_are_drawn_as_pictures(tmp_path: Path) -> None:
    shown = _run()
    paths = shown.save_frames(tmp_path / "frames", [0, 6])
    assert [path.name for path in paths] == ["frame-00000.png", "frame-00006.png"]
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in paths)
    assert paths[0].read_bytes() != paths[1].read_bytes()
    assert len(ds.plan(ds.scenes.column(3)).view().save_frames(tmp_path, suffix=".svg")) == 3
    with pytest.raises(IndexError, match="frames 0 to 6"):
        shown.save_frames(tmp_path, [7])


def test_a_frame_s_picture_has_bodies_where_they_are_and_forces_to_one_scale() -> None:
    """The force of the later frame is half as large: its arrow is half as long."""
    vectors = np.tile([0.0, 9.81], (7, 1))
    vectors[6] /= 2
    recording = _run().recording
    assert recording.forces is not None
    halved = replace(recording, forces=replace(recording.forces, vectors=vectors))
    figures = [pictures.frame_figure(halved, frame) for frame in (0, 6)]
    lengths, tops = [], []
    for figure in figures:
        arrow = next(p for p in figure.axes[0].patches if isinstance(p, FancyArrow))
        lengths.append(np.ptp(arrow.get_xy(), axis=0).max())
        drawn = [path.vertices for c in figure.axes[0].collections for path in c.get_paths()]
        tops.append(max(np.asarray(corners)[:, 1].max() for corners in drawn))
    assert lengths[1] == pytest.approx(lengths[0] / 2)
    assert tops[0] - tops[1] == pytest.approx(4.905 * (6 / 240) ** 2)
    assert figures[0].axes[0].get_ylim() == figures[1].axes[0].get_ylim()


def test_notebooks_get_a_frame_of_bounded_size() -> None:
    shown = ds.plan(ds.scenes.pyramid(4)).view()
    frame = shown._repr_html_()
    assert frame.startswith("<iframe srcdoc=")
    assert 'sandbox="allow-scripts"' in frame
    assert frame.count("<") == 2, "the page within is escaped"
    assert budget.INLINE.frames + budget.INLINE.forces <= 6 * budget.MIB


def test_a_page_that_is_not_built_says_how(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(page, "files", lambda _: tmp_path)
    page._template.cache_clear()
    with pytest.raises(ds.DrystoneError, match="make build"):
        ds.plan(ds.scenes.column(3)).view().html()
    page._template.cache_clear()


def test_the_command_line_writes_the_page(cli: Callable[..., Ran], tmp_path: Path) -> None:
    ran = cli("plan", "column:5", "-o", tmp_path / "plan.html")
    assert (ran.status, ran.err) == (0, "")
    assert "page:" in ran.out
    assert _embedded((tmp_path / "plan.html").read_text())["frames"]["count"] == 5
    refused = cli("plan", "column:5", "-o", tmp_path / "plan.bmp")
    assert refused.status == 2
    assert ".svg, .pdf, .png, .html, .json, .gif or .mp4" in refused.err
    column = tmp_path / "column.json"
    ds.scenes.column(5).extruded().save(column)
    assert cli("plan", column, "-o", tmp_path / "space.html").status == 0
    assert _embedded((tmp_path / "space.html").read_text())["dimension"] == 3
    assert cli("check", "column:5", "-o", tmp_path / "check.html").status == 0
    assert _embedded((tmp_path / "check.html").read_text())["frames"]["count"] == 1


def test_progress_is_told_and_its_errors_reach_the_caller() -> None:
    scene = ds.scenes.wall(40, 45)
    order = [body.name for body in scene.bodies if not body.fixed]
    told: list[tuple[int, int]] = []

    def stop(placed: int, total: int) -> None:
        told.append((placed, total))
        raise InterruptedError

    with pytest.raises(InterruptedError):
        _core.forces_along(scene._core, order, 1, stop)
    assert len(told) == 1
    assert 0 < told[0][0] < told[0][1] == len(order)


if __name__ == "__main__":
    for path, scene in FIXTURES.items():
        path.write_text(_written(scene()))
