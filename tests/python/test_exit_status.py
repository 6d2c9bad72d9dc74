"""Exit status 1 says "no" and nothing else: what goes wrong is one line and 2. Names are kept."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import drystone as ds
from conftest import Ran

Cli = Callable[..., Ran]

COMMANDS = {
    "check": "check column:3",
    "check json": "check column:3 --json",
    "plan": "plan column:3",
    "plan json": "plan column:3 --json",
    "simulate": "simulate column:3 --steps 1",
    "scene": "scene column",
    "scenes": "scene --list",
    "bench": "bench methods column:2 --repeats 1 --json",
    "help": "--help",
    "version": "--version",
}

posix = pytest.mark.skipif(os.name == "nt", reason="devices and pipes of POSIX")


def _run(arguments: str, stdout: int | None, stderr: int | None = subprocess.PIPE) -> Ran:
    code = "import sys; from drystone.cli import main; main()"
    command = [sys.executable, "-c", code, *arguments.split()]
    ran = subprocess.run(command, stdout=stdout, stderr=stderr, text=True)
    return Ran(ran.returncode, ran.stdout or "", ran.stderr or "")


@posix
@pytest.mark.parametrize("name", ["check", "check json", "scene", "help"])
def test_a_full_disk(name: str) -> None:
    with open("/dev/full", "w") as full:
        ran = _run(COMMANDS[name], full.fileno())
    assert (ran.status, ran.err) == (2, "drystone: No space left on device\n")


@posix
@pytest.mark.parametrize("name", ["check", "check json", "scenes"])
def test_nobody_reads_it(name: str) -> None:
    read, write = os.pipe()
    os.close(read)
    ran = _run(COMMANDS[name], write)
    os.close(write)
    assert (ran.status, ran.err) == (141, "")


@pytest.mark.parametrize("name", ["check", "plan json", "simulate", "scenes", "bench"])
@pytest.mark.parametrize(
    ("error", "said", "status"),
    [
        (OSError(28, "No space left on device"), "No space left on device", 2),
        (MemoryError(), "not enough memory", 2),
        (RecursionError("too deep"), "RecursionError: too deep", 2),
        (RuntimeError("two\nlines \x1b[31m"), "RuntimeError: two lines \\x1b[31m", 2),
        (BaseException("a panic"), "BaseException: a panic", 2),
        (ds.DrystoneError("it says what"), "it says what\n", 2),
        (KeyboardInterrupt(), None, 130),
        (BrokenPipeError(32, "Broken pipe"), None, 141),
    ],
)
def test_whatever_a_command_raises(
    cli: Cli,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    error: BaseException,
    said: str | None,
    status: int,
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr("builtins.print", _only_to_stderr(fail))
    monkeypatch.setattr("rich.console.Console.print", fail)
    monkeypatch.setattr("drystone.planning.answer.write_json", fail)
    ran = cli(*COMMANDS[name].split())
    assert ran.status == status
    if said is None:
        assert ran.err == ""
    else:
        assert ran.err.startswith("drystone: ")
        assert ran.err.count("\n") == 1
        assert said in ran.err


def _only_to_stderr(fail: Callable[..., None]) -> Callable[..., None]:
    real = print

    def stand_in(*args: object, **named: object) -> None:
        if named.get("file") is None:
            fail()
        real(*args, **named)  # type: ignore[call-overload]

    return stand_in


def test_no_verdict_is_not_no(
    cli: Cli, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, leaning: ds.Scene
) -> None:
    from dataclasses import replace

    verdict = replace(ds.check(leaning), status="pivot_limit", falling=())
    monkeypatch.setattr("drystone.cli.check.check", lambda *_, **__: verdict)
    ran = cli("check", "column:3")
    assert ran.status == 2
    assert "pivot_limit" in ran.out
    assert ran.err == "drystone: column:3: no verdict (pivot_limit)\n"


NAMES = {
    "markup": "[/x]",
    "colours": "[bold red]hi[/]",
    "emoji": ":smile: block",
    "mathtext": "$a^{b$",
    "quotes": """it's "5" & <6>""",
    "commas": "a,b, c",
    "long": "x" * 300,
    "script": "</script><script>alert(1)</script>",
    "page": "<!--{{recording}}-->",
    "accents": "pierre taillée",
    "newline": "two\nlines",
    "escape": "\x1b[31mred\x07",
    "turned": "\u202eabc",
    "backslash": r"a\nb",
}

SHOWN = {
    "newline": r"two\nlines",
    "escape": r"\x1b[31mred\x07",
    "turned": r"\u202eabc",
}
"""What steers a terminal is printed as an escape; every other name as it is."""


@pytest.fixture(params=NAMES)
def named(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[str, str, Path]:
    """A name, what of it is printed, and the file of a scene in which the block stands."""
    name = NAMES[request.param]
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, -0.5), (4, 1), fixed=True, name="ground")
    scene.add_box((0, 0.5), (1, 1), name=name)
    path = tmp_path / "named.json"
    scene.save(path)
    return name, SHOWN.get(request.param, name), path


def test_names_are_printed_as_they_are(cli: Cli, named: tuple[str, str, Path]) -> None:
    name, shown, path = named
    falling = ds.Scene.load(path)
    falling.add_box((9, 9), (1, 1), name=f"{name}2")
    falling.save(path.with_name("falling.json"))
    for status, arguments in (
        (0, ("check", path)),
        (1, ("check", path.with_name("falling.json"))),
        (0, ("plan", path)),
        (0, ("check", path, "--block", name)),
        (2, ("check", path, "--block", f"{name}?")),
    ):
        ran = cli(*arguments)
        assert ran.status == status, ran.err
        if status == 2:  # of one line, by whatever blanks
            shown = shown.replace(r"\n", " ") if "\n" in name else shown
        assert shown in ran.out + ran.err, arguments
        assert not any(c in ran.out + ran.err for c in "\x1b\x07\u202e")
    assert name in json.loads(cli("plan", path, "--json").out)["order"]
    assert json.loads(cli("check", path, "--json").out)["forces"][0]["b"] == name


def test_names_in_pictures_and_pages(cli: Cli, named: tuple[str, str, Path]) -> None:
    from html.parser import HTMLParser
    from xml.etree import ElementTree

    name, shown, path = named
    for kind in ("check.svg", "plan.svg", "check.png"):
        assert cli(kind.split(".")[0], path, "-o", path.with_name(kind)).status == 0
    text = path.with_name("check.svg").read_text(encoding="utf-8")
    ElementTree.fromstring(text)
    if len(name) < 100:  # a long one does not fit on its block
        assert shown in "".join(ElementTree.fromstring(text).itertext())
    assert cli("plan", path, "-o", path.with_name("plan.html")).status == 0

    scripts: list[dict[str, str | None]] = []

    class Scripts(HTMLParser):
        def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
            if tag == "script":
                scripts.append(dict(attrs))

    plain = path.with_name("plain.html")
    ds.plan(ds.scenes.column(2)).view().save(plain)
    counts = []
    for page in (plain, path.with_name("plan.html")):
        scripts.clear()
        Scripts().feed(page.read_text(encoding="utf-8"))
        counts.append(len(scripts))
    assert counts[0] == counts[1] > 0


def test_several_names_with_commas(cli: Cli, tmp_path: Path) -> None:
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, -0.5), (9, 1), fixed=True, name="ground")
    for x, name in ((-3, "a,b"), (0, "c"), (3, "a")):
        scene.add_box((x, 0.5), (1, 1), name=name)
    scene.save(tmp_path / "scene.json")
    ran = cli("check", tmp_path / "scene.json", "--block", "a,b", "--blocks", "c,a", "--json")
    assert set(json.loads(ran.out)["accelerations"]) == {"a,b", "c", "a"}
    ran = cli("check", tmp_path / "scene.json", "--block", "a,b", "--block", "c", "--json")
    assert set(json.loads(ran.out)["accelerations"]) == {"a,b", "c"}


def test_bodies_to_fix_by_names_with_commas(cli: Cli, tmp_path: Path) -> None:
    import trimesh

    for x, name in enumerate(("a,b", "c", "d")):
        box = trimesh.creation.box((1, 1, 1))
        box.apply_translation((2 * x, 0, 0))
        box.export(tmp_path / f"{name}.stl")
    ran = cli("import", tmp_path, "--fix", "a,b", "--fixed", "c,d", "--json")
    assert ran.status == 0, ran.err
    assert all(body["fixed"] for body in json.loads(ran.out)["bodies"])


SCENE = """{"format": "drystone-scene", "version": 1, "dimension": 2, "gravity": [0, -9.81],
"friction": 0.5, "bodies": [{"name": "g", "box": {"size": [4, 1]}, "fixed": true}]}"""

ODD: dict[str, bytes] = {
    "nothing": b"",
    "a null character": b"\0",
    "NaN": SCENE.replace("9.81", "NaN").encode(),
    "too large a number": SCENE.replace("9.81", "1e999").encode(),
    "a very long number": SCENE.replace("9.81", "9" * 5000).encode(),
    "deep lists": b"[" * 100_000,
    "deep objects": b'{"a":' * 100_000,
    "a field twice": SCENE.replace('"friction"', '"friction": 1, "friction"').encode(),
    "a list": b"[]",
    "a number": b"1",
    "null": b"null",
    "Latin 1": SCENE.replace('"g"', '"é"').encode("latin-1"),
    "UTF-16": SCENE.encode("utf-16"),
    "half a pair": SCENE.replace('"g"', '"\\ud800"').encode(),
    "half a pair as bytes": SCENE.replace('"g"', '"\ud800"').encode("utf-8", "surrogatepass"),
    "cut": SCENE[:-9].encode(),
    "more after the end": f"{SCENE} x".encode(),
    "a text for a number": SCENE.replace("0.5", '"0.5"').encode(),
    "bodies that are none": SCENE.replace('{"name"', '7, {"name"').encode(),
}


@pytest.mark.parametrize("case", ODD)
def test_odd_files_are_one_line(cli: Cli, tmp_path: Path, case: str) -> None:
    path = tmp_path / "odd.json"
    path.write_bytes(ODD[case])
    for command in ("check", "plan", "simulate", "import"):
        ran = cli(command, path)
        assert (ran.status, ran.out) == (2, ""), command
        assert ran.err.startswith("drystone: ")
        assert "odd.json" in ran.err
        assert ran.err.count("\n") == 1
        assert "report it" not in ran.err


def test_a_name_that_is_no_text() -> None:
    scene = ds.Scene()
    with pytest.raises(ds.SceneError, match=r"\\ud800"):
        scene.add_box((0, 0), (1, 1), name="half a pair: \ud800")
    with pytest.raises(ds.SceneError, match="name"):
        scene.body("\ud800")
