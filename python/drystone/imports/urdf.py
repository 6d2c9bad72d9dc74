"""URDF, the robot descriptions of ROS: links whose collision shapes are boxes and meshes.

Links joined by fixed joints are one body; what is fixed to a link called `world` is fixed. Other
joints are left out, and their links stand free where the joints are at zero.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from drystone.imports.collected import Collected, FormatError
from drystone.imports.markup import values
from drystone.imports.pose import Pose, box_corners, from_euler
from drystone.meshes import read_part
from drystone.meshes.hull import hull_volume

if TYPE_CHECKING:
    from numpy.typing import NDArray

WORLD = "world"
"""A link of this name does not move."""


@dataclass(slots=True, eq=False)
class _Body:
    """Links that are rigidly joined together."""

    name: str
    fixed: bool
    pieces: list[NDArray[np.float64]] = field(default_factory=list)
    mass: float = 0.0


def read(root: ET.Element, path: Path, collected: Collected, max_pieces: int) -> None:
    """Add the links of a robot."""
    _Robot(root, path, collected, max_pieces).read()


class _Robot:
    def __init__(self, root: ET.Element, path: Path, collected: Collected, most: int) -> None:
        self.path, self.collected, self.max_pieces = path, collected, most
        self.links = {_name(link): link for link in root.findall("link")}
        self.joints: dict[str, list[tuple[ET.Element, str]]] = {}
        self.children: set[str] = set()
        self.waiting: list[tuple[str, Pose, bool]] = []
        for joint in root.findall("joint"):
            parent, child = self._end(joint, "parent"), self._end(joint, "child")
            if child in self.children:
                raise FormatError(f"link {child!r} is the child of two joints")
            self.joints.setdefault(parent, []).append((joint, child))
            self.children.add(child)
        self.others = Counter(
            child.tag for child in root if child.tag not in ("link", "joint", "material")
        )

    def read(self) -> None:
        if not self.links:
            raise FormatError("it has no links")
        roots = [name for name in self.links if name not in self.children]
        if not roots:
            raise FormatError("its joints run in a circle")
        self.waiting = [(root, Pose.identity(), root == WORLD) for root in roots]
        while self.waiting:
            self._body(*self.waiting.pop(0))
        for tag, count in self.others.items():
            self.collected.leave_out(f"{tag} ({count})", "only links and fixed joints are taken")

    def _body(self, link: str, pose: Pose, fixed: bool) -> None:
        body = _Body(link, fixed)
        self._add_link(link, pose, body)
        if not body.pieces:
            if link != WORLD:
                self.collected.leave_out(f"link {link}", "it has no box and no mesh that collides")
            return
        volume = sum(hull_volume(piece) for piece in body.pieces)
        density = body.mass / volume if body.mass > 0 else None
        if density is not None:
            self.collected.messages.append(
                f"{link}: its mass is kept; centre of mass and inertia are those of its shape"
            )
        self.collected.add(link, body.pieces, density=density, fixed=fixed)

    def _add_link(self, name: str, pose: Pose, body: _Body) -> None:
        link = self.links[name]
        for number, collision in enumerate(link.findall("collision")):
            body.pieces += self._pieces(collision, pose, f"collision {number} of {name}")
        mass = link.find("inertial/mass")
        if mass is not None:
            body.mass += values(mass.get("value"), 1, f"mass of {name}")[0]
        for joint, child in self.joints.get(name, []):
            here = pose.then(self._origin(joint))
            kind = joint.get("type", "")
            if kind == "fixed" and name == WORLD:
                self.waiting.append((child, here, True))
            elif kind == "fixed":
                self._add_link(child, here, body)
            else:
                if kind != "floating":
                    why = f"{child} is taken as free, where the joint is at zero"
                    self.collected.leave_out(f"{kind} joint {joint.get('name')}", why)
                self.waiting.append((child, here, False))

    def _pieces(self, collision: ET.Element, pose: Pose, what: str) -> list[NDArray[np.float64]]:
        here = pose.then(self._origin(collision))
        shape = next(iter(collision.find("geometry") or ()), None)
        if shape is None:
            raise FormatError(f"{what} has no geometry")
        if shape.tag == "box":
            size = values(shape.get("size"), 3, f"{what}: size")
            if min(size) <= 0:
                raise FormatError(f"{what}: size must be positive, not {size}")
            return [here.apply(box_corners([x / 2 for x in size]))]
        if shape.tag == "mesh":
            x, y, z = values(shape.get("scale", "1 1 1"), 3, f"{what}: scale")
            file = self._file(shape.get("filename", ""))
            part = read_part(
                file,
                scale=(x, y, z),
                max_pieces=self.max_pieces,
                tolerance=self.collected.mesh_tolerance,
            )
            self.collected.say(what, part.messages)
            return [here.apply(piece) for piece in part.pieces]
        self.collected.leave_out(f"{shape.tag}, {what}", "only boxes and meshes are taken")
        return []

    def _origin(self, element: ET.Element) -> Pose:
        origin = element.find("origin")
        attributes = {} if origin is None else origin.attrib
        position = values(attributes.get("xyz", "0 0 0"), 3, "origin xyz")
        angles = values(attributes.get("rpy", "0 0 0"), 3, "origin rpy")
        return Pose(np.array(position), from_euler("xyz", angles))

    def _file(self, name: str) -> Path:
        """A mesh's path; `package://name/...` is looked for beside the file and above it."""
        if not name.startswith("package://"):
            return self.path.parent / name.removeprefix("file://")
        inside = name.removeprefix("package://").partition("/")[2]
        folders = [self.path.parent, *self.path.resolve().parents]
        found = next((f / inside for f in folders if (f / inside).exists()), None)
        if found is None:
            raise FormatError(f"{name} is neither beside it nor in a folder above it")
        return found

    def _end(self, joint: ET.Element, tag: str) -> str:
        end = joint.find(tag)
        name = "" if end is None else end.get("link", "")
        if name not in self.links:
            raise FormatError(f"joint {joint.get('name')!r}: no {tag} link {name!r}")
        return name


def _name(link: ET.Element) -> str:
    name = link.get("name")
    if not name:
        raise FormatError("a link has no name")
    return name
