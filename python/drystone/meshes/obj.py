"""Wavefront OBJ: vertices, faces, and the objects and groups that these belong to.

Read here and not by trimesh, which takes relative numbers of vertices from the end of the file and
not from the line where they stand, and loses the order of objects.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from drystone.meshes.errors import MeshError
from drystone.meshes.polygons import Triangle, triangulated

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(slots=True, eq=False)
class Section:
    """The faces under one `o` line, or under `g` lines of one name."""

    name: str
    """Empty for faces before the first such line."""
    triangles: list[Triangle] = field(default_factory=list)


@dataclass(slots=True, eq=False)
class Obj:
    """An OBJ file: each face is in one object and in one group."""

    vertices: NDArray[np.float64]
    """(k, 3), in the file's unit."""
    objects: list[Section]
    """One for each `o` line, though names may repeat; none without faces."""
    groups: list[Section]
    """One for each name of `g` lines; none without faces."""
    empty: list[str]
    """Names of objects without faces."""


def read_obj(path: Path) -> Obj:
    """An OBJ file; MeshError with the line if it is damaged. Polygons become triangles."""
    vertices: list[list[float]] = []
    objects, groups = [Section("")], {"": Section("")}
    group = groups[""]
    for number, line in _lines(path):
        keyword, _, rest = line.partition(" ")
        try:
            if keyword == "v":
                x, y, z, *_ = rest.split()
                vertices.append([float(x), float(y), float(z)])
            elif keyword == "f":
                triangles = _triangles(rest.split(), vertices)
                objects[-1].triangles += triangles
                group.triangles += triangles
            elif keyword == "o":
                objects.append(Section(rest.strip()))
            elif keyword == "g":
                group = groups.setdefault(rest.strip(), Section(rest.strip()))
        except ValueError:
            raise MeshError(
                f"cannot be read as OBJ: line {number} is {line[:60]!r}: export it again"
            ) from None
    return Obj(
        np.array(vertices, dtype=np.float64).reshape(-1, 3),
        [section for section in objects if section.triangles],
        [section for section in groups.values() if section.triangles],
        [section.name for section in objects if section.name and not section.triangles],
    )


def _lines(path: Path) -> Iterator[tuple[int, str]]:
    """Statements and the numbers of their lines; a backslash at the end continues a line."""
    begun, begun_at = "", 0
    text = path.read_bytes().decode("utf-8", errors="replace")
    for number, line in enumerate(text.splitlines(), 1):
        begun_at = begun_at if begun else number
        if line.endswith("\\"):
            begun += line[:-1] + " "
            continue
        statement = (begun + line).split("#")[0].replace("\t", " ").strip()
        begun = ""
        if statement:
            yield begun_at, statement


def _triangles(corners: list[str], vertices: list[list[float]]) -> list[Triangle]:
    """Triangles of a polygon `v/vt/vn ...` after the vertices above it."""
    numbers = [int(corner.partition("/")[0]) for corner in corners]
    if len(numbers) < 3 or 0 in numbers:
        raise ValueError
    # Counted from 1, or backwards from the line where the face stands.
    numbers = [k - 1 if k > 0 else len(vertices) + k for k in numbers]
    if len(numbers) == 3 or not all(0 <= k < len(vertices) for k in numbers):
        return [(numbers[0], a, b) for a, b in pairwise(numbers[1:])]
    triangles = triangulated(np.array([vertices[k] for k in numbers]))
    return [(numbers[a], numbers[b], numbers[c]) for a, b, c in triangles]
