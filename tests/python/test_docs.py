"""What the documentation shows is run."""

from __future__ import annotations

import doctest
import importlib
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pytest

import drystone as ds
from conftest import ROOT

FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
FOLDERS = ("docs", "docs/guide", "docs/for", "docs/theory")
MODULES = sorted(
    module.name
    for module in pkgutil.walk_packages(ds.__path__, "drystone.")
    if not module.name.endswith("_core")
)


@pytest.mark.parametrize("name", MODULES)
def test_docstrings(name: str) -> None:
    assert doctest.testmod(importlib.import_module(name), optionflags=FLAGS).failed == 0


IN_DOCS = sorted(
    f"{folder}/{path.name}" for folder in FOLDERS for path in (ROOT / folder).glob("*.md")
)
PAGES = ["README.md", "CONTRIBUTING.md", *IN_DOCS]


@pytest.mark.parametrize("page", PAGES)
def test_pages(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The examples of a page run one after another, in one namespace."""
    monkeypatch.chdir(tmp_path)
    code = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(), flags=re.DOTALL)
    test = doctest.DocTestParser().get_doctest("\n".join(code), {}, page, None, 0)
    assert doctest.DocTestRunner(optionflags=FLAGS).run(test).failed == 0


def test_the_readme_has_an_example() -> None:
    assert ">>> ds.check(scene).stable" in (ROOT / "README.md").read_text()


def test_the_first_page_says_what_its_example_gives() -> None:
    """It is written as a script, with the values behind it."""
    (code,) = re.findall(r"```python\n(.*?)```", (ROOT / "docs/index.md").read_text(), re.DOTALL)
    names: dict[str, object] = {}
    exec(code, names)
    arch = names["arch"]
    assert isinstance(arch, ds.Scene)
    assert ds.check(arch).stable
    assert ds.plan(arch).status == "no_order"
    assert len(ds.plan(arch, hold=1).order) == 11


RULES = ["RELEASING.md", "SECURITY.md", "CODE_OF_CONDUCT.md", "CHANGELOG.md", "fuzz/README.md"]


@pytest.mark.parametrize("page", [*PAGES, *RULES])
def test_links_lead_somewhere(page: str) -> None:
    text = (ROOT / page).read_text()
    links = re.findall(r"\]\(([^)#]+)\)", text) + re.findall(r'src="([^"]+)"', text)
    for link in links:
        if not link.startswith("http"):
            assert ((ROOT / page).parent / link).exists(), link


@pytest.mark.parametrize(
    "path", sorted((ROOT / "examples").glob("*.py")), ids=lambda path: path.name
)
def test_examples(path: Path, tmp_path: Path) -> None:
    ran = subprocess.run(
        [sys.executable, "-W", "error", path], cwd=tmp_path, capture_output=True, text=True
    )
    assert (ran.returncode, ran.stderr) == (0, "")
    assert ran.stdout.strip()


def test_every_public_name_is_there_and_documented() -> None:
    for name in ds.__all__:
        value = getattr(ds, name)
        assert name in dir(ds)
        assert isinstance(value, str) or value.__doc__
    with pytest.raises(AttributeError, match="teleport"):
        ds.teleport  # noqa: B018


@pytest.mark.parametrize("page", [*PAGES, "CHANGELOG.md"])
def test_what_pages_name_of_a_class_is_there(page: str) -> None:
    """As `Verdict.forces`, of every class of the package."""
    for name, attribute in re.findall(
        r"`(?:ds\.)?([A-Z]\w+)\.([a-z]\w+)", (ROOT / page).read_text()
    ):
        kind = getattr(ds, name, None)
        if isinstance(kind, type):
            known = {*dir(kind), *getattr(kind, "__annotations__", {})}
            assert attribute in known, f"{name}.{attribute}"


def test_the_paper_cites_what_its_bibliography_lists() -> None:
    text = (ROOT / "paper/paper.md").read_text()
    listed = set(
        re.findall(r"^@\w+\{(\w+),$", (ROOT / "paper/paper.bib").read_text(), re.MULTILINE)
    )
    cited = set(re.findall(r"@(\w+)", text.split("---", 2)[2]))
    assert cited == listed
    for figure in re.findall(r"\]\((\S+\.png)\)", text):
        assert (ROOT / "paper" / figure).is_file()
