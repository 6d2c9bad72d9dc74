"""The site's pictures are made, its notebooks run, and its pages of the API name everything."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest

import drystone as ds
from conftest import ROOT

NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
LARGEST = 300_000
"""Bytes of a picture that every reader of a page loads."""

sys.path.insert(0, str(ROOT / "website"))
import films  # noqa: E402
import gallery  # noqa: E402
import terminal  # noqa: E402


@pytest.fixture(autouse=True)
def no_window() -> Iterator[None]:
    """Plots are drawn into files."""
    import matplotlib as mpl
    from matplotlib import pyplot as plt

    mpl.use("agg")
    yield
    plt.close("all")


@pytest.mark.parametrize("entry", gallery.entries(), ids=lambda entry: entry.path.stem)
def test_gallery(entry: gallery.Entry, tmp_path: Path) -> None:
    """A program makes a picture of its own name, which the site has, and says what it shows."""
    picture = gallery.run(entry, tmp_path)
    assert entry.picture == picture.name
    assert 0 < picture.stat().st_size < LARGEST
    assert entry.text
    assert entry.source.startswith(("import", "from"))


@pytest.mark.parametrize("name", films.FILMS)
def test_films(name: str) -> None:
    """A film is an SVG picture that moves, small, and the same as the one that the README shows.

    Places are rounded to a tenth of a pixel, so the last bits of another machine do not matter.
    """
    text = films.FILMS[name]().svg()
    assert len(text) < LARGEST
    root = ElementTree.fromstring(text)
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    assert text.count("@keyframes") > 10
    kept = (ROOT / "docs" / "pictures" / f"{name}.svg").read_text()
    assert [len(text), text.count("@keyframes")] == pytest.approx(
        [len(kept), kept.count("@keyframes")], rel=0.01
    ), "run `make pictures`"


def test_the_terminal_shows_no_times() -> None:
    """So that the same program gives the same picture; what a command prints is in it."""
    text = terminal.picture(["check column:2", "plan column:3"])
    assert "Stands: 1 block" in text
    assert "Order found for 2 blocks; 1 test, 2 pivots.<" in text
    ElementTree.fromstring(text)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
@pytest.mark.filterwarnings("ignore:FigureCanvasAgg is non-interactive")
def test_notebooks(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every cell runs, and some show a picture; outputs are not kept in the repository."""
    shell = pytest.importorskip("IPython.core.interactiveshell").InteractiveShell()
    monkeypatch.chdir(tmp_path)
    cells = [c for c in json.loads(path.read_text())["cells"] if c["cell_type"] == "code"]
    pictures = 0
    for cell in cells:
        assert cell["outputs"] == []
        result = shell.run_cell("".join(cell["source"]))
        result.raise_error()
        kinds, _ = shell.display_formatter.format(result.result)
        pictures += (
            bool({"image/svg+xml", "text/html"} & set(kinds)) or "plt.show()" in cell["source"]
        )
    assert pictures >= 1


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_open_in_colab(path: Path) -> None:
    text = path.read_text()
    assert f"colab.research.google.com/github/drystone/drystone/blob/main/{_inside(path)}" in text
    assert "%pip install -q" in text


def _inside(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def test_the_site_has_every_page() -> None:
    """What is in `docs` is in the menu of the site."""
    menu = (ROOT / "mkdocs.yml").read_text()
    for path in (ROOT / "docs").rglob("*"):
        if path.suffix in (".md", ".ipynb"):
            assert path.relative_to(ROOT / "docs").as_posix() in menu, path


def test_the_api_has_every_public_name() -> None:
    pages = "".join(path.read_text() for path in (ROOT / "docs" / "api").glob("*.md"))
    documented = set(re.findall(r"^::: drystone\.(\w+)", pages, re.MULTILINE))
    assert documented == {name for name in ds.__all__ if not name.startswith("__")}
