"""`load`: assemblies that other tools wrote, as scenes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drystone.imports import compas, folder, mesh, mjcf, urdf
from drystone.imports.collected import Collected, FormatError, ImportedBody, LeftOut
from drystone.imports.fields import read_json
from drystone.imports.markup import read_xml
from drystone.imports.pose import UP
from drystone.meshes import MOST_PIECES, MeshError
from drystone.meshes.reading import ENDINGS

if TYPE_CHECKING:
    from drystone.scene import Scene


FRICTION = 0.5
"""Coefficient of bodies without their own."""

TOUCHING = 1e-6
"""Bodies touch within this share of the diagonal of all of them, unless said otherwise: ten times
the rounding of single precision, in which many tools keep coordinates."""


INEXACT = 1.5
"""Bodies touch within so many times what vertices may be off: three last places. Rounding moves two
faces by one and three quarters at most, and planes fitted to their corners by little more."""


@dataclass(frozen=True, slots=True, eq=False)
class Imported:
    """A scene out of another tool's file, and what became of everything in the file."""

    format: str
    """"COMPAS assembly", "folder of parts", "manifest", "mesh", "mesh of objects", "MJCF" or
    "URDF"."""
    scene: Scene
    bodies: list[ImportedBody]
    left_out: list[LeftOut]
    messages: list[str]
    """What was repaired, or taken otherwise than written."""

    def to_dict(self) -> dict[str, Any]:
        """What `drystone import --json` prints."""
        return {
            "format": self.format,
            "bodies": [
                {
                    "name": body.name,
                    "pieces": len(body.pieces),
                    "volume": body.volume,
                    "density": body.density,
                    "friction": body.friction,
                    "fixed": body.fixed,
                }
                for body in self.bodies
            ],
            "left_out": [{"what": out.what, "why": out.why} for out in self.left_out],
            "messages": self.messages,
        }


def load(
    path: str | PathLike[str],
    *,
    scale: float = 1.0,
    up: str = "z",
    friction: float | Mapping[str, float] = FRICTION,
    density: float | Mapping[str, float] | None = None,
    gravity: Sequence[float] | None = None,
    fixed: Iterable[str] = (),
    ground: bool = False,
    tolerance: float | None = None,
    max_pieces: int = MOST_PIECES,
    simplify: float | None = None,
    split: str | None = None,
) -> Imported:
    """A COMPAS assembly, a folder of part meshes, a manifest, a mesh file, MJCF or URDF as a scene.

    `scale` makes metres of the file's lengths, `up` is the axis ("y" or "z") that points up in
    it. `friction` is for bodies without their own, `density` (kg/m^3) for all bodies, instead of
    what the file says (1000 if it says nothing); `gravity` (m/s^2, z up) likewise. Either of the
    first two may be a dict by names of bodies, for these alone. Bodies named in `fixed` never move;
    `ground` lays a fixed box under all. `tolerance` is the scene's `contact_tolerance`, in metres:
    how far apart bodies of an inexact file may be and still touch, by default 1e-6 of the diagonal
    of all, or three last places of the numbers where faces of meshes show that these are rounded.
    `simplify` (metres) lets the surface of mesh files move by so much, so that scans become few
    pieces: see `Scene.add_mesh`.

    A mesh file of several objects (`o` of OBJ, nodes of glTF) becomes a body for each, called like
    it; so do the groups (`g`) of an OBJ file without objects. `split="groups"` takes each group as
    a body, `split="none"` all as one.

    Raises FormatError or MeshError, naming the file and the fix, SceneError for bodies that do not
    make a scene (two of them overlap), and OSError for a file that cannot be read.
    """
    path = Path(fspath(path))
    if up not in UP:
        raise FormatError(f"up must be 'y' or 'z', not {up!r}")
    if not 0 < scale < float("inf"):
        raise FormatError(f"scale must be a positive number, not {scale!r}")
    # Two bodies touch within it if the surface of each is off by half of it.
    collected = Collected(mesh_tolerance=None if tolerance is None else tolerance / 2 / scale)
    try:
        simplify = None if simplify is None else simplify / scale
        kind = _read(path, collected, max_pieces, simplify, split)
    except (FormatError, MeshError) as error:
        if str(path) in str(error):
            raise
        raise type(error)(f"{path}: {error}") from None
    collected.measure()
    collected.lay_planes()
    collected.transform(scale, UP[up])
    if not collected.bodies:
        raise FormatError(f"{path}: nothing in it can be taken{_reasons(collected)}")
    if ground:
        collected.lay_ground()
    collected.fix(fixed)
    if isinstance(density, Mapping):
        collected.set_densities(density)
        density = None
    if isinstance(friction, Mapping):
        collected.set_frictions(friction)
        friction = FRICTION
    scene = _scene(collected, friction, density, gravity, tolerance)
    return Imported(kind, scene, collected.bodies, collected.left_out, collected.messages)


def _read(
    path: Path, collected: Collected, max_pieces: int, simplify: float | None, split: str | None
) -> str:
    """Fill `collected` and return the name of the format; `simplify` is in the file's unit."""
    ending = path.suffix.lower()
    if ending in ENDINGS and not path.is_dir():
        return mesh.read(path, collected, max_pieces, simplify, split)
    if split is not None:
        raise FormatError(f"{path}: split is for one mesh file")
    if path.is_dir():
        folder.read(path, collected, max_pieces, simplify)
        return "folder of parts"
    if ending == ".json":
        return _read_json(path, collected, max_pieces, simplify)
    if ending in (".xml", ".mjcf", ".urdf"):
        _refuse(simplify, "MJCF and URDF")
        return _read_xml(path, collected, max_pieces)
    known = ", ".join((".json", ".xml", ".urdf", *ENDINGS))
    raise FormatError(f"{path}: not known by its name: a folder, or one of {known}")


def _refuse(simplify: float | None, formats: str) -> None:
    if simplify is not None:
        raise FormatError(f"simplify is for mesh files and folders of them, not for {formats}")


def _read_json(path: Path, collected: Collected, max_pieces: int, simplify: float | None) -> str:
    data = read_json(path)
    if compas.is_assembly(data):
        _refuse(simplify, "COMPAS assemblies")
        compas.read(data, collected, max_pieces)
        return "COMPAS assembly"
    if isinstance(data, dict) and "parts" in data:
        folder.read_manifest(path, collected, max_pieces, simplify)
        return "manifest"
    if isinstance(data, dict) and "bodies" in data:
        raise FormatError(f"{path}: a scene of drystone already: use it as it is")
    raise FormatError(f"{path}: neither a COMPAS assembly nor a manifest of parts")


def _read_xml(path: Path, collected: Collected, max_pieces: int) -> str:
    root = read_xml(path)
    if root.tag == "mujoco":
        mjcf.read(root, path, collected)
        return "MJCF"
    if root.tag == "robot":
        urdf.read(root, path, collected, max_pieces)
        return "URDF"
    raise FormatError(f"{path}: <{root.tag}> is neither <mujoco> nor <robot>")


def _scene(
    collected: Collected,
    friction: float,
    density: float | None,
    gravity: Sequence[float] | None,
    tolerance: float | None,
) -> Scene:
    from drystone.scene import Scene

    if tolerance is None:
        tolerance = _touching(collected)
    if gravity is None:
        gravity = collected.gravity or (0.0, 0.0, -9.81)
    scene = Scene(3, gravity, friction, contact_tolerance=tolerance)
    for body in collected.bodies:
        scene.add_solid(
            body.pieces,
            name=body.name,
            density=(body.density if density is None else density) * body.density_factor,
            friction=body.friction,
            fixed=body.fixed,
        )
    return scene


def _touching(collected: Collected) -> float:
    """How far apart bodies may be and still touch, metres, where the user does not say."""
    exact, rounded = TOUCHING * collected.extent, INEXACT * collected.inexact
    if rounded <= exact:
        return exact
    collected.messages.append(
        f"bodies touch that are up to {rounded:.2g} m apart or overlap by that, as exact as the "
        "numbers are: set tolerance for another bound"
    )
    return rounded


def _reasons(collected: Collected) -> str:
    reasons = [f"{out.what}: {out.why}" for out in collected.left_out[:3]]
    return f" ({'; '.join(reasons)})" if reasons else ""
