"""The command line: what it prints, and its exit status."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import drystone as ds
from at_work import MANY_TIMES_ENOUGH, at_work
from conftest import Ran, orderless

Cli = Callable[..., Ran]


@pytest.fixture
def file(block: ds.Scene, tmp_path: Path) -> Path:
    block.save(tmp_path / "block.json")
    return tmp_path / "block.json"


@pytest.fixture
def falling(leaning: ds.Scene, tmp_path: Path) -> Path:
    leaning.save(tmp_path / "leaning.json")
    return tmp_path / "leaning.json"


def test_check_says_yes(cli: Cli, file: Path) -> None:
    ran = cli("check", file)
    assert ran.status == 0
    assert ran.out.startswith("Stands: 1 block")
    assert ran.out.count("9.81") == 2
    assert ran.err == ""


def test_check_says_no(cli: Cli, falling: Path) -> None:
    ran = cli("check", falling)
    assert ran.status == 1
    assert ran.out.startswith("Falls: 1 of 1 block (plank)")


def test_check_as_json(cli: Cli, file: Path, block: ds.Scene) -> None:
    ran = cli("check", file, "--json")
    answer = json.loads(ran.out)
    expected = json.loads(json.dumps(ds.check(block).to_dict()))
    for timed in (answer, expected):
        assert timed.pop("seconds") >= 0
    assert answer == expected
    assert answer["stable"] is True


def test_check_of_some_blocks(cli: Cli) -> None:
    assert cli("check", "five_blocks", "--blocks", "1,3,5").status == 0
    assert cli("check", "five_blocks", "--blocks", "1, 3").status == 1


def test_plan_prints_the_order(cli: Cli) -> None:
    ran = cli("plan", "column:4")
    assert ran.status == 0
    assert "3 2 1" in ran.out


@pytest.mark.parametrize("test", ["reuse", "reuse-dantzig", "lcp", "lp", "lp-warm"])
def test_plan_as_json(cli: Cli, test: str) -> None:
    ran = cli("plan", "pyramid:3", "--json", "--test", test)
    answer = json.loads(ran.out)
    assert ran.status == 0
    assert (answer["found"], answer["test"], len(answer["order"])) == (True, test, 6)
    assert len(answer["records"]) == answer["tests"]


def test_an_order_of_many_blocks_is_cut(cli: Cli) -> None:
    ran = cli("plan", "column:301")
    assert ran.status == 0
    assert "... 100 more; --json lists all" in ran.out
    assert len(ran.out) < 4000


def test_plan_without_an_order(cli: Cli, tmp_path: Path) -> None:
    orderless(1).save(tmp_path / "scene.json")
    ran = cli("plan", tmp_path / "scene.json")
    assert ran.status == 1
    assert "No stable order exists" in ran.out
    assert "plank" in ran.out
    assert "may be an order: --hold 1" in ran.out


def test_plan_within_limits(cli: Cli, tmp_path: Path) -> None:
    orderless(8).save(tmp_path / "scene.json")
    ran = cli("plan", tmp_path / "scene.json", "--node-limit", "3", "--json")
    assert (ran.status, json.loads(ran.out)["status"]) == (1, "test_limit")
    ran = cli("plan", tmp_path / "scene.json", "--time-limit", "0", "--json")
    assert (ran.status, json.loads(ran.out)["status"]) == (1, "time_limit")


def test_pictures(cli: Cli, file: Path, tmp_path: Path) -> None:
    assert cli("check", file, "-o", tmp_path / "check.svg").status == 0
    assert (tmp_path / "check.svg").read_text().startswith("<?xml")
    assert cli("plan", "column:5", "-o", tmp_path / "plan.png").status == 0
    assert (tmp_path / "plan.png").read_bytes().startswith(b"\x89PNG")


def test_scenes_are_written_with_their_parameters(cli: Cli, tmp_path: Path) -> None:
    path = tmp_path / "arch.json"
    assert cli("scene", "arch", "--voussoirs", "7", "--friction", "0.9", "-o", path).status == 0
    assert path.read_text() == ds.scenes.arch(7, friction=0.9).to_json()


def test_a_scene_goes_to_standard_output(cli: Cli) -> None:
    ran = cli("scene", "column", "--n", "3")
    assert ds.Scene.from_json(ran.out).to_json() == ds.scenes.column(3).to_json()


def test_scenes_are_listed(cli: Cli) -> None:
    ran = cli("scene", "--list")
    assert ran.status == 0
    assert [line.split()[0] for line in ran.out.splitlines()] == ds.scenes.__all__


def test_built_in_scenes_may_stand_for_files(cli: Cli) -> None:
    assert cli("plan", "random-stack:10,seed=4,friction=0.5", "--threads", "2").status == 0
    assert json.loads(cli("check", "pyramid:2", "--json").out)["stable"]


BAD = {
    "no such file": (["check", "nowhere.json"], ["nowhere.json"]),
    "a folder": (["check", "."], ["."]),
    "no name": (["check", ""], ["empty"]),
    "a name of spaces": (["plan", "  "], ["empty"]),
    "no such scene": (["plan", "colum:3"], ["colum"]),
    "a scene mistyped": (["simulate", "fallng_column"], ["did you mean", "falling_column"]),
    "a scene mistyped, with parameters": (["check", "colunm:3"], ["colunm:3", '"column"']),
    "no such parameter": (["plan", "column:m=3"], ["column", "m", "n"]),
    "a parameter twice": (["check", "arch:5,voussoirs=7"], ["voussoirs", "5 and 7"]),
    "a parameter twice, as option": (
        ["scene", "arch:5", "--voussoirs", "7"],
        ["--voussoirs", "5 and 7"],
    ),
    "an option twice": (
        ["scene", "arch", "--voussoirs=5", "--friction", "1", "--voussoirs", "7"],
        ["--voussoirs", "5 and 7"],
    ),
    "a parameter too many": (["plan", "column:3,0,7"], ["column", "7 is one too many"]),
    "a parameter that is no number": (["plan", "column:many"], ["column", "n", "many"]),
    "a parameter out of range": (["plan", "column:-3"], ["column", "-3"]),
    "no such block": (["check", "column:3", "--blocks", "9"], ["9"]),
    "no such test": (["plan", "column:3", "--test", "simplex"], ["simplex"]),
    "no such option": (["plan", "column:3", "--quickly"], ["--quickly"]),
    "no such command": (["plane", "column:3"], ["plane"]),
    "a limit that is no number": (["plan", "column:3", "--node-limit", "x"], ["--node-limit"]),
    "no thread": (["plan", "column:3", "--threads", "0"], ["--threads"]),
    "threads for a folder": (["plan", ".", "--threads", "2"], ["--threads", "--workers"]),
    "nothing to check": (["check"], ["SCENE"]),
    "no such folder to plan": (["plan", "nowhere", "-o", "plans"], ["nowhere: no such file"]),
    "a picture of another kind": (["check", "column:3", "-o", "x.gif"], [".svg", ".png"]),
    "nowhere to write": (["check", "column:3", "-o", "no/such/x.svg"], ["no/such/x.svg"]),
    "no such scene to write": (["scene", "colum"], ["colum", 'did you mean "column"']),
    "a word that is not allowed": (["plan", "column", "--order", "al"], ["order': 'al' is not"]),
    "a support without a way": (["check", "column", "--settle", "ground"], ["give a support"]),
    "nowhere to write a scene": (["scene", "column", "-o", "no/such/x.json"], ["no/such/x.json"]),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_line_and_status_two(cli: Cli, case: str) -> None:
    arguments, parts = BAD[case]
    ran = cli(*arguments)
    assert ran.status == 2
    assert ran.out == ""
    assert ran.err.startswith("drystone: ")
    assert ran.err.count("\n") == 1
    for part in parts:
        assert part in ran.err


def test_a_damaged_file_is_one_line(cli: Cli, file: Path) -> None:
    file.write_text(file.read_text()[:80])
    ran = cli("check", file)
    assert (ran.status, ran.err.count("\n")) == (2, 1)
    assert "block.json" in ran.err


@pytest.mark.parametrize("command", [[], ["check"], ["plan"], ["scene"], ["scene", "arch"]])
def test_help(cli: Cli, command: list[str]) -> None:
    ran = cli(*command, "--help")
    assert ran.status == 0
    assert "Usage" in ran.out


@pytest.mark.parametrize(
    ("command", "flags"),
    [
        ("", ["--version"]),
        ("check", ["--json", "--strong"]),
        ("plan", ["--json", "--strong", "--clear-path", "--no-shortcuts"]),
        ("scene", ["--list"]),
        ("scene arch", []),
        ("import", ["--ground", "--pieces", "--hull"]),
        ("bench methods", ["--json"]),
    ],
)
def test_help_shows_flags_without_a_value(cli: Cli, command: str, flags: list[str]) -> None:
    lines = cli(*command.split(), "--help").out.splitlines()
    for flag in [*flags, "-h"]:
        line = next(x for x in lines if f" {flag} " in x)
        after = line.partition(f" {flag} ")[2]
        assert re.match(r"\s+[A-Z]", after), line  # the first word of what it does


@pytest.mark.parametrize(
    "command",
    [
        "check column:3",
        "check arch:thickness=0.1",
        "limit column:3 --push 1:1,0",
        "margin column:3",
        "plan column:3",
    ],
)
def test_answers_are_written_as_they_are_printed(cli: Cli, command: str, tmp_path: Path) -> None:
    written = cli(*command.split(), "-o", tmp_path / "answer.json")
    assert "answer.json" in written.out
    printed = cli(*command.split(), "--json")
    assert written.status == printed.status
    told, here = json.loads((tmp_path / "answer.json").read_text()), json.loads(printed.out)
    assert told.keys() == here.keys()
    timed = ("seconds", "test_seconds", "records", "whole")
    assert all(told[key] == here[key] for key in told if key not in timed)


@pytest.mark.parametrize("command", ["", "scene", "bench"])
def test_no_command_shows_the_help_and_no_empty_line(cli: Cli, command: str) -> None:
    ran = cli(*command.split())
    assert (ran.status, ran.err) == (2, "")
    assert "Usage: drystone" in ran.out


def test_friction_that_does_not_help_is_no_number(cli: Cli) -> None:
    ran = cli("margin", "arch:thickness=0.1")
    assert ran.status == 1
    assert "No friction, however much, makes it stand." in ran.out


def test_version(cli: Cli) -> None:
    assert cli("--version").out.strip() == ds.__version__


def test_the_command_is_installed() -> None:
    command = Path(sys.executable).with_name("drystone")
    ran = subprocess.run([command, "check", "column:3"], capture_output=True, text=True)
    assert (ran.returncode, ran.stderr) == (0, "")
    ran = subprocess.run([command, "check", "nowhere"], capture_output=True, text=True)
    assert (ran.returncode, ran.stdout) == (2, "")


def test_a_warning_is_a_line(tmp_path: Path) -> None:
    command = [Path(sys.executable).with_name("drystone"), "check", "column:3"]
    ran = subprocess.run(
        [*command, "--settle", "ground:0,-10"], capture_output=True, text=True, check=True
    )
    assert re.fullmatch("drystone: the displacement is 10 m.*\n", ran.stderr)


def test_a_terminal_that_knows_ascii_only(tmp_path: Path) -> None:
    """Units are plain there, and names are escaped."""
    scene = ds.Scene()
    scene.add_box((0, -0.5), (4, 1), fixed=True, name="ground")
    scene.add_box((0, 0.5), (1, 1), name="pierre taill\u00e9e")
    scene.add_box((9, 0.5), (1, 1), name="\u77f3")
    scene.save(tmp_path / "scene.json")
    ascii_only = {**os.environ, "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONIOENCODING": "ascii"}

    def said(*arguments: str) -> str:
        command = [sys.executable, "-c", "from drystone.cli import main; main()", *arguments]
        ran = subprocess.run(command, capture_output=True, text=True, env=ascii_only)
        assert ran.returncode in (0, 1), ran.stderr
        return ran.stdout

    check = said("check", str(tmp_path / "scene.json"))
    assert "[m/s2]" in check
    assert "\\u77f3" in check
    # However long they took.
    code = "from drystone.cli.encoding import write_what_is_not_known as f; f(); print(3, '\\xb5s')"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, env=ascii_only)
    assert ran.stdout.strip() == b"3 us"
    assert "m/s2" in said("limit", "--help")


HEAVY = ("numpy", "scipy", "matplotlib", "highspy", "rich.progress")


@pytest.mark.parametrize(
    "code",
    [
        "import drystone",
        "from drystone.cli import run; run(['--help'])",
        "from drystone.cli import run; run(['plan', '--help'])",
    ],
)
def test_nothing_heavy_is_loaded_before_it_is_needed(code: str) -> None:
    code += "; import sys; print(*sys.modules, sep='\\n', file=sys.stderr)"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(ran.stderr.split())
    assert loaded.isdisjoint(HEAVY)


@pytest.mark.skipif(sys.platform == "win32", reason="needs POSIX signals")
@pytest.mark.parametrize("test", ["lcp", "lp"])
def test_an_interrupt_hands_back_the_best_so_far(test: str, tmp_path: Path) -> None:
    endless = ("plan", "column:2000", "--test", test, "--no-shortcuts", "--json")
    process = at_work(tmp_path / "flag", "PlanProgress", *endless)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=MANY_TIMES_ENOUGH)
    answer: dict[str, Any] = json.loads(out)
    assert (process.returncode, answer["status"], err) == (130, "interrupted", "")
    assert answer["tests"] > 0
    assert answer["reached"]
