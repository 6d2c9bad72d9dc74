"""MJCF, the scene descriptions of MuJoCo: bodies made of boxes and meshes, and planes.

A body without joints is part of its parent, and fixed if that is the world. Meshes are convex
hulls, as MuJoCo collides them. The defaults are those of MuJoCo's XML reference.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from drystone.imports.collected import Collected, FormatError
from drystone.imports.markup import values
from drystone.imports.pose import Pose, box_corners, from_axis_angle, from_euler, from_quaternion
from drystone.meshes import MeshError, read_part
from drystone.meshes.hull import hull_corners, hull_volume

if TYPE_CHECKING:
    from numpy.typing import NDArray

ONLY = "only bodies made of boxes, meshes and planes are taken"

READ = {
    "worldbody",
    "asset",
    "compiler",
    "option",
    "default",
    "size",
    "visual",
    "statistic",
    "custom",
}
"""Sections that are read, or say nothing about the mechanics."""

SILENT = {"light", "camera", "site", "joint", "freejoint", "inertial"}
"""What a body may have besides geoms and bodies: nothing to see here, or read elsewhere."""


@dataclass(slots=True, eq=False)
class _Body:
    """What is rigidly joined together."""

    name: str
    fixed: bool
    pieces: list[NDArray[np.float64]] = field(default_factory=list)
    masses: list[float] = field(default_factory=list)
    frictions: list[float] = field(default_factory=list)


def read(root: ET.Element, path: Path, collected: Collected) -> None:
    """Add the bodies and planes of a model."""
    _Model(root, path, collected).read()


class _Model:
    def __init__(self, root: ET.Element, path: Path, collected: Collected) -> None:
        self.root, self.path, self.collected = root, path, collected
        compiler = _joined(root, "compiler")
        self.degrees = compiler.get("angle", "degree") == "degree"
        self.euler = compiler.get("eulerseq", "xyz")
        self.mesh_folder = path.parent / compiler.get("meshdir", compiler.get("assetdir", ""))
        self.classes: dict[str, dict[str, dict[str, str]]] = {"main": {}}
        for default in root.findall("default"):
            self._read_class(default, default.get("class", "main"), {})
        self.meshes = self._meshes()
        self.unnamed = Counter[str]()

    def read(self) -> None:
        gravity = _joined(self.root, "option").get("gravity")
        x, y, z = values(gravity, 3, "option gravity") if gravity else (0.0, 0.0, -9.81)
        self.collected.gravity = (x, y, z)
        for tag, count in Counter(
            child.tag for child in self.root if child.tag not in READ
        ).items():
            if tag == "include":
                raise FormatError("it includes other files: write it as one file first")
            inside = sum(len(section) for section in self.root.findall(tag)) or count
            self.collected.leave_out(f"{tag} ({inside})", ONLY)
        for world in self.root.findall("worldbody"):
            self._children(world, Pose.identity(), None, "main")
        if self.collected.bodies:
            self.collected.messages.append(
                "friction: the smaller coefficient of two bodies counts, in MuJoCo the larger"
            )

    def _children(self, parent: ET.Element, pose: Pose, body: _Body | None, inherited: str) -> None:
        """The geoms and bodies of an element; `body` is what it belongs to, None for the world."""
        for child in parent:
            if child.tag == "frame":
                inner = child.get("childclass", inherited)
                self._children(child, pose.then(self._pose(child.attrib)), body, inner)
            elif child.tag == "geom":
                self._geom(child, pose, body, inherited)
            elif child.tag == "body":
                self._body(child, pose, body, inherited)
            elif child.tag not in SILENT:
                where = "the world" if body is None else body.name
                self.collected.leave_out(f"{child.tag} in {where}", ONLY)

    def _body(self, element: ET.Element, pose: Pose, parent: _Body | None, inherited: str) -> None:
        inherited = element.get("childclass", inherited)
        name = element.get("name") or self._number("body")
        here = pose.then(self._pose(element.attrib))
        joints = [c for c in element if c.tag in ("joint", "freejoint")]
        if not joints and parent is not None:
            self._children(element, here, parent, inherited)
            return
        for joint in joints:
            if joint.tag == "joint" and joint.get("type", "hinge") != "free":
                kind = joint.get("type", "hinge")
                self.collected.leave_out(f"{kind} joint of {name}", "the body is taken as free")
        body = _Body(name, fixed=not joints)
        self._children(element, here, body, inherited)
        if element.find("inertial") is not None:
            self.collected.leave_out(
                f"inertial of {name}", "mass and inertia are those of its geoms"
            )
        self._finish(body)

    def _geom(self, element: ET.Element, pose: Pose, body: _Body | None, inherited: str) -> None:
        geom = {**self._defaults("geom", element.get("class", inherited)), **element.attrib}
        name = geom.get("name") or self._number("geom" if body is None else f"geom of {body.name}")
        kind = geom.get("type", "sphere")
        if geom.get("contype") == "0" and geom.get("conaffinity") == "0":
            self.collected.leave_out(f"{kind} {name}", "it collides with nothing")
            return
        here = pose.then(self._pose(geom))
        friction = (
            values(geom["friction"], None, f"{name}: friction")[0] if geom.get("friction") else 1.0
        )
        if kind == "plane" and (body is None or body.fixed):
            self.collected.add_plane(name, here, friction)
            return
        piece = self._piece(kind, name, geom)
        if piece is None:
            return
        owner = body or _Body(name, fixed=True)
        owner.pieces.append(here.apply(piece))
        owner.masses.append(_mass(geom, name, hull_volume(piece)))
        owner.frictions.append(friction)
        if body is None:
            self._finish(owner)

    def _piece(self, kind: str, name: str, geom: dict[str, str]) -> NDArray[np.float64] | None:
        if "fromto" in geom or kind not in ("box", "mesh"):
            why = ONLY
            self.collected.leave_out(
                f"{kind} {name}", "given by fromto" if "fromto" in geom else why
            )
            return None
        if kind == "box":
            half = values(geom.get("size"), 3, f"{name}: size")
            if min(half) <= 0:
                raise FormatError(f"{name}: size must be positive, not {geom.get('size')!r}")
            return box_corners(half)
        mesh = self.meshes.get(geom.get("mesh", ""))
        if mesh is None:
            raise FormatError(f"{name}: no mesh is called {geom.get('mesh')!r}")
        return self._mesh(mesh)

    def _mesh(self, mesh: dict[str, str]) -> NDArray[np.float64]:
        x, y, z = values(mesh.get("scale", "1 1 1"), 3, "mesh scale")
        if "vertex" in mesh:
            points = np.array(values(mesh["vertex"], None, "mesh vertex"))
            if points.size % 3 or hull_volume(points.reshape(-1, 3)) <= 0:
                raise MeshError("vertices of a mesh enclose no volume")
            return hull_corners(points.reshape(-1, 3) * [x, y, z])
        if "file" not in mesh:
            raise FormatError("a mesh needs a file or vertices")
        return read_part(self.mesh_folder / mesh["file"], scale=(x, y, z), hull=True).pieces[0]

    def _meshes(self) -> dict[str, dict[str, str]]:
        found = {}
        for asset in self.root.findall("asset"):
            for element in asset.findall("mesh"):
                mesh = {**self._defaults("mesh", element.get("class", "main")), **element.attrib}
                found[mesh.get("name") or Path(mesh.get("file", "")).stem] = mesh
        return found

    def _finish(self, body: _Body) -> None:
        if not body.pieces:
            self.collected.leave_out(f"body {body.name}", "it has no box and no mesh that collides")
            return
        volumes = [hull_volume(piece) for piece in body.pieces]
        densities = [mass / volume for mass, volume in zip(body.masses, volumes, strict=True)]
        if max(densities) > (1 + 1e-9) * min(densities) and not body.fixed:
            self.collected.messages.append(
                f"{body.name}: geoms of different densities: its mass is kept, but spread evenly"
            )
        if max(body.frictions) > min(body.frictions):
            self.collected.messages.append(
                f"{body.name}: geoms of different friction: the smallest is taken"
            )
        self.collected.add(
            body.name,
            body.pieces,
            density=sum(body.masses) / sum(volumes),
            friction=min(body.frictions),
            fixed=body.fixed,
        )

    def _pose(self, attributes: dict[str, str]) -> Pose:
        position = values(attributes.get("pos", "0 0 0"), 3, "pos")
        return Pose(np.array(position), self._rotation(attributes))

    def _rotation(self, attributes: dict[str, str]) -> NDArray[np.float64]:
        unit = math.pi / 180 if self.degrees else 1.0
        try:
            if "quat" in attributes:
                return from_quaternion(values(attributes["quat"], 4, "quat"))
            if "euler" in attributes:
                angles = [unit * x for x in values(attributes["euler"], 3, "euler")]
                # MuJoCo writes axes that turn along in lower case, SciPy in upper case.
                return from_euler(self.euler.swapcase(), angles)
            if "axisangle" in attributes:
                *axis, angle = values(attributes["axisangle"], 4, "axisangle")
                return from_axis_angle(axis, unit * angle)
            if "xyaxes" in attributes:
                six = np.array(values(attributes["xyaxes"], 6, "xyaxes"))
                return _from_axes(six[:3], six[3:])
            if "zaxis" in attributes:
                return _shortest_turn(np.array(values(attributes["zaxis"], 3, "zaxis")))
        except (ValueError, FloatingPointError) as error:
            raise FormatError(f"orientation {attributes}: {error}") from None
        return np.eye(3)

    def _read_class(self, element: ET.Element, name: str, outer: dict[str, dict[str, str]]) -> None:
        own = {tag: dict(attributes) for tag, attributes in outer.items()}
        for child in element:
            if child.tag != "default":
                own.setdefault(child.tag, {}).update(child.attrib)
        self.classes[name] = own
        for child in element.findall("default"):
            self._read_class(child, child.get("class", ""), own)

    def _defaults(self, tag: str, name: str) -> dict[str, str]:
        if name not in self.classes:
            raise FormatError(f"no default class is called {name!r}")
        return self.classes[name].get(tag, {})

    def _number(self, kind: str) -> str:
        self.unnamed[kind] += 1
        return f"{kind} {self.unnamed[kind]}"


def _joined(root: ET.Element, tag: str) -> dict[str, str]:
    """The attributes of all sections of one kind."""
    return {key: value for section in root.findall(tag) for key, value in section.attrib.items()}


def _mass(geom: dict[str, str], name: str, volume: float) -> float:
    if "mass" in geom:
        mass = values(geom["mass"], 1, f"{name}: mass")[0]
    else:
        mass = volume * values(geom.get("density", "1000"), 1, f"{name}: density")[0]
    if mass <= 0:
        raise FormatError(f"{name}: its mass must be positive, not {mass:g}")
    return mass


def _from_axes(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    x = x / np.linalg.norm(x)
    y = y - (y @ x) * x
    y = y / np.linalg.norm(y)
    rotation = np.stack([x, y, np.cross(x, y)], axis=1)
    if not np.isfinite(rotation).all():
        raise ValueError("its axes are parallel or zero")
    return rotation


def _shortest_turn(z: NDArray[np.float64]) -> NDArray[np.float64]:
    """The smallest rotation that takes the z axis there."""
    if not z.any():
        raise ValueError("its axis is zero")
    direction = z / np.linalg.norm(z)
    axis = np.cross([0.0, 0.0, 1.0], direction)
    angle = math.atan2(float(np.linalg.norm(axis)), float(direction[2]))
    return from_axis_angle(axis.tolist() if axis.any() else [1.0, 0.0, 0.0], angle)
