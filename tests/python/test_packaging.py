"""What is packed: metadata that agree, licences of others, and no package without its pages."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import io
import json
import re
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import drystone as ds
from conftest import ROOT

tomllib = pytest.importorskip("tomllib", reason="Python 3.11 and newer read TOML")


def _project() -> dict[str, Any]:
    return tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def _workspace() -> dict[str, Any]:
    return tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]


def _script(name: str) -> ModuleType:
    """A program of the folder release/, as a module."""
    spec = importlib.util.spec_from_file_location(f"release_{name}", ROOT / f"release/{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module


def test_one_version() -> None:
    """Cargo's, as Python writes it."""
    declared = _workspace()["package"]["version"]
    assert ds.__version__ == declared.replace("-dev", ".dev0")
    assert importlib.metadata.version("drystone") == ds.__version__
    for name, crate in _workspace()["dependencies"].items():
        if name.startswith("drystone"):
            assert crate["version"] == declared


def test_one_address() -> None:
    """The repository's is that of Cargo.toml, the site's that of mkdocs.yml, wherever written."""
    address = _workspace()["package"]["repository"]
    site = re.search(r"^site_url: (\S+)$", (ROOT / "mkdocs.yml").read_text(), re.MULTILINE)
    assert site is not None
    for name, url in _project()["urls"].items():
        assert url.startswith(site[1] if name == "Documentation" else address), name
    assert f'repository-code: "{address}"' in (ROOT / "CITATION.cff").read_text()
    assert f"repo_url: {address}\n" in (ROOT / "mkdocs.yml").read_text()


def test_few_packages_are_required() -> None:
    assert sorted(re.findall(r"^\w+", need)[0] for need in _project()["dependencies"]) == [
        "numpy",
        "rich",
        "typer",
    ]


def test_all_and_dev_hold_the_other_extras() -> None:
    extras = _project()["optional-dependencies"]
    features = extras.keys() - {"all", "test", "dev", "docs", "bench"}
    named = re.fullmatch(r"drystone\[([\w,]+)\]", extras["all"][0])
    assert named is not None
    assert set(named[1].split(",")) == features
    for extra in (*features, "test"):
        assert set(extras[extra]) <= set(extras["dev"]), extra


def test_the_page_on_installing_has_every_extra() -> None:
    extras = _project()["optional-dependencies"].keys() - {"test", "dev", "docs", "bench"}
    page = (ROOT / "docs" / "install.md").read_text()
    assert set(re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE)) == extras


def test_the_package_for_compas_is_apart() -> None:
    """It needs drystone, not the reverse; its version is written twice, its licences are ours."""
    folder = ROOT / "compas_drystone"
    project = tomllib.loads((folder / "pyproject.toml").read_text())["project"]
    init = (folder / "src/compas_drystone/__init__.py").read_text()
    assert f'__version__ = "{project["version"]}"' in init
    assert any(need.startswith("drystone") for need in project["dependencies"])
    extras = _project()["optional-dependencies"].values()
    assert "compas" not in repr([_project()["dependencies"], *extras])
    for name in ("LICENSE-MIT", "LICENSE-APACHE"):
        assert (folder / name).read_text() == (ROOT / name).read_text()
    address = _workspace()["package"]["repository"]
    assert project["urls"]["Repository"] == address


def test_a_checkout_without_pages_is_not_packed(tmp_path: Path) -> None:
    backend = _script("backend")
    for name in backend.MADE:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    backend.check(backend.MADE, tmp_path)
    (tmp_path / "python/drystone/viewer/space.html").unlink()
    with pytest.raises(SystemExit, match=r"lacks .*space\.html \(run: make build\)$"):
        backend.check(backend.MADE, tmp_path)


def test_everything_that_is_made_is_included() -> None:
    included = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["maturin"]["include"]
    formats = {one["path"]: one["format"] for one in included}
    for name in _script("backend").MADE:
        assert "sdist" in formats[name], name


@pytest.mark.skipif(shutil.which("cargo") is None, reason="cargo tells what is linked")
def test_every_linked_crate_has_a_licence() -> None:
    crates = _script("notices").crates()
    names = {crate.name for crate in crates}
    assert {"faer", "parry2d-f64", "parry3d-f64", "pyo3", "rayon"} <= names
    # Only built with, only tested with, only ours.
    assert not names & {"pyo3-macros", "proptest", "drystone"}
    assert all(crate.texts and all(crate.texts) for crate in crates)


def test_what_is_bundled_has_a_licence() -> None:
    notices = _script("notices")
    if not (ROOT / "viewer/node_modules/three").is_dir():
        pytest.skip("the viewer's packages are not here")
    (three,) = notices.bundled()
    assert three.name == "three"
    wanted = json.loads((ROOT / "viewer/package.json").read_text())["devDependencies"]["three"]
    assert three.version == wanted
    page = notices.written([three, three])
    assert page.count("three.js authors") == 1


def test_a_crate_without_a_licence_file_gets_the_standard_text() -> None:
    notices = _script("notices")
    text = notices._standard("tiny", "MIT OR Apache-2.0", ["A. Nobody"])
    assert text
    assert "Copyright (c) A. Nobody" in notices._standard("tiny", "MIT", ["A. Nobody"])
    with pytest.raises(notices.NoticesError, match="tiny has no licence file"):
        notices._standard("tiny", "WTFPL", [])


LOG = """# Changelog

## 0.3.0

Not yet.

## 0.2.0 - 2026-12-01

### Added

- A thing.

## 0.1.0 - 2026-11-22

The first.
"""


def test_the_text_of_a_release_is_its_part_of_the_changelog() -> None:
    changelog = _script("changelog")
    assert changelog.section(LOG, "v0.2.0") == "### Added\n\n- A thing."
    assert changelog.section(LOG, "v0.1.0") == "The first."
    for tag, fault in {
        "v0.3.0": "has no date",
        "v0.4.0": "has no section",
        "0.2.0": "is v and three numbers",
    }.items():
        with pytest.raises(changelog.ChangelogError, match=fault):
            changelog.section(LOG, tag)


def test_a_tag_is_the_version_of_the_packages() -> None:
    changelog = _script("changelog")
    changelog.check('[workspace.package]\nversion = "0.2.0"\n', "v0.2.0")
    with pytest.raises(changelog.ChangelogError, match=r"is 0\.2\.0-dev$"):
        changelog.check('[workspace.package]\nversion = "0.2.0-dev"\n', "v0.2.0")


def test_actions_are_pinned_by_commit() -> None:
    """One hash an action, with its version beside it, in all workflows."""
    used: dict[str, set[str]] = {}
    for path in (ROOT / ".github/workflows").glob("*.yml"):
        for action, rest in re.findall(r"uses: ([\w./-]+)@(.*)", path.read_text()):
            assert re.fullmatch(r"[0-9a-f]{40} # v\d+\.\d+\.\d+", rest), (path.name, action)
            used.setdefault(action, set()).add(rest)
    assert len(used) > 8
    assert all(len(pins) == 1 for pins in used.values()), used


def test_links_of_a_packed_readme_are_absolute(tmp_path: Path) -> None:
    readme = _script("readme")
    page = '[a](docs/a.md) [b](https://b.org) [c](#c) <img src="docs/p.svg"> [d](LICENSE-MIT)'
    made = readme.absolute(page, "https://host/us", "0.2.0")
    assert made == (
        "[a](https://host/us/blob/v0.2.0/docs/a.md) [b](https://b.org) [c](#c) "
        '<img src="https://host/us/raw/v0.2.0/docs/p.svg"> '
        "[d](https://host/us/blob/v0.2.0/LICENSE-MIT)"
    )
    assert "/blob/main/docs" in readme.absolute(page, "https://host/us", "0.3.0.dev0")
    sdist = tmp_path / "drystone-0.2.0.tar.gz"
    files = {"README.md": page, "PKG-INFO": f"Name: drystone\n\n{page}", "a/README.md": page}
    files["Cargo.toml"] = '[workspace.package]\nrepository = "https://host/us"\n'
    with tarfile.open(sdist, "w:gz") as archive:
        for name, text in files.items():
            entry = tarfile.TarInfo(f"drystone-0.2.0/{name}")
            entry.size = len(text)
            archive.addfile(entry, io.BytesIO(text.encode()))
    readme.rewrite(sdist)
    once = sdist.read_bytes()
    with tarfile.open(sdist) as archive:
        for name, text in files.items():
            member = archive.extractfile(f"drystone-0.2.0/{name}")
            assert member is not None
            shown = name in ("README.md", "PKG-INFO")
            assert member.read().decode() == (text.replace(page, made) if shown else text)
    readme.rewrite(sdist)  # nothing is left to be made absolute
    assert sdist.read_bytes() == once


@pytest.mark.skipif(shutil.which("cargo") is None, reason="cargo tells the features of crates")
def test_tests_are_linked_from_what_the_wheel_is() -> None:
    """Another feature of one crate, and cargo compiles all that use it again for the tests."""

    def features(*chosen: str) -> dict[str, str]:
        command = ["cargo", "tree", "--locked", "--prefix", "none", "--format", "{p}|{f}", *chosen]
        ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
        lines = (line.removesuffix(" (*)").split("|") for line in ran.stdout.splitlines() if line)
        return {crate: enabled.removesuffix(" (*)") for crate, enabled in lines}

    wheel = features("--edges", "normal", "--package", "drystone-python")
    tests = features("--edges", "normal,dev", "--workspace")
    assert {crate: tests[crate] for crate in wheel} == wheel
    assert len(wheel) > 50
