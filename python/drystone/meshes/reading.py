"""Triangles out of mesh files, through trimesh."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.meshes.errors import MeshError

if TYPE_CHECKING:
    from numpy.typing import NDArray

ENDINGS = (".obj", ".stl", ".ply", ".off", ".gltf", ".glb")
"""Mesh files that are read."""

REPEATING = (".stl", ".glb", ".gltf")
"""Formats that repeat a vertex for each face or normal: merging them is no repair."""


@dataclass(frozen=True, slots=True, eq=False)
class Triangles:
    """What a mesh file holds."""

    name: str
    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    repeats: bool
    """Whether it is usual for its format to repeat vertices."""


def read_triangles(source: str | PathLike[str] | Any) -> Triangles:
    """The triangles of a file, or of a trimesh.Trimesh; all meshes of a glTF scene as one.

    Raises MeshError for what is no mesh and OSError if the file cannot be opened.
    """
    if not isinstance(source, (str, PathLike)):
        return _of_trimesh(source, "mesh", repeats=False)
    path = Path(fspath(source))
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        raise MeshError(f"not a mesh file by its name: known are {', '.join(ENDINGS)}")
    with path.open("rb"):
        pass  # a file that cannot be opened is an OSError, whatever trimesh makes of it
    return _of_trimesh(_load(path), path.stem, ending in REPEATING)


def _load(path: Path) -> Any:
    import trimesh

    try:
        return trimesh.load_mesh(path, process=False, skip_materials=True)
    except Exception as error:  # trimesh raises whatever a broken file runs it into
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise MeshError(f"cannot be read as {path.suffix[1:].upper()}: {reason}") from None


def _of_trimesh(mesh: Any, name: str, repeats: bool) -> Triangles:
    vertices, faces = getattr(mesh, "vertices", None), getattr(mesh, "faces", None)
    if vertices is None or faces is None or not len(faces):
        raise MeshError("it holds no faces: export it as a closed surface of triangles")
    return Triangles(
        name, np.array(vertices, dtype=np.float64), np.array(faces, dtype=np.int64), repeats
    )
