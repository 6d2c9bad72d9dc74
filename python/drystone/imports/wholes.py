"""Files of the whole beside those of its parts."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from drystone.meshes import MeshError
from drystone.meshes.reading import Triangles, read_triangles

AS_LARGE = 0.9
"""A file of the whole is at least this share as large as all parts together, by the diagonal; or it
reaches around half of them."""

AS_FINE = 0.5
"""It has at least this share of their triangles: a ground under them has fewer."""


def whole_files(files: Sequence[Path]) -> set[Path]:
    """The mesh files of a folder that hold the whole, beside files of its parts.

    There are at least two parts whose names are numbers; a file of the whole has another name, and
    is as large and as fine as all parts together."""
    numbered = [file for file in files if file.stem.isdecimal()]
    others = [file for file in files if not file.stem.isdecimal()]
    if len(numbered) < 2 or not others:
        return set()
    parts = [read for file in numbered if (read := _read(file)) is not None]
    if not parts:
        return set()
    diagonal = _diagonal(np.concatenate([part.vertices for part in parts]))
    count = sum(len(part.triangles) for part in parts)
    middles = np.array([part.vertices.mean(axis=0) for part in parts])

    def is_whole(file: Path) -> bool:
        read = _read(file)
        if read is None or len(read.triangles) < AS_FINE * count:
            return False
        low, high = read.vertices.min(axis=0), read.vertices.max(axis=0)
        around = ((low <= middles) & (middles <= high)).all(axis=1).mean() >= 0.5
        return bool(around) or _diagonal(read.vertices) >= AS_LARGE * diagonal

    return {file for file in others if is_whole(file)}


def _read(file: Path) -> Triangles | None:
    """What a file holds; what cannot be read is an error where the part is taken."""
    try:
        return read_triangles(file)
    except MeshError:
        return None


def _diagonal(points: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))
