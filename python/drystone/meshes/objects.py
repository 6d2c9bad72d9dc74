"""The bodies in one mesh file: objects or groups of OBJ, nodes of glTF, parts of 3MF and STEP."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path

import numpy as np

from drystone.meshes.errors import MeshError
from drystone.meshes.obj import read_obj
from drystone.meshes.reading import (
    NO_FACES,
    REPEATING,
    Triangles,
    checked,
    load,
    of_sections,
    of_trimesh,
    read_triangles,
    unit_of,
)

SPLITS = ("objects", "groups", "none")
"""What a file may be split by."""


@dataclass(frozen=True, slots=True, eq=False)
class Split:
    """A file's triangles by object."""

    parts: list[Triangles]
    empty: list[str]
    """Names of objects without faces."""
    messages: list[str]
    """Why it was not split, or how it could be."""


def read_split(source: str | PathLike[str], split: str | None) -> Split:
    """The triangles of a file by its objects (`o` of OBJ, nodes of glTF, parts of 3MF and STEP,
    solids of STL) or groups.

    `split` is one of `SPLITS`. None takes objects, or groups if there are no objects, unless these
    only are parts of one closed surface.
    """
    if split not in (None, *SPLITS):
        raise MeshError(f"split must be one of {', '.join(SPLITS)}, not {split!r}")
    path = checked(source)
    if split == "none":
        return Split([read_triangles(path)], [], [])
    if path.suffix.lower() == ".obj":
        return _split_obj(path, split)
    if split == "groups":
        raise MeshError("only OBJ files have groups: leave split out")
    parts = _nodes(path)
    return _or_whole(path, Split(parts, [], []), "objects", split)


def _split_obj(path: Path, split: str | None) -> Split:
    obj = read_obj(path)
    by_group = split == "groups" or (split is None and not any(o.name for o in obj.objects))
    sections = obj.groups if by_group else obj.objects
    parts = [of_sections(section.name or path.stem, obj, [section]) for section in sections]
    if not parts:
        raise MeshError(NO_FACES)
    messages, what = [], "groups" if by_group else "objects"
    if len(parts) == 1 and len(obj.groups) > 1 and split is None:
        messages.append(
            f"its {len(obj.groups)} groups are one rigid body: split='groups' makes a body of each"
        )
    return _or_whole(path, Split(parts, obj.empty, messages), what, split)


def _or_whole(path: Path, found: Split, what: str, split: str | None) -> Split:
    """All as one, if that is a closed surface of which the parts are only pieces."""
    if split is not None or len(found.parts) < 2 or all(map(_is_closed, found.parts)):
        return found
    whole = read_triangles(path)
    if not _is_closed(whole):
        return found
    return Split(
        [whole], [], [f"its {len(found.parts)} {what} are parts of one surface: taken as one body"]
    )


def _is_closed(mesh: Triangles) -> bool:
    """Whether every edge, by the places of its ends, has as many faces as a closed surface's."""
    _, where = np.unique(mesh.vertices + 0.0, axis=0, return_inverse=True)
    corners = where.reshape(-1)[mesh.triangles]
    halves = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    halves = halves[halves[:, 0] != halves[:, 1]]
    _, counts = np.unique(np.sort(halves, axis=1), axis=0, return_counts=True)
    return bool((counts % 2 == 0).all())


def _nodes(path: Path) -> list[Triangles]:
    """The meshes of a file where its nodes put them, by name."""
    repeats = path.suffix.lower() in REPEATING
    loaded = load(path, whole=False)
    unit = unit_of(path, loaded)
    if not hasattr(loaded, "graph"):
        return [replace(of_trimesh(loaded, path.stem, repeats), unit=unit)]
    parts = []
    for node in sorted(loaded.graph.nodes_geometry, key=in_order):
        matrix, geometry = loaded.graph[node]
        mesh = loaded.geometry[geometry]
        if not len(getattr(mesh, "faces", ())):
            continue
        mesh = mesh.copy()
        mesh.apply_transform(matrix)
        parts.append(replace(of_trimesh(mesh, str(node), repeats), unit=unit))
    if not parts:
        raise MeshError(NO_FACES)
    return parts if len(parts) > 1 else [replace(parts[0], name=path.stem)]


def in_order(name: str) -> list[tuple[int, str]]:
    """Sorts names with 2 before 10."""
    return [(int(x), "") if x.isdecimal() else (-1, x) for x in re.split(r"(\d+)", name)]
