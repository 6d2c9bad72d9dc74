"""What is to be planned: names, and the texts of scene files."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Mapping, Sized
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from drystone.scene import Scene

OneScene: TypeAlias = "Scene | str | PathLike[str]"
Scenes: TypeAlias = "str | PathLike[str] | Iterable[OneScene] | Mapping[str, OneScene]"

LONGEST_NAME = 80
"""Characters of a scene's name that go into a file name: file systems allow 255 bytes."""
HASH_DIGITS = 16
"""Hexadecimal digits of the content hash in a file name. All 64 are inside the file."""


@dataclass(frozen=True, slots=True)
class Job:
    """One scene to plan."""

    name: str
    source: str
    """What error messages call it: the path, or the name."""
    text: str | None
    """The text of the scene file; None if it could not be read."""
    sha256: str | None
    """SHA-256 of the text in UTF-8, hexadecimal."""
    error: str | None = None
    """Why there is no text."""

    @property
    def key(self) -> str:
        """What tells it from the others: the name of its file, or of what could not be read."""
        if self.sha256 is None:
            return self.source
        return f"{safe(self.name)}-{self.sha256[:HASH_DIGITS]}.json"


def jobs_of(scenes: Scenes) -> tuple[Iterator[Job], int | None]:
    """The jobs, read one by one as they are asked for, and their number if it is known.

    Raises OSError for a file or folder that cannot be read, ValueError for one without scene files.
    """
    if isinstance(scenes, (str, PathLike)):
        path = Path(scenes)
        path.stat()  # the OSError, if it is not there
        files: list[OneScene] = list(_files(path)) if path.is_dir() else [path]
        return map(_job, files), len(files)
    if isinstance(scenes, Mapping):
        return (_job(scene, name) for name, scene in scenes.items()), len(scenes)
    return map(_job, scenes), len(scenes) if isinstance(scenes, Sized) else None


def _files(folder: Path) -> list[Path]:
    files = sorted(path for path in folder.glob("*.json") if path.is_file())
    if not files:
        raise ValueError(f"{folder}: no scene file (*.json) in this folder")
    return files


def _job(scene: OneScene, name: str | None = None) -> Job:
    from drystone.scene import Scene

    if isinstance(scene, Scene):
        text = scene.to_json()
        return Job(name or "scene", name or "scene", text, _hash(text.encode()))
    if isinstance(scene, (str, PathLike)):
        return _job_of_file(fspath(scene), name)
    raise TypeError(f"{scene!r} is neither a Scene nor the path of a scene file")


def _job_of_file(path: str, name: str | None) -> Job:
    name = name or Path(path).stem
    try:
        content = Path(path).read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a null character in the path
        why = (error.strerror if isinstance(error, OSError) else None) or str(error)
        return Job(name, path, None, None, f"{path}: {why}")
    try:
        return Job(name, path, content.decode("utf-8"), _hash(content))
    except UnicodeDecodeError as error:
        why = f"{path}: not UTF-8 text (byte {error.start}): save the scene file again"
        return Job(name, path, None, _hash(content), why)


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def safe(name: str) -> str:
    """`name` as a part of a file name on any system."""
    return re.sub(r"[^A-Za-z0-9._-]", "_", name).lstrip(".")[:LONGEST_NAME] or "scene"
