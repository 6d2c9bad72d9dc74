"""Names in scripts that matplotlib's own font does not have."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest
from matplotlib.font_manager import findfont, get_font

import drystone as ds
from drystone.pictures import fonts

SIGHT = "\u2316"
"""A character of STIX, which comes with matplotlib, that DejaVu Sans has not."""


def named(name: str) -> ds.Scene:
    scene = ds.Scene()
    scene.add_box((0, -0.5), (4, 1), fixed=True, name="ground")
    scene.add_box((0, 0.5), (1, 1), name=name)
    return scene


@pytest.fixture(autouse=True)
def nothing_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fonts, "_said", set())


def test_a_font_that_is_installed_is_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert ord(SIGHT) not in get_font(findfont("DejaVu Sans")).get_charmap()
    monkeypatch.setattr(fonts, "OTHERS", ("No Such Font", "STIXGeneral"))
    for kind in ("png", "pdf", "svg"):
        named(f"sight {SIGHT}").draw(tmp_path / f"taken.{kind}")
    monkeypatch.setattr(fonts, "OTHERS", ())
    with pytest.warns(UserWarning, match="no font here has"):
        named(f"sight {SIGHT}").draw(tmp_path / "box.png")
    assert (tmp_path / "taken.png").read_bytes() != (tmp_path / "box.png").read_bytes()
    assert SIGHT in (tmp_path / "taken.svg").read_text(encoding="utf-8")


def test_one_line_says_what_no_font_has(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fonts, "OTHERS", ())
    scene = named("\u77f3\u57a3 a\u77f3")
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        scene.draw(tmp_path / "scene.png")
        scene.draw(tmp_path / "scene.pdf")
        ds.simulate(scene, steps=30).save(tmp_path / "run.gif")
    assert [str(one.message).partition(":")[0] for one in told] == [
        "no font here has \u77f3 \u57a3"
    ]
    scene.draw(tmp_path / "scene.svg")  # says nothing: it has the text itself
    assert "\u77f3\u57a3" in (tmp_path / "scene.svg").read_text(encoding="utf-8")


def test_what_every_font_has_is_left_as_it_is(tmp_path: Path) -> None:
    for kind in ("png", "pdf", "svg"):
        ds.check(named("pierre taill\u00e9e")).draw(tmp_path / f"check.{kind}")
