"""The build backend: maturin's, after a look whether everything that a package carries is there.

The viewer's pages are bundled by Node and the licences of others are gathered by cargo, both before
anything is packed (`make sdist`, `make wheel`). An sdist has them, so that it needs Rust only. A
checkout without them must not become a package that lacks them in silence.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import maturin
from maturin import (
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "prepare_metadata_for_build_editable",
    "prepare_metadata_for_build_wheel",
]

ROOT = Path(__file__).resolve().parents[1]
MADE = {
    "python/drystone/viewer/page.html": "make build",
    "python/drystone/viewer/space.html": "make build",
    "THIRD-PARTY-NOTICES.txt": "make notices",
}
"""What git ignores and packages carry, and the command that makes it."""

Settings = Mapping[str, Any] | None


def build_wheel(directory: str, settings: Settings = None, metadata: str | None = None) -> str:
    check(MADE)
    return maturin.build_wheel(directory, settings, metadata)


def build_sdist(directory: str, settings: Settings = None) -> str:
    check(MADE)
    return maturin.build_sdist(directory, settings)


def build_editable(directory: str, settings: Settings = None, metadata: str | None = None) -> str:
    """Nothing is packed: the pages may come later, and say so where they are missed."""
    return maturin.build_editable(directory, settings, metadata)


def check(files: Mapping[str, str], root: Path = ROOT) -> None:
    """End the build with one line a missing file."""
    missing = [f"{name} (run: {how})" for name, how in files.items() if not (root / name).is_file()]
    if missing:
        sys.exit("drystone cannot be packed, since this checkout lacks " + ", ".join(missing))
