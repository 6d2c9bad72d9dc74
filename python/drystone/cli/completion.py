"""What a shell offers when a user presses the tab key."""

from __future__ import annotations

from pathlib import Path

from drystone import _core


def scenes(incomplete: str) -> list[str]:
    """Built-in scenes, scene files and folders that begin with what is typed."""
    built_in = [name for name, _, _ in _core.catalogue()]
    folder, _, begun = incomplete.rpartition("/")
    try:
        entries = sorted(Path(folder or ("/" if incomplete.startswith("/") else ".")).iterdir())
    except OSError:
        entries = []
    within = f"{folder}/" if "/" in incomplete else ""
    paths = [
        f"{within}{entry.name}" + ("/" if entry.is_dir() else "")
        for entry in entries
        if entry.name.startswith(begun) and (entry.is_dir() or entry.suffix == ".json")
    ]
    return [name for name in built_in if name.startswith(incomplete)] + paths
