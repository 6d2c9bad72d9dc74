"""Triangles out of mesh files: OBJ by `obj.py`, the rest through trimesh."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.common.extras import extra
from drystone.meshes.errors import MeshError
from drystone.meshes.msh import read_msh
from drystone.meshes.obj import Obj, Section, read_obj

if TYPE_CHECKING:
    from numpy.typing import NDArray

ENDINGS = (".obj", ".stl", ".ply", ".off", ".gltf", ".glb", ".msh")
"""Mesh files that are read."""

REPEATING = (".stl", ".glb", ".gltf", ".msh")
"""Formats that repeat a vertex for each face or normal: merging them is no repair."""

NO_FACES = "it holds no faces: export it as a closed surface of triangles"


@dataclass(frozen=True, slots=True, eq=False)
class Triangles:
    """What a mesh file holds."""

    name: str
    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    repeats: bool
    """Whether it is usual for its format to repeat vertices."""


def read_triangles(source: str | PathLike[str] | Any) -> Triangles:
    """The triangles of a file, or of a trimesh.Trimesh; all objects of a file as one.

    Raises MeshError for what is no mesh and OSError if the file cannot be opened.
    """
    if not isinstance(source, (str, PathLike)):
        return of_trimesh(source, "mesh", repeats=False)
    path = checked(source)
    if path.suffix.lower() == ".obj":
        obj = read_obj(path)
        return of_sections(path.stem, obj, obj.objects)
    return of_trimesh(load(path), path.stem, path.suffix.lower() in REPEATING)


def checked(source: str | PathLike[str]) -> Path:
    """The path of a mesh file that can be opened."""
    path = Path(fspath(source))
    if path.suffix.lower() not in ENDINGS:
        raise MeshError(f"not a mesh file by its name: known are {', '.join(ENDINGS)}")
    with path.open("rb"):
        pass  # a file that cannot be opened is an OSError, whatever trimesh makes of it
    return path


def of_sections(name: str, obj: Obj, sections: list[Section]) -> Triangles:
    """The triangles of sections of an OBJ file, over the vertices that they use."""
    triangles = [triangle for section in sections for triangle in section.triangles]
    if not triangles:
        raise MeshError(NO_FACES)
    # Relative numbers may point before the first vertex: then all of them stay to be refused.
    numbers = np.array(triangles, dtype=np.int64)
    if numbers.min() < 0 or numbers.max() >= len(obj.vertices):
        return Triangles(name, obj.vertices, numbers, repeats=False)
    used, places = np.unique(numbers, return_inverse=True)
    return Triangles(name, obj.vertices[used], places.reshape(-1, 3), repeats=False)


def load(path: Path, whole: bool = True) -> Any:
    """What trimesh reads: one mesh, or unless it is to be `whole`, perhaps a scene."""
    if path.suffix.lower() == ".msh":
        return read_msh(path)
    with extra("meshes", "mesh files"):
        import trimesh

    reader = trimesh.load_mesh if whole else trimesh.load
    try:
        return reader(path, process=False, skip_materials=True, merge_primitives=True)
    except Exception as error:  # trimesh raises whatever a broken file runs it into
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise MeshError(f"cannot be read as {path.suffix[1:].upper()}: {reason}") from None


def of_trimesh(mesh: Any, name: str, repeats: bool) -> Triangles:
    """The triangles of a trimesh.Trimesh."""
    vertices, faces = getattr(mesh, "vertices", None), getattr(mesh, "faces", None)
    if vertices is None or faces is None or not len(faces):
        raise MeshError(NO_FACES)
    return Triangles(
        name, np.array(vertices, dtype=np.float64), np.array(faces, dtype=np.int64), repeats
    )
