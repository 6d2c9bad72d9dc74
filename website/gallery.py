"""The gallery: programs of some ten lines in `examples/gallery`, each of which makes one picture.

    .venv/bin/python website/gallery.py [folder]

runs them all and puts the pictures into docs/pictures/gallery, where the guide shows them as well.
"""

from __future__ import annotations

import ast
import contextlib
import os
import runpy
import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl

ROOT = Path(__file__).parent.parent
PROGRAMS = ROOT / "examples" / "gallery"
PICTURES = ROOT / "docs" / "pictures" / "gallery"
ENDINGS = (".svg", ".png")
PLOTS = {
    "svg.hashsalt": "drystone",
    "svg.fonttype": "none",
    "savefig.bbox": "tight",
    "axes.spines.top": False,
    "axes.spines.right": False,
}
"""How the programs' own plots look: the same bytes each time, and text that stays text."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One program and what it says of itself."""

    path: Path
    title: str
    """The first line of its docstring."""
    text: str
    """The rest of it."""
    source: str
    """The program without its docstring."""

    @property
    def picture(self) -> str | None:
        """The name of its picture, if there is one."""
        names = (self.path.with_suffix(ending).name for ending in ENDINGS)
        return next((name for name in names if (PICTURES / name).exists()), None)


def entries() -> list[Entry]:
    """Every program, by name."""
    return [_entry(path) for path in sorted(PROGRAMS.glob("*.py"))]


def _entry(path: Path) -> Entry:
    text = path.read_text()
    module = ast.parse(text)
    title, _, rest = (ast.get_docstring(module) or path.stem).partition("\n")
    lines = text.splitlines()[module.body[0].end_lineno :]
    return Entry(path, title, rest.strip(), "\n".join(lines).strip())


def run(entry: Entry, folder: Path) -> Path:
    """Run the program in `folder`; returns the picture that it made there."""
    os.environ["SOURCE_DATE_EPOCH"] = "0"  # matplotlib's: no date of today in a picture
    with _inside(folder), mpl.rc_context(PLOTS):
        runpy.run_path(str(entry.path), run_name="__main__")
    made = [path for ending in ENDINGS if (path := folder / f"{entry.path.stem}{ending}").exists()]
    if len(made) != 1:
        raise FileNotFoundError(f"{entry.path.name} makes no picture of its own name")
    return made[0]


@contextlib.contextmanager
def _inside(folder: Path):  # type: ignore[no-untyped-def]
    """`contextlib.chdir`, which Python 3.10 lacks."""
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


def markdown() -> str:
    """The gallery as a page: title, text, picture and program of each."""
    parts = []
    for entry in entries():
        name = entry.picture
        if name is None:
            raise FileNotFoundError(f"no picture of {entry.path.name}: run website/gallery.py")
        parts.append(
            f"## {entry.title}\n\n{entry.text}\n\n"
            f"![{entry.title}](pictures/gallery/{name}){{ .shot }}\n\n"
            f"```python\n{entry.source}\n```\n"
        )
    return "\n".join(parts)


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURES
    target.mkdir(parents=True, exist_ok=True)
    for one in entries():
        picture = run(one, target)
        print(f"{picture.name}: {picture.stat().st_size / 1000:.0f} kB")
