"""Triangles out of mesh files: OBJ by `obj.py`, the rest through trimesh."""

from __future__ import annotations

from dataclasses import dataclass, replace
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.common.extras import extra
from drystone.common.files import EMPTY
from drystone.meshes.errors import MeshError
from drystone.meshes.msh import read_msh
from drystone.meshes.obj import Obj, Section, read_obj

if TYPE_CHECKING:
    from numpy.typing import NDArray

STEP = (".step", ".stp")
"""Files of exact solids, which are read as triangles near them."""

ENDINGS = (".obj", ".stl", ".ply", ".off", ".gltf", ".glb", ".3mf", ".msh", *STEP)
"""Mesh files that are read."""

REPEATING = (".stl", ".glb", ".gltf", ".msh", *STEP)
"""Formats that repeat a vertex for each face or normal: merging them is no repair."""

METRES = {
    "micron": 1e-6,
    "millimeter": 1e-3,
    "centimeter": 1e-2,
    "inch": 0.0254,
    "foot": 0.3048,
    "meter": 1.0,
}
"""Units that a 3MF file may name."""

CHORDS = 0.1
"""Radians between normals of neighbouring triangles that stand for a curved face of a STEP file: a
circle has 64 sides, which are off by 1.2e-3 of its radius."""

SAG = 1e-3
"""Metres that these triangles may be off, at most, whatever the angles."""

NO_FACES = "it holds no faces: export it as a closed surface of triangles"


@dataclass(frozen=True, slots=True, eq=False)
class Triangles:
    """What a mesh file holds."""

    name: str
    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    repeats: bool
    """Whether it is usual for its format to repeat vertices."""
    unit: float | None = None
    """Metres in one of its lengths, if its file says so."""


def read_triangles(source: str | PathLike[str] | Any) -> Triangles:
    """The triangles of a file, or of a trimesh.Trimesh; all objects of a file as one.

    Raises MeshError for what is no mesh and OSError if the file cannot be opened.
    """
    if not isinstance(source, (str, PathLike)):
        if not hasattr(source, "vertices"):
            raise TypeError(
                f"a mesh must be a file's name or a trimesh.Trimesh, not {source!r:.80}"
            )
        return of_trimesh(source, "mesh", repeats=False)
    path = checked(source)
    if path.suffix.lower() == ".obj":
        obj = read_obj(path)
        return of_sections(path.stem, obj, obj.objects)
    mesh = load(path)
    read = of_trimesh(mesh, path.stem, path.suffix.lower() in REPEATING)
    return replace(read, unit=unit_of(path, mesh))


def checked(source: str | PathLike[str]) -> Path:
    """The path of a mesh file that can be opened."""
    path = Path(fspath(source))
    if path.suffix.lower() not in ENDINGS:
        raise MeshError(f"not a mesh file by its name: known are {', '.join(ENDINGS)}")
    with path.open("rb") as file:  # one that cannot be opened is an OSError, not what trimesh says
        if not file.read(1):
            raise MeshError(EMPTY)
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


def unit_of(path: Path, loaded: Any) -> float | None:
    """Metres in one of a file's lengths, where its format has a unit; None where it has none."""
    ending = path.suffix.lower()
    if ending in STEP:
        return 1.0  # into which they were converted
    if ending != ".3mf":
        return None
    name = str(getattr(loaded, "units", None) or "millimeter").lower()
    if name not in METRES:
        raise MeshError(f"its unit {name!r} is none of 3MF: {', '.join(METRES)}")
    return METRES[name]


def _import_readers(ending: str) -> None:
    """What trimesh reads a format with; it would only say so once it has opened the file."""
    if ending in STEP:
        with extra("cad", "STEP files"):
            import cascadio  # noqa: F401
    elif ending == ".3mf":
        with extra("meshes", "3MF files"):
            import lxml  # noqa: F401
            import networkx  # noqa: F401


def load(path: Path, whole: bool = True) -> Any:
    """What trimesh reads: one mesh, or unless it is to be `whole`, perhaps a scene."""
    ending = path.suffix.lower()
    if ending == ".msh":
        return read_msh(path)
    _import_readers(ending)
    with extra("meshes", "mesh files"):
        import trimesh

    reader = trimesh.load_mesh if whole else trimesh.load
    options: dict[str, Any] = {"process": False, "merge_primitives": True}
    if ending in STEP:
        options |= {"tol_linear": SAG, "tol_angular": CHORDS}
    else:
        options["skip_materials"] = True
    try:
        return reader(path, **options)
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
