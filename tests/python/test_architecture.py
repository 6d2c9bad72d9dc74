"""ARCHITECTURE.md and docs/notation.md say what is there."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path

import numpy as np
import pytest

import drystone as ds
from conftest import ROOT
from drystone import _core
from rust_imports import circles

PAGES = ["ARCHITECTURE.md", "docs/notation.md"]


def _code(page: str) -> set[str]:
    return set(re.findall(r"`([^`\n]+)`", (ROOT / page).read_text()))


@pytest.mark.parametrize("page", PAGES)
def test_every_file_named_exists(page: str) -> None:
    text = (ROOT / page).read_text()
    for link in re.findall(r"\]\(([^)#]+)\)", text):
        assert ((ROOT / page).parent / link).is_file(), link
    paths = {code for code in _code(page) if "/" in code and " " not in code}
    for path in paths:
        assert (ROOT / path).exists() or (ROOT / "crates/drystone/src" / path).exists(), path
    if page == "ARCHITECTURE.md":
        assert len(paths) > 30


def test_the_files_named_hold_the_types_named() -> None:
    """What a row of the first table says is made is defined or returned in one of its files."""
    text = (ROOT / "ARCHITECTURE.md").read_text()
    rows = re.findall(r"^\| ([a-z ]+) \|([^|]*)\|[^|]*\|([^|]*)\|$", text, re.MULTILINE)
    assert len(rows) > 10
    for step, made, files in rows:
        if step in ("step", "show"):
            continue
        texts = "".join((ROOT / path).read_text() for path in re.findall(r"`([^`]+/[^`]+)`", files))
        for name in re.findall(r"`(?:lcp\.)?([A-Z]\w+)`", made):
            assert re.search(rf"\b{name}\b", texts), f"{step}: {name}"


def _sources(*folders: str) -> list[Path]:
    return [path for folder in folders for path in sorted((ROOT / folder).rglob("*.rs"))]


def test_who_may_know_whom() -> None:
    for path in _sources("crates/lcp/src"):
        assert not re.search(r"\bdrystone::", path.read_text()), path
    for path in _sources("crates/contact/src"):
        assert not re.search(r"\bdrystone::", path.read_text()), path
    physics = "crates/drystone/src/"
    for path in _sources(physics + "geometry", physics + "contact", physics + "io"):
        assert "drystone_lcp" not in path.read_text(), path
    for path in _sources("crates/lcp/src/pivot"):
        assert not re.search(r"\b(Dense|Sparse)Factor\b", path.read_text()), path


PACKAGE = ROOT / "python/drystone"


def _module(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {_module(path): path for path in sorted(PACKAGE.rglob("*.py"))}


def _imported(name: str) -> Iterator[str]:
    """Files that a file imports: at the top, within a function or for types alone."""
    for node in ast.walk(ast.parse(MODULES[name].read_text())):
        found: list[str] = []
        if isinstance(node, ast.Import):
            found = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{name}: imports are written in full"
            module = node.module or ""
            found = [
                inner if (inner := f"{module}.{alias.name}") in MODULES else module
                for alias in node.names
                if f"{module}.{alias.name}" != "drystone._core"
            ]
        for module in found:
            if module in MODULES:
                yield module
                # A file of another folder comes with that folder's `__init__`.
                folder = module.rpartition(".")[0]
                if folder not in ("", "drystone") and not f"{name}.".startswith(f"{folder}."):
                    yield folder


def test_no_circle_of_imports() -> None:
    """Deferred and type-only imports counted: TopologicalSorter names a circle if there is one."""
    graph = {name: set(_imported(name)) - {name} for name in MODULES}
    order = list(TopologicalSorter(graph).static_order())
    assert len(order) == len(MODULES) > 100


def test_no_circle_of_uses_in_rust() -> None:
    """Only the parts of `cone/membership.rs` know the solver whose methods they are."""
    found = {crate.name: circles(crate) for crate in sorted((ROOT / "crates").iterdir())}
    assert set(found) == {"contact", "drystone", "lcp", "python"}
    for crate, groups in found.items():
        for group in groups:
            assert all(name.startswith("cone::membership") for name in group), f"{crate}: {group}"


def test_circles_in_rust_are_seen(tmp_path: Path) -> None:
    """Through a re-export, an item named in full, and one of a module below; tests do not count."""
    files = {
        "lib.rs": "mod a; mod b; mod c; mod d; pub use b::Second;",
        "a.rs": "use crate::{Second, c::Third}; pub struct First;",
        "b.rs": "pub struct Second(crate::a::First);",
        "c.rs": "pub struct Third; #[cfg(test)] mod tests { use crate::a::First; }",
        "d.rs": "mod e; pub struct Fourth; pub fn f() { e::g() }",
        "d/e.rs": "use super::Fourth; pub fn g() {}",
    }
    (tmp_path / "src" / "d").mkdir(parents=True)
    for name, text in files.items():
        (tmp_path / "src" / name).write_text(text)
    assert circles(tmp_path) == [["a", "b"], ["d", "d::e"]]


def test_rooms_of_the_package_are_in_the_order_of_the_data() -> None:
    """A room imports those named before it in ARCHITECTURE.md, and no other."""
    page = (ROOT / "ARCHITECTURE.md").read_text()
    listed = re.search(r"^ {6}(common -> .*?)\n\n", page, re.MULTILINE | re.DOTALL)
    assert listed is not None
    rooms = re.findall(r"\w+", listed[1])
    place = {room: k for k, room in enumerate(rooms)}
    assert set(rooms) == {name.split(".")[1] for name in MODULES if "." in name} - {"__main__"}
    for name in MODULES:
        if "." not in name or name.endswith("__main__"):
            continue
        for other in _imported(name):
            assert other != "drystone", f"{name} imports the package that puts all together"
            assert place[other.split(".")[1]] <= place[name.split(".")[1]], f"{name}: {other}"


@pytest.fixture
def slope() -> ds.Scene:
    return ds.scenes.slope(20, friction=0.5, width=2)


def test_signs_of_contacts_and_forces(slope: ds.Scene) -> None:
    """The plane is the first body: its normal points up into the block, its tangent downhill."""
    angle = np.radians(20)
    verdict = ds.check(slope)
    assert verdict.stable
    for force in verdict.forces:
        assert (force.a, force.b) == ("plane", "1")
        normal = np.array([-np.sin(angle), np.cos(angle)])
        assert force.normal == pytest.approx(normal)
        assert force.normal_force >= 0
    # The plane's friction holds the block back, uphill: against the normal turned to the left.
    along = sum(force.tangential_force for force in verdict.forces)
    assert along == pytest.approx(-slope.body("1").mass * 9.81 * np.sin(angle))


def test_columns_of_the_generators(slope: ds.Scene) -> None:
    """Two unit edges a contact, n + mu t first, with their moment about the centroid."""
    g = _core.generators(slope._core)
    columns = g.data.reshape(-1, 3)
    assert list(g.indices) == [0, 1, 2] * len(columns)
    for j, column in enumerate(columns):
        contact = slope.contacts[g.contact[j]]
        n = np.array(contact.normal)
        t = np.array([-n[1], n[0]])
        d = (n + (0.5, -0.5)[j % 2] * t) / np.sqrt(1.25)
        r = np.array(contact.point) - slope.body("1").centroid
        assert column == pytest.approx([*d, r[0] * d[1] - r[1] * d[0]])
    mass = slope.body("1").mass
    assert g.applied == pytest.approx([0, -9.81 * mass, 0])
    assert 1 / g.inverse_mass == pytest.approx([mass, mass, slope.body("1").inertia])
