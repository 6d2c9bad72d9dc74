"""`plan_many`: the same plans as one by one, kept as they come, none made twice."""

from __future__ import annotations

import importlib.util
import json
import os
import secrets
import signal
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import drystone as ds
from at_work import MANY_TIMES_ENOUGH, until
from conftest import ROOT, Ran, orderless
from drystone.many import ScenePlan, work
from drystone.many.store import INDEX, LOCK, read_index

Cli = Callable[..., Ran]
TIMES = {"seconds", "test_seconds"}


def timeless(answer: Any) -> Any:
    """`answer` without the times in it, which differ from run to run."""
    if isinstance(answer, dict):
        return {key: timeless(value) for key, value in answer.items() if key not in TIMES}
    if isinstance(answer, list):
        return [timeless(value) for value in answer]
    return answer


def alone(scene: ds.Scene, **settings: Any) -> Any:
    """The plan of one scene on this machine, as the JSON that a result file holds."""
    return timeless(json.loads(json.dumps(ds.plan(scene, **settings).to_dict())))


@pytest.fixture
def scenes() -> dict[str, ds.Scene]:
    stacks = {f"stack{i}": ds.scenes.random_stack(10 + i, seed=i) for i in range(8)}
    return {**stacks, "arch": ds.scenes.arch(5), "column": ds.scenes.column(6)}


@pytest.fixture
def folder(scenes: dict[str, ds.Scene], tmp_path: Path) -> Path:
    """The scenes as files."""
    (tmp_path / "scenes").mkdir()
    for name, scene in scenes.items():
        scene.save(tmp_path / "scenes" / f"{name}.json")
    return tmp_path / "scenes"


@pytest.mark.parametrize("test", ["reuse", "lp"])
def test_every_plan_equals_the_plan_alone(
    test: str, scenes: dict[str, ds.Scene], tmp_path: Path
) -> None:
    many = ds.plan_many(scenes, output=tmp_path / "out", test=test, workers=3)
    assert [answer.name for answer in many] == list(scenes)
    for name, scene in scenes.items():
        assert timeless(many[name].plan) == alone(scene, test=test)
    assert len(many.without_order) == 1
    assert many.without_order[0].name == "arch"
    index = read_index(tmp_path / "out")
    files = {path.name for path in (tmp_path / "out").iterdir()} - {INDEX, LOCK}
    assert sorted(entry["file"] for entry in index) == sorted(files)
    assert len(files) == len(scenes)


def test_folder_paths_and_scenes_are_the_same_content(
    folder: Path, scenes: dict[str, ds.Scene], tmp_path: Path
) -> None:
    first = ds.plan_many(folder, output=tmp_path / "out")
    assert [answer.name for answer in first] == sorted(scenes)
    assert ds.plan_many(sorted(folder.iterdir()), output=tmp_path / "out").reused == len(scenes)
    assert ds.plan_many(scenes, output=tmp_path / "out").reused == len(scenes)
    assert len(read_index(tmp_path / "out")) == len(scenes)


def test_in_memory(scenes: dict[str, ds.Scene]) -> None:
    many = ds.plan_many(iter(scenes.values()))
    assert [timeless(answer.plan) for answer in many] == [alone(s) for s in scenes.values()]
    assert all(answer.file is None for answer in many)


def test_a_generator_is_not_read_ahead() -> None:
    """Two threads hold four scenes at a time, whatever else would come."""
    made, most = 0, 0

    def endless() -> Iterator[ds.Scene]:
        nonlocal made
        for n in range(1, 31):
            made += 1
            yield ds.scenes.column(n)

    def progress(done: int, total: int | None, answer: ScenePlan) -> None:
        nonlocal most
        assert total is None
        most = max(most, made - done)

    assert ds.plan_many(endless(), workers=2, progress=progress).found == 30
    # `done` is told one by one after a wait that may have ended for all four.
    assert most <= 4


def test_equal_scenes_are_planned_once(tmp_path: Path) -> None:
    many = ds.plan_many([ds.scenes.column(3), ds.scenes.column(3)], output=tmp_path)
    assert len(many) == len(read_index(tmp_path)) == 1


def test_other_settings_and_other_content_are_other_questions(tmp_path: Path) -> None:
    asked: tuple[dict[str, Any], ...] = (
        {},
        {"test": "lcp"},
        {"hold": 1},
        {"clear_path": True},
        {"clear_path": True, "directions": [(1, 0), (0, 1)]},
        {"clear_path": True, "directions": [(0, 1), (1, 0)]},
        {"clear_path": True, "moves": 2},
        {"clear_path": True, "together": 2},
        {"clear_path": True, "obstacles": ds.scenes.column(2)},
        {"margin": 0.05},
        {"order": "robust"},
        {"facets": 16},
        {"cone": "circumscribed"},
        {"node_limit": 1},
    )
    for settings in asked:
        many = ds.plan_many({"a": ds.scenes.column(4)}, output=tmp_path, **settings)
        assert many.reused == 0
        assert timeless(many["a"].plan) == alone(ds.scenes.column(4), **settings)
    assert ds.plan_many({"a": ds.scenes.column(5)}, output=tmp_path, node_limit=1).reused == 0
    assert ds.plan_many({"a": ds.scenes.column(4)}, output=tmp_path, node_limit=1).reused == 1


@pytest.mark.parametrize("dimension", [2, 3])
def test_held_and_leaving_along_a_line(dimension: int, tmp_path: Path) -> None:
    """As alone, on threads; kept in the folder, and taken from it for the same question only."""
    arch, column = ds.scenes.arch(5), ds.scenes.column(3)
    up = (0, 1)
    if dimension == 3:
        arch, column, up = arch.extruded(), column.extruded(), (0, 0, 1)
    asked: dict[str, Any] = {"hold": 1, "clear_path": True, "directions": [up]}
    many = ds.plan_many({"arch": arch, "column": column}, output=tmp_path, **asked)
    assert timeless(many["arch"].plan) == alone(arch, **asked)
    assert timeless(many["column"].plan) == alone(column, **asked)
    assert any(many["arch"].plan["holds"])
    assert many["column"].plan["directions"] == [list(map(float, up))] * 2
    again = ds.plan_many({"arch": arch, "column": column}, output=tmp_path, **asked)
    assert again.reused == 2
    assert ds.plan_many({"arch": arch}, output=tmp_path, **{**asked, "hold": 2}).reused == 0


def test_a_scene_of_another_dimension_than_the_directions(tmp_path: Path) -> None:
    scenes = {"flat": ds.scenes.column(3), "space": ds.scenes.column(3).extruded()}
    many = ds.plan_many(scenes, output=tmp_path, clear_path=True, directions=[(0, 1)])
    assert [answer.state for answer in many] == ["planned", "bad_input"]
    assert "plan scenes in the plane and in space apart" in many["space"].error
    inside = ds.scenes.column(3)
    many = ds.plan_many(scenes, clear_path=True, obstacles=inside.extruded())
    assert [answer.state for answer in many] == ["bad_input", "planned"]
    assert "obstacles have 3 dimensions, and this scene 2" in many["flat"].error


DAMAGE: dict[str, Callable[[bytes], bytes]] = {
    "truncated": lambda content: content[: len(content) // 2],
    "empty": lambda content: b"",
    "zeros": lambda content: b"\0" * len(content),
    "one digit": lambda content: content.replace(b'"pivots": ', b'"pivots": 1', 1),
    "another kind": lambda content: b"[]",
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_result_is_made_again(
    damage: str, scenes: dict[str, ds.Scene], tmp_path: Path
) -> None:
    first = ds.plan_many(scenes, output=tmp_path)
    path = first["stack3"].file
    assert path is not None
    sound = path.read_bytes()
    assert DAMAGE[damage](sound) != sound
    path.write_bytes(DAMAGE[damage](sound))
    again = ds.plan_many(scenes, output=tmp_path)
    assert [answer.name for answer in again if not answer.reused] == ["stack3"]
    assert timeless(again["stack3"].plan) == alone(scenes["stack3"])
    assert len(read_index(tmp_path)) == len(scenes) + 1


def test_a_torn_line_of_the_index_is_written_again(
    scenes: dict[str, ds.Scene], tmp_path: Path
) -> None:
    ds.plan_many(scenes, output=tmp_path)
    index = tmp_path / INDEX
    index.write_bytes(index.read_bytes()[:-30])
    assert len(read_index(tmp_path)) == len(scenes) - 1
    assert ds.plan_many(scenes, output=tmp_path).reused == len(scenes)
    counts = Counter(entry["name"] for entry in read_index(tmp_path))
    assert counts == dict.fromkeys(scenes, 1)


def _spoil(folder: Path) -> None:
    (folder / "cut.json").write_bytes((folder / "column.json").read_bytes()[:100])
    (folder / "latin.json").write_bytes(b'{"name": "\xe9"}')
    (folder / "gone.json").symlink_to("nowhere")


def test_bad_scenes_stop_no_other(
    folder: Path, scenes: dict[str, ds.Scene], tmp_path: Path
) -> None:
    _spoil(folder)
    paths = [*sorted(folder.iterdir()), tmp_path / "missing.json"]
    for repeat in range(2):
        many = ds.plan_many(paths, output=tmp_path / "out")
        assert {answer.name for answer in many.bad} == {"cut", "latin", "gone", "missing"}
        assert all(answer.state == "bad_input" for answer in many.bad)
        assert many["cut"].error.startswith("SceneError: ")
        for answer in many.bad:
            assert f"{answer.name}.json" in answer.error
        assert many.found == len(scenes) - 1
        # What had no content is looked for again: it may have come.
        assert many.reused == (len(scenes) + 2 if repeat else 0)


def test_what_breaks_is_tried_again(
    scenes: dict[str, ds.Scene], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fragile(scene: ds.Scene, *arguments: Any, **options: Any) -> ds.Plan:
        if scene.to_json() == scenes["arch"].to_json():
            raise MemoryError("no room for an arch")
        return ds.plan(scene, *arguments, **options)

    with monkeypatch.context() as patch:
        patch.setattr(work, "plan", fragile)
        first = ds.plan_many(scenes, output=tmp_path)
    assert [(a.name, a.state, a.error) for a in first.bad] == [
        ("arch", "failed", "MemoryError: no room for an arch")
    ]
    assert "1 not planned (arch)" in str(first)
    again = ds.plan_many(scenes, output=tmp_path)
    assert [answer.name for answer in again if not answer.reused] == ["arch"]
    assert timeless(again["arch"].plan) == alone(scenes["arch"])


@pytest.mark.parametrize(
    ("arguments", "error", "text"),
    [
        ({"engine": "dask"}, ValueError, "unknown engine 'dask': choose one of threads, ray"),
        ({"test": "simplex"}, ValueError, "unknown test 'simplex'"),
        ({"node_limit": -1}, ValueError, "node_limit is -1"),
        ({"time_limit": float("nan")}, ValueError, "time_limit is nan"),
        ({"hold": -1}, ValueError, "hold is -1"),
        ({"directions": [(0, 1)]}, ValueError, "give clear_path=True with them"),
        ({"directions": [(0, 1), (0, 0, 1)], "clear_path": True}, ValueError, "must all have two"),
        ({"directions": [(0, 0)], "clear_path": True}, ds.DrystoneError, "directions"),
        ({"moves": 2}, ValueError, "give clear_path=True"),
        ({"moves": 3, "clear_path": True}, ValueError, "moves is 3"),
        ({"obstacles": ds.scenes.column(2)}, ValueError, "give clear_path=True"),
        ({"obstacles": 3, "clear_path": True}, TypeError, "Scene"),
        ({"margin": -1.0}, ValueError, "margin is -1"),
        ({"order": "best"}, ValueError, "unknown order 'best'"),
        ({"facets": 2}, ds.DrystoneError, "facets"),
        (
            {
                "directions": [(0, 1)],
                "obstacles": ds.scenes.wall(2, 2).extruded(),
                "clear_path": True,
            },
            ValueError,
            "not of the same dimension",
        ),
        ({"workers": 0}, ValueError, "workers is 0"),
        ({"retries": -1}, ValueError, "retries is -1"),
        ({"address": "auto"}, ValueError, "address 'auto' is for engine='ray'"),
        ({"output": __file__}, OSError, "test_many.py"),
        ({"scenes": [3]}, TypeError, "3 is neither a Scene nor the path of a scene file"),
        ({"scenes": Path(__file__).parent}, ValueError, "no scene file"),
    ],
)
def test_unusable_arguments(
    arguments: dict[str, Any], error: type[Exception], text: str, tmp_path: Path
) -> None:
    with pytest.raises(error, match=text):
        ds.plan_many(**{"scenes": [ds.scenes.column(2)], "output": tmp_path, **arguments})
    assert not list(tmp_path.glob("*.json"))


def test_one_run_at_a_time_has_the_folder(tmp_path: Path) -> None:
    pytest.importorskip("fcntl")

    def second(*_: Any) -> None:
        with pytest.raises(BlockingIOError, match="another run is writing here"):
            ds.plan_many([ds.scenes.column(2)], output=tmp_path)

    assert ds.plan_many([ds.scenes.column(3)], output=tmp_path, progress=second).found == 1
    assert ds.plan_many([ds.scenes.column(2)], output=tmp_path).found == 1


SLOW = {"shortcuts": False, "node_limit": 10_000}
"""Settings under which `slow_scenes` take hundredths of a second each; without a limit, seconds."""


def slow_scenes(number: int) -> dict[str, ds.Scene]:
    scenes = {}
    for i in range(number):
        scene = orderless(16)
        scene.add_box((-4 - i, 0.5), (1, 1), name="odd")
        scenes[f"slow{i:02}"] = scene
    return scenes


FEW = 6
"""Plans that the process below makes. Those begun after them do not end."""
RUN = """
import sys; sys.path.insert(0, {tests!r})
import drystone as ds, test_many
from dataclasses import replace
from itertools import count
from drystone.many import work

begun, plan_text = count(), work.plan_text

def plan_few(text, source, settings, progress):
    while next(begun) >= {few}:
        plan_text(text, source, replace(settings, node_limit=None), progress)
    return plan_text(text, source, settings, progress)

work.plan_text = plan_few
many = ds.plan_many(
    test_many.slow_scenes({number}), "threads", {output!r}, workers=2, **test_many.SLOW
)
print(len(many), many.interrupted)
"""


def begun(output: Path, number: int) -> subprocess.Popen[str]:
    """A process that is planning, as soon as it has written three answers."""
    tests = str(ROOT / "tests" / "python")
    code = RUN.format(tests=tests, number=number, few=FEW, output=str(output))
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    until(lambda: len(read_index(output)) >= 3, process)
    return process


def resumed(output: Path, scenes: dict[str, ds.Scene]) -> None:
    """What is there is taken, the rest is made: every plan once."""
    before = read_index(output)
    finished = {path.name for path in output.glob("[!.]*.json")}
    assert 0 < len(finished) < len(scenes)
    many = ds.plan_many(scenes, output=output, **SLOW)
    assert many.reused == len(finished)
    index = read_index(output)
    assert index[: len(before)] == before
    assert Counter(entry["name"] for entry in index) == dict.fromkeys(scenes, 1)
    expected = {name: alone(scene, **SLOW) for name, scene in scenes.items()}
    assert {answer.name: timeless(answer.plan) for answer in many} == expected


@pytest.mark.skipif(sys.platform == "win32", reason="needs POSIX signals")
def test_resumed_after_a_kill(tmp_path: Path) -> None:
    process = begun(tmp_path, number=10)
    process.kill()
    process.communicate()
    (tmp_path / ".slow09-0.json.part").write_text("{")  # as if killed while writing
    resumed(tmp_path, slow_scenes(10))


@pytest.mark.skipif(sys.platform == "win32", reason="needs POSIX signals")
def test_an_interrupt_keeps_what_is_finished(tmp_path: Path) -> None:
    process = begun(tmp_path, number=10)
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=MANY_TIMES_ENOUGH)
    answers, interrupted = out.split()
    assert (process.returncode, err, interrupted) == (0, "", "True")
    # A plan that ended while the interrupt came is kept, but not handed on any more: one a worker.
    kept = len(read_index(tmp_path))
    assert 3 <= int(answers) <= kept <= min(int(answers) + 2, FEW)
    resumed(tmp_path, slow_scenes(10))


def test_of_a_folder(cli: Cli, folder: Path, scenes: dict[str, ds.Scene], tmp_path: Path) -> None:
    ran = cli("plan", folder, "-o", tmp_path / "out")
    assert (ran.status, ran.err) == (1, "")
    assert ran.out.startswith("9 of 10 scenes with an order; 1 without.")
    (folder / "arch.json").unlink()
    ran = cli("plan", folder, "-o", tmp_path / "out", "--json")
    answer = json.loads(ran.out)
    assert (ran.status, answer["found"], answer["reused"]) == (0, 9, 9)
    _spoil(folder)
    ran = cli("plan", folder, "-o", tmp_path / "out", "--engine", "threads")
    assert ran.status == 2
    assert ran.err == "drystone: 2 of 11 not planned: cut, latin\n"
    assert "SceneError" in ran.out


def test_of_a_folder_with_holds(cli: Cli, folder: Path, tmp_path: Path) -> None:
    ran = cli("plan", folder, "-o", tmp_path / "out", "--hold", 1, "--clear-path")
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith("10 of 10 scenes with an order.")
    record = json.loads(next((tmp_path / "out").glob("arch-*.json")).read_text())
    assert record["settings"]["hold"] == 1
    assert record["settings"]["clear_path"] is True
    assert any(record["plan"]["holds"])
    assert len(record["plan"]["directions"]) == len(record["plan"]["order"])


def test_of_a_folder_with_every_option(cli: Cli, folder: Path, tmp_path: Path) -> None:
    table = tmp_path / "table.json"
    ds.scenes.column(1).save(table)
    options = ("--clear-path", "--moves", 2, "--together", 2, "--obstacles", table)
    ran = cli("plan", folder, "-o", tmp_path / "out", *options, "--facets", 12)
    assert ran.err == ""
    record = json.loads(next((tmp_path / "out").glob("arch-*.json")).read_text())
    asked = {name: record["settings"][name] for name in ("moves", "together", "facets")}
    assert asked == {"moves": 2, "together": 2, "facets": 12}
    assert len(record["settings"]["obstacles"]) == 64


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["plan", "{folder}"], "-o"),
        (["plan", "{folder}", "-o", "{folder}"], "another folder"),
        (["plan", "{folder}", "-o", "{folder}/arch.json"], "arch.json is a file"),
        (["plan", "{folder}", "-o", "{folder}/out", "--address", "auto"], "engine='ray'"),
        (["plan", "{folder}", "-o", "{folder}/out", "--engine", "dask"], "dask"),
        (["plan", "column:3", "--engine", "threads"], "no folder"),
    ],
)
def test_bad_commands(cli: Cli, folder: Path, arguments: list[str], part: str) -> None:
    ran = cli(*(argument.format(folder=folder) for argument in arguments))
    assert (ran.status, ran.out, ran.err.count("\n")) == (2, "", 1)
    assert part in ran.err


def test_without_ray(cli: Cli, folder: Path, tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setitem(sys.modules, "ray", None)
    ran = cli("plan", folder, "-o", tmp_path / "out", "--engine", "ray")
    assert (ran.status, ran.out) == (2, "")
    assert 'pip install "drystone[ray]"' in ran.err


def ray_environment() -> dict[str, str]:
    """Nobody else on this machine gets in, and no token is left in the home folder."""
    return {
        **os.environ,
        "RAY_AUTH_MODE": "token",
        "RAY_AUTH_TOKEN": secrets.token_hex(32),
        "RAY_USAGE_STATS_ENABLED": "0",
    }


needs_ray = pytest.mark.skipif(
    importlib.util.find_spec("ray") is None,
    reason='Ray is not installed: pip install "drystone[ray]"',
)


@needs_ray
def test_a_machine_of_a_ray_cluster_dies(tmp_path: Path) -> None:
    """Of three machines one is killed at work: every plan is there, once, as made alone."""
    scenes = {f"stack{i}": ds.scenes.random_stack(100, seed=i) for i in range(12)}
    trace, output = tmp_path / "trace", tmp_path / "out"
    (tmp_path / "scenes").mkdir()
    for name, scene in scenes.items():
        scene.save(tmp_path / "scenes" / f"{name}.json")
    script = ROOT / "tests" / "python" / "lost_node.py"
    ran = subprocess.run(
        [sys.executable, script, tmp_path / "scenes", output, trace],
        env=ray_environment(),
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert ran.returncode == 0, ran.stderr
    assert json.loads(ran.stdout)["found"] == len(scenes)
    index = read_index(output)
    assert Counter(entry["name"] for entry in index) == dict.fromkeys(scenes, 1)
    plans = {entry["name"]: json.loads((output / entry["file"]).read_text()) for entry in index}
    assert {name: timeless(record["plan"]) for name, record in plans.items()} == {
        name: alone(scene, test="lp") for name, scene in scenes.items()
    }
    # Both machines worked, and what was begun on the one killed was begun again on the other.
    begun_on: dict[str, list[str]] = {}
    for name, where, *_ in (line.split() for line in trace.read_text().splitlines()):
        begun_on.setdefault(name, []).append(where)
    (killed,) = begun_on.pop("killed")
    assert begun_on.keys() == scenes.keys()
    again = [where for where in begun_on.values() if len(where) > 1]
    assert again
    for where in again:
        assert where[0] == killed != where[-1]


@needs_ray
def test_ray_on_one_machine_needs_no_start(
    folder: Path, scenes: dict[str, ds.Scene], tmp_path: Path
) -> None:
    command = [sys.executable, "-c", "from drystone.cli import main; main()"]
    ran = subprocess.run(
        [*command, "plan", folder, "-o", tmp_path / "out", "--engine", "ray", "--json"],
        env=ray_environment(),
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert (ran.returncode, ran.stderr) == (1, "")
    assert json.loads(ran.stdout)["found"] == len(scenes) - 1
    many = ds.plan_many(scenes, output=tmp_path / "out")
    assert many.reused == len(scenes)
    for answer in many:
        assert timeless(answer.plan) == alone(scenes[answer.name])
