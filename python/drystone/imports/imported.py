"""`load`: assemblies that other tools wrote, as scenes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np

from drystone._core import DrystoneError, SceneError
from drystone.common.choices import Joints, Split, Up
from drystone.common.numbers import Floats, names_of, number, optional_number, optional_whole
from drystone.common.text import counted
from drystone.imports import compas, compas_data, folder, mesh, mjcf, urdf
from drystone.imports.collected import Collected, FormatError, ImportedBody, LeftOut
from drystone.imports.compas_kind import is_assembly
from drystone.imports.fields import read_json
from drystone.imports.foreign import UNREAD, unread
from drystone.imports.markup import read_xml
from drystone.imports.pose import UP
from drystone.imports.rigid import JOINTS
from drystone.imports.shells import convex_shells, scaled
from drystone.meshes import MeshError, Part
from drystone.meshes.part import part_from
from drystone.meshes.reading import ENDINGS, read_triangles

if TYPE_CHECKING:
    from drystone.scene import Scene


FRICTION = 0.5
"""Coefficient of bodies without their own."""

TOUCHING = 1e-6
"""Bodies touch within this share of the diagonal of all of them, unless said otherwise: ten times
the rounding of single precision, in which many tools keep coordinates."""


TWICE = "would count twice"
"""What the core says of pieces that overlap."""

INEXACT = 1.5
"""Bodies touch within so many times what vertices may be off: three last places. Rounding moves two
faces by one and three quarters at most, and planes fitted to their corners by little more."""

COARSEST = 0.05
"""`tolerance="auto"` takes no overlap for inexactness that is more than this share of the shortest
side of the box around either body."""

MARGIN = 1.01
"""The tolerance is this many times the deepest overlap."""

TRIES = 5
"""Scenes made in search of it: with more tolerance what overlaps is a little deeper at most."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Imported:
    """A scene out of another tool's file, and what became of everything in the file."""

    format: str
    """"COMPAS assembly", "COMPAS model", "COMPAS mesh", "folder of parts", "manifest", "mesh",
    "mesh of objects", "MJCF" or "URDF"."""
    scene: Scene
    bodies: list[ImportedBody]
    left_out: list[LeftOut]
    messages: list[str]
    """What was repaired, or taken in another way than it was written."""

    def __repr__(self) -> str:
        told = f"{self.format}, {counted(len(self.bodies), 'body', 'bodies')}"
        told += f", {len(self.left_out)} left out, {counted(len(self.messages), 'message')}"
        return f"<Imported: {told}>"

    def to_dict(self) -> dict[str, Any]:
        """What `drystone import --json` prints."""
        return {
            "format": self.format,
            "bodies": [
                {
                    "name": body.name,
                    "pieces": len(body.pieces) if body.triangles is None else 0,
                    "triangles": 0 if body.triangles is None else len(body.triangles),
                    "volume": body.volume,
                    "density": body.density,
                    "mass": body.mass,
                    "friction": body.friction,
                    "fixed": body.fixed,
                }
                for body in self.bodies
            ],
            "left_out": [{"what": out.what, "why": out.why} for out in self.left_out],
            "messages": self.messages,
        }


def load(
    path: str | PathLike[str] | object,
    *,
    scale: float | None = None,
    up: Up = "z",
    friction: float | Mapping[str, float] = FRICTION,
    density: float | Mapping[str, float] | None = None,
    gravity: Floats | None = None,
    fixed: Iterable[str] = (),
    ground: bool = False,
    tolerance: float | Literal["auto"] | None = None,
    max_pieces: int | None = None,
    simplify: float | None = None,
    split: Split | None = None,
    hull: bool = False,
    joints: Joints = "error",
    surface: bool | None = None,
) -> Imported:
    """A scene from a file of another tool.

    `path` is a COMPAS assembly, a folder of part meshes, a manifest, a mesh file, MJCF or URDF; or
    a COMPAS object itself: an assembly, a model or a mesh. What cannot be taken is left out and
    reported, in `Imported.left_out` and `Imported.messages`.

    What the file does not say, or what you want otherwise:

    - `scale` makes metres of the file's lengths; by default it is the unit that a 3MF or STEP file
      states, else 1. `up` is the axis ("y" or "z") that points up in it.
    - `friction` is the coefficient of bodies without their own. `density` (kg/m^3) is that of all
      bodies, whatever the file says (1000 if neither says anything). Either may be a dict by names
      of bodies, for these alone. `gravity` is in m/s^2, with z up.
    - Bodies named in `fixed` never move. `ground=True` lays a fixed box under all.
    - `tolerance` (metres) is the scene's `contact_tolerance`: how far apart bodies may be and still
      touch, and how deep they may overlap. By default 1e-6 of the diagonal of all bodies, or three
      last decimal places where the faces of meshes show that their numbers are rounded. "auto"
      takes more if bodies overlap by more: the least that will do, which is reported.

    How meshes are taken:

    - A file of several objects (`o` of OBJ, nodes of glTF) becomes a body for each, called like the
      object; so do the groups (`g`) of an OBJ file without objects. `split="groups"` makes a body
      of each group, `split="none"` one of all.
    - `surface`, `max_pieces`, `simplify` and `hull` are as in `Scene.add_mesh`. Meshes of MJCF are
      always taken as their hulls, as MuJoCo does.

    How models of robots are taken: masses, centres of mass and inertias are those of the file.
    A body that hangs on a joint which turns or slides is an error; `joints="fixed"` welds it where
    it is. A body that cannot be taken is left out.

    Raises FormatError or MeshError, naming the file and the fix, SceneError for bodies that do not
    make a scene (two of them overlap), and OSError for a file that cannot be read.
    """
    live = compas_data.is_live(path)
    if path == "":
        raise FormatError("the file's name is empty")
    source: Any = path if live else Path(fspath(cast("str | PathLike[str]", path)))
    if up not in UP:
        raise FormatError(f"up must be 'y' or 'z', not {up!r}")
    fixed = names_of(fixed, "fixed") or ()
    own_units = scale is None
    scale = 1.0 if scale is None else number(scale, "scale", error=FormatError)
    if not 0 < scale < float("inf"):
        raise FormatError(f"scale must be a positive number, not {scale!r}")
    if joints not in JOINTS:
        raise FormatError(f"joints must be 'error' or 'fixed', not {joints!r}")
    if isinstance(tolerance, str) and tolerance != "auto":
        raise FormatError(f"tolerance must be a length in metres or 'auto', not {tolerance!r}")
    # Two bodies touch within it if the surface of each is off by half of it.
    given = None if tolerance == "auto" else optional_number(tolerance, "tolerance", FormatError)
    max_pieces = optional_whole(max_pieces, "max_pieces")
    simplify = optional_number(simplify, "simplify", FormatError)
    if not isinstance(density, Mapping):
        density = optional_number(density, "density")
    collected = Collected(mesh_tolerance=None if given is None else given / 2 / scale)
    try:
        simplify = None if simplify is None else simplify / scale
        taking = Taking(max_pieces, simplify, hull, joints, density is None, surface, own_units)
        if live:
            kind = _read_data(compas_data.data_of(source), source, collected, taking)
        else:
            kind = _read(source, collected, taking, split)
        collected.measure()
        collected.lay_planes()
        collected.transform(scale, UP[up])
    except (FormatError, MeshError) as error:
        if live or str(error).startswith(str(source)):
            raise
        raise type(error)(f"{source}: {error}") from None
    except (OSError, MemoryError, DrystoneError):
        raise
    except Exception as error:  # files are broken in ways that no reader foresees
        if live:
            raise
        reason = f"{type(error).__name__}: {' '.join(str(error).split()):.200}"
        raise FormatError(f"{source}: cannot be read ({reason})") from None
    if not collected.bodies:
        where = "" if live else f"{source}: "
        raise FormatError(f"{where}nothing in it can be taken{_reasons(collected)}")
    if ground:
        collected.lay_ground()
    collected.fix(fixed)
    if isinstance(density, Mapping):
        collected.set_densities(density)
    elif density is not None:
        collected.set_densities({body.name: density for body in collected.bodies})
    if isinstance(friction, Mapping):
        collected.set_frictions(friction)
        friction = FRICTION
    touching = _touching(collected) if given is None else given
    may_lack = kind in ("MJCF", "URDF")
    if tolerance == "auto":
        scene = _without_overlaps(collected, friction, gravity, touching, may_lack)
    else:
        scene = _scene(collected, friction, gravity, touching, may_lack)
    if collected.lacking:
        count = len(collected.lacking)
        collected.messages.append(
            f"the scene lacks {count} of the file's bodies: {', '.join(collected.lacking[:10])}"
        )
    return Imported(kind, scene, collected.bodies, collected.left_out, collected.grouped())


@dataclass(frozen=True, slots=True)
class Taking:
    """How bodies of a file are taken."""

    max_pieces: int | None
    simplify: float | None
    """In the file's unit of length."""
    hull: bool
    joints: str
    massless_are_fixed: bool
    surface: bool | None
    own_units: bool
    """Whether lengths of mesh files are in the units that these state."""

    def for_files(self) -> dict[str, Any]:
        """The arguments of those who read files of meshes, which may state a unit."""
        return {**self.for_meshes(), "scale": None if self.own_units else 1.0}

    def for_meshes(self) -> dict[str, Any]:
        """The arguments of those who read meshes."""
        return {
            "max_pieces": self.max_pieces,
            "simplify": self.simplify,
            "hull": self.hull,
            "surface": self.surface,
        }


def _read(path: Path, collected: Collected, taking: Taking, split: str | None) -> str:
    """Fill `collected` and return the name of the format; FileNotFoundError for no file."""
    path.stat()
    ending = path.suffix.lower()
    if ending in ENDINGS and not path.is_dir():
        return mesh.read(path, collected, split=split, **taking.for_files())
    if split is not None:
        raise FormatError(f"{path}: split is for one mesh file")
    if path.is_dir():
        folder.read(path, collected, **taking.for_files())
        return "folder of parts"
    if ending == ".json":
        return _read_json(path, collected, taking)
    if ending in (".xml", ".mjcf", ".urdf"):
        return _read_xml(path, collected, taking)
    if ending in UNREAD:
        raise FormatError(f"{path}: {unread(path)}")
    known = ", ".join((".json", ".xml", ".urdf", *ENDINGS))
    raise FormatError(f"{path}: not known by its name: a folder, or one of {known}")


def _read_json(path: Path, collected: Collected, taking: Taking) -> str:
    return _read_data(read_json(path), path, collected, taking)


def _read_data(data: Any, path: Any, collected: Collected, taking: Taking) -> str:
    if is_assembly(data):
        return compas.read(data, collected, **taking.for_meshes())
    if isinstance(data, dict) and "parts" in data:
        folder.read_manifest(Path(path), collected, **taking.for_files())
        return "manifest"
    if isinstance(data, dict) and "bodies" in data:
        raise FormatError(f"{path}: a scene of drystone already: use it as it is")
    raise FormatError(f"{path}: neither a COMPAS assembly nor a manifest of parts")


def _read_xml(path: Path, collected: Collected, taking: Taking) -> str:
    root = read_xml(path)
    if root.tag == "mujoco":
        mjcf.read(root, path, collected, taking.simplify, taking.joints)
        return "MJCF"
    if root.tag == "robot":

        def read_mesh(file: Path, scale: tuple[float, float, float]) -> Part:
            read = read_triangles(file)
            shells = None if taking.hull else convex_shells(scaled(read, scale))
            if shells is not None:
                said = f"{file.name}: {len(shells)} nearly convex shells, each taken as its hull"
                return Part(read.name, shells, 0.0, [said])
            options = {**taking.for_meshes(), "tolerance": collected.mesh_tolerance}
            try:
                # A body has several of them, which may overlap.
                return part_from(read, scale, **{**options, "surface": False})
            except MeshError as error:
                raise MeshError(f"{file}: {error}") from None

        urdf.read(root, path, collected, read_mesh, taking.joints, taking.massless_are_fixed)
        return "URDF"
    raise FormatError(f"{path}: <{root.tag}> is neither <mujoco> nor <robot>")


def _scene(
    collected: Collected,
    friction: float,
    gravity: Floats | None,
    tolerance: float,
    may_lack: bool,
) -> Scene:
    """The scene of all bodies; one that cannot be taken is an error, unless it `may_lack` it."""
    from drystone.scene import Scene

    if gravity is None:
        gravity = collected.gravity or (0.0, 0.0, -9.81)
    scene = Scene(3, gravity, friction, contact_tolerance=tolerance)
    for body in list(collected.bodies):
        try:
            _add(scene, body, None if body.weight is None else body.weight.mass)
        except SceneError as error:
            if may_lack:
                collected.lack(f"body {body.name}", str(error))
                collected.bodies.remove(body)
                continue
            if not (body.weight is None and TWICE in str(error)):
                raise
            # Pieces of a mesh were found to fill its volume: they overlap by rounding only.
            _add(scene, body, body.mass)
            collected.messages.append(
                f"{body.name}: its convex pieces overlap by rounding; its mass is that of the mesh"
            )
    return scene


def _without_overlaps(
    collected: Collected,
    friction: float,
    gravity: Floats | None,
    tolerance: float,
    may_lack: bool,
) -> Scene:
    """The scene with the least tolerance at which nothing overlaps, if that is no more than
    inexactness explains; else with `tolerance` (metres), which is tried first."""
    scene = first = _scene(collected, friction, gravity, tolerance, may_lack)
    sides = {body.name: _shortest_side(body) for body in collected.bodies}
    for _ in range(TRIES):
        overlaps = scene.overlaps
        if not overlaps:
            break
        deepest = max(overlaps, key=lambda overlap: overlap.depth)
        if deepest.depth > COARSEST * min(sides[deepest.a], sides[deepest.b]):
            return first
        tolerance = MARGIN * deepest.depth
        scene = _scene(collected, friction, gravity, tolerance, may_lack)
    if scene.overlaps:
        return first
    if scene is not first:
        collected.messages.append(
            f"bodies overlap by up to {tolerance / MARGIN:.2g} m, which is taken for inexact "
            f"numbers: bodies touch that are up to {tolerance:.2g} m apart or overlap by that"
        )
    return scene


def _shortest_side(body: ImportedBody) -> float:
    points = np.concatenate(body.pieces)
    return float(np.ptp(points, axis=0).min())


def _add(scene: Scene, body: ImportedBody, mass: float | None) -> None:
    weight = body.weight
    options: dict[str, Any] = {
        "name": body.name,
        "density": body.density * body.density_factor,
        "friction": body.friction,
        "fixed": body.fixed,
        "mass": mass,
        "center_of_mass": None if weight is None else weight.center.tolist(),
        "inertia": None if weight is None else weight.inertia,
    }
    if body.triangles is None:
        scene.add_solid(body.pieces, **options)
    else:
        scene.add_surface(body.pieces[0], body.triangles, **options)


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
