"""Answers draw, save and show themselves, by the ending of a name or where they are looked at."""

from __future__ import annotations

import io
import json
import webbrowser
from collections.abc import Callable
from pathlib import Path
from urllib.parse import urlparse

import pytest
from matplotlib.figure import Figure
from PIL import Image

import drystone as ds
from drystone.common.drawn import Drawn
from drystone.pictures import save_film

THINGS: dict[str, Callable[[], Drawn]] = {
    "scene": lambda: ds.scenes.arch(5),
    "scene in space": lambda: ds.scenes.brick_wall(2, 2),
    "verdict": lambda: ds.check(ds.scenes.arch(5)),
    "verdict that falls": lambda: ds.check(ds.scenes.diamond(5)),
    "limit": lambda: ds.limit(ds.scenes.arch(5), gravity=(1, 0)),
    "margin": lambda: ds.margin(ds.scenes.arch(5)),
    "plan": lambda: ds.plan(ds.scenes.arch(5), hold=1),
    "run": lambda: ds.simulate(ds.scenes.fall7(), steps=24, forces=True),
    "world": lambda: ds.World(ds.scenes.fall7()),
    "structure": lambda: ds.Structure(ds.scenes.pyramid(2), blocks=["1", "2"]),
}


@pytest.mark.parametrize("name", THINGS)
def test_everything_draws_itself(name: str, tmp_path: Path) -> None:
    thing = THINGS[name]()
    assert thing._repr_svg_().lstrip().startswith("<?xml")
    thing.draw(tmp_path / "a.png", dpi=30)
    with Image.open(tmp_path / "a.png") as small:
        assert 60 < small.width < 40 * 10


@pytest.mark.parametrize("name", ["scene", "scene in space", "verdict", "plan", "run"])
def test_within_a_figure_of_ones_own(name: str) -> None:
    """The axes keep their place, equal scales, and nothing else in the figure changes."""
    figure = Figure(figsize=(8, 4))
    left, right = figure.subplots(1, 2)
    right.plot([0, 1])
    thing = THINGS[name]()
    assert thing.draw(ax=left) is None
    assert figure.axes == [left, right]
    assert left.get_aspect() == 1.0
    assert left.get_title(loc="left") != ""
    assert len(left.collections) + len(left.patches) > 1
    assert len(right.collections) + len(right.patches) == 0
    figure.savefig(io.BytesIO(), format="svg")
    # What comes next has a figure of its own again.
    assert thing._repr_svg_()


def test_a_name_or_axes() -> None:
    scene = ds.scenes.arch(5)
    with pytest.raises(TypeError, match="one of the two"):
        scene.draw()
    with pytest.raises(TypeError, match="one of the two"):
        scene.draw("a.svg", ax=Figure().subplots())


PICTURES = ".svg, .pdf, .png"


@pytest.mark.parametrize(
    ("write", "known"),
    [
        (lambda name: ds.scenes.arch(5).draw(name), f"{PICTURES} or .html"),
        (lambda name: ds.World(ds.scenes.arch(5)).draw(name), ".svg, .pdf or .png"),
        (lambda name: ds.check(ds.scenes.arch(5)).save(name), f".json, {PICTURES} or .html"),
        (lambda name: ds.plan(ds.scenes.column(2)).draw(name), f"{PICTURES} or .html"),
        (
            lambda name: ds.plan(ds.scenes.column(2)).save(name),
            f".json, {PICTURES}, .html, .gif or .mp4",
        ),
        (
            lambda name: ds.simulate(ds.scenes.column(2), steps=1).save(name),
            f".npz, .html, .gif, .mp4, {PICTURES[:-6]} or .png",
        ),
        (lambda name: ds.scenes.arch(5).view().save(name), ".html"),
    ],
)
@pytest.mark.parametrize("name", ["a.bmp", "a"])
def test_an_unknown_ending_is_refused_with_those_that_work(
    write: Callable[[str], None],
    known: str,
    name: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match=f"^{name}: give it a name that ends in {known}$"):
        write(name)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["verdict", "limit", "margin", "plan"])
def test_answers_are_saved_by_the_ending_of_the_name(name: str, tmp_path: Path) -> None:
    answer = THINGS[name]()
    answer.save(tmp_path / "a.json")  # type: ignore[attr-defined]
    told = json.loads((tmp_path / "a.json").read_text())
    assert told.keys() == answer.to_dict().keys()  # type: ignore[attr-defined]
    answer.save(tmp_path / "a.pdf")  # type: ignore[attr-defined]
    first = (tmp_path / "a.pdf").read_bytes()
    assert first.startswith(b"%PDF")
    answer.save(tmp_path / "a.pdf")  # type: ignore[attr-defined]
    assert (tmp_path / "a.pdf").read_bytes() == first, "the same every time"


def test_a_run_is_saved_as_what_the_name_says(tmp_path: Path) -> None:
    run = ds.simulate(ds.scenes.fall7(), steps=24, forces=True)
    for name in ("run.npz", "run.html", "run.svg", "run.gif"):
        run.save(tmp_path / name, dpi=40)
    assert ds.Run.load(tmp_path / "run.npz").steps == 24
    assert "<html" in (tmp_path / "run.html").read_text()[:200]
    with Image.open(tmp_path / "run.gif") as film:
        assert film.n_frames == 3  # 0.1 s at 25 pictures a second, both ends included
        assert film.info["duration"] == 40


def test_who_waits_for_a_film_is_told_how_far_it_is(tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    run = ds.simulate(ds.scenes.fall7(), steps=24)
    save_film(run, tmp_path / "a.gif", 40, lambda *done: told.append(done))
    assert told == [(1, 3), (2, 3), (3, 3)]


def test_a_plan_is_a_film_of_its_steps(tmp_path: Path) -> None:
    plan = ds.plan(ds.scenes.column(4))
    plan.save(tmp_path / "plan.gif", dpi=40)
    with Image.open(tmp_path / "plan.gif") as film:
        assert film.n_frames == len(plan.order) + 1


def test_mp4_without_ffmpeg_says_what_to_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("shutil.which", lambda name: None)
    monkeypatch.setitem(__import__("sys").modules, "imageio_ffmpeg", None)
    with pytest.raises(ds.DrystoneError, match="pip install imageio-ffmpeg"):
        ds.plan(ds.scenes.column(3)).save(tmp_path / "a.mp4")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["scene in space", "verdict", "plan", "run", "world"])
def test_from_a_script_it_opens_in_the_browser(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", lambda url: bool(opened.append(url)) or True)
    THINGS[name]().show()
    (url,) = opened
    path = Path(urlparse(url).path)
    has_page = name != "world"
    assert path.name == ("page.html" if has_page else "picture.svg")
    assert path.stat().st_size > 1000


def test_without_a_browser_it_says_where(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(webbrowser, "open", lambda url: False)
    ds.plan(ds.scenes.column(3)).view().show()
    assert "page.html" in capsys.readouterr().err
