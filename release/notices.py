"""Gather the licences of everything that the wheel contains of others: THIRD-PARTY-NOTICES.txt.

That is what the compiled library is linked from (crates, Rust's standard library), and what is
bundled into the viewer's pages. Needs cargo, and the packages of the viewer.

    python release/notices.py THIRD-PARTY-NOTICES.txt
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
LIBRARY = "drystone-python"
"""The crate that becomes the extension module."""

TEXTS = re.compile(r"(licen[cs]e|copying|notice|unlicense|copyright)", re.IGNORECASE)
STANDARD_TEXTS = {"Apache-2.0": "LICENSE-APACHE", "MIT": "LICENSE-MIT"}
"""Ours of the same licence, for crates that come without a file."""
OURS = re.compile(r"^Copyright .*$", re.MULTILINE)
"""The line of a standard text that names us."""

HEAD = """\
drystone's wheel contains the work of others, under the licences below. drystone itself is under MIT
or Apache-2.0, at your choice.

The standard library of Rust (https://www.rust-lang.org) is linked in as well: MIT OR Apache-2.0,
copyright the Rust Project Developers; the text of Apache-2.0 is that of drystone's own file.
"""


class NoticesError(Exception):
    """Something is in the wheel whose licence was not found."""


@dataclass(frozen=True, slots=True)
class Component:
    """A package of somebody else's."""

    name: str
    version: str
    licence: str
    source: str
    texts: tuple[str, ...]

    @property
    def title(self) -> str:
        return f"{self.name} {self.version} ({self.licence})"


def main() -> None:
    target = Path(sys.argv[1] if len(sys.argv) > 1 else "THIRD-PARTY-NOTICES.txt")
    try:
        text = written([*crates(), *bundled()])
    except NoticesError as error:
        sys.exit(f"notices: {error}")
    part = target.with_name(target.name + ".part")
    part.write_text(text, encoding="utf-8")
    part.replace(target)


def crates() -> list[Component]:
    """What the library is linked from on any platform: normal dependencies, not those of builds."""
    command = ["cargo", "metadata", "--format-version", "1", "--locked"]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if ran.returncode:
        raise NoticesError(f"cargo metadata failed: {ran.stderr.strip()}")
    metadata = json.loads(ran.stdout)
    packages = {package["id"]: package for package in metadata["packages"]}
    linked = _linked(metadata["resolve"]["nodes"], packages)
    foreign = [packages[one] for one in linked if packages[one]["source"] is not None]
    return [_crate(package) for package in sorted(foreign, key=lambda p: (p["name"], p["version"]))]


def _linked(nodes: list[dict[str, Any]], packages: dict[str, Any]) -> set[str]:
    """The library and all that it depends on, without what only runs while it is built."""
    needs = {node["id"]: node["deps"] for node in nodes}
    left = [one for one, package in packages.items() if package["name"] == LIBRARY]
    found = set(left)
    while left:
        for needed in needs[left.pop()]:
            normal = any(kind["kind"] is None for kind in needed["dep_kinds"])
            if (
                normal
                and needed["pkg"] not in found
                and not _runs_in_builds(packages[needed["pkg"]])
            ):
                found.add(needed["pkg"])
                left.append(needed["pkg"])
    return found


def _runs_in_builds(package: dict[str, Any]) -> bool:
    return any("proc-macro" in target["kind"] for target in package["targets"])


def _crate(package: dict[str, Any]) -> Component:
    folder = Path(package["manifest_path"]).parent
    name, licence = package["name"], package["license"] or "see below"
    texts = _texts(folder)
    if not texts:
        texts = (_standard(name, licence, package["authors"]),)
    source = package["repository"] or f"https://crates.io/crates/{name}"
    return Component(name, package["version"], licence, source, texts)


def _standard(name: str, licence: str, authors: list[str]) -> str:
    """The text of a licence that comes without one, in the name of the crate's authors."""
    standard = [text for known, text in STANDARD_TEXTS.items() if known in licence.split()]
    if not standard:
        raise NoticesError(f"crate {name} has no licence file, and {licence} no standard text")
    text = (ROOT / standard[0]).read_text(encoding="utf-8").strip()
    whose = ", ".join(authors) or f"the authors of {name}"
    return OURS.sub(f"Copyright (c) {whose}", text, count=1)


def _texts(folder: Path) -> tuple[str, ...]:
    files = [path for path in sorted(folder.iterdir()) if path.is_file()]
    named = [path for path in files if TEXTS.search(path.stem) and path.suffix != ".rs"]
    return tuple(path.read_text(encoding="utf-8", errors="replace").strip() for path in named)


def bundled() -> list[Component]:
    """The packages that the viewer's sources import."""
    imports = re.compile(r'from "([^".][^"]*)"')
    names: set[str] = set()
    for path in (ROOT / "viewer" / "src").rglob("*.ts"):
        for found in imports.findall(path.read_text(encoding="utf-8")):
            parts = found.split("/")
            names.add("/".join(parts[:2]) if found.startswith("@") else parts[0])
    return [_bundled(name) for name in sorted(names)]


def _bundled(name: str) -> Component:
    folder = ROOT / "viewer" / "node_modules" / name
    if not folder.is_dir():
        raise NoticesError(f"{folder} is missing: run make build")
    about = json.loads((folder / "package.json").read_text(encoding="utf-8"))
    texts = _texts(folder)
    if not texts:
        raise NoticesError(f"{name} of the viewer has no licence file")
    source = about.get("homepage") or f"https://www.npmjs.com/package/{name}"
    return Component(name, about["version"], about["license"], source, texts)


def written(components: list[Component]) -> str:
    """The page: who, and then each text once, with all to whom it belongs."""
    owners: dict[str, list[Component]] = defaultdict(list)
    texts: dict[str, str] = {}
    for component in components:
        for text in component.texts:
            words = " ".join(text.split())  # copies differ in how their lines are broken
            owners[words].append(component)
            texts.setdefault(words, text)
    parts = [HEAD, "\n".join(f"- {one.title}: {one.source}" for one in components)]
    for words, of in owners.items():
        parts.append("=" * 80 + "\n" + ", ".join(f"{one.name} {one.version}" for one in of))
        parts.append(texts[words])
    return "\n\n".join(parts) + "\n"


if __name__ == "__main__":
    main()
