"""URDF, the robot descriptions of ROS: links whose collision shapes are boxes and meshes.

Links joined by fixed joints are one body; what is fixed to a link called `world` is fixed, and so
is a body without mass. Shapes of one body may overlap, for its mass is given.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from drystone.imports.collected import Collected, FormatError
from drystone.imports.markup import values
from drystone.imports.pose import Pose, box_corners, from_euler
from drystone.imports.rigid import JointError, Rigid, joint_of
from drystone.imports.weight import Weight, of_pieces
from drystone.meshes import MeshError, Part

if TYPE_CHECKING:
    from numpy.typing import NDArray

WORLD = "world"
"""A link of this name does not move."""

ReadMesh = Callable[[Path, tuple[float, float, float]], Part]
"""A mesh file with its scale, as the import is to take meshes."""


def read(
    root: ET.Element,
    path: Path,
    collected: Collected,
    read_mesh: ReadMesh,
    joints: str = "error",
    massless_are_fixed: bool = True,
) -> None:
    """Add the links of a robot. A body that cannot be taken is left out, and said.

    Bodies without mass are fixed, unless they get a density later.
    """
    robot = _Robot(root, path, collected, read_mesh, joints)
    robot.massless_are_fixed = massless_are_fixed
    robot.read()


class _Robot:
    def __init__(
        self,
        root: ET.Element,
        path: Path,
        collected: Collected,
        read_mesh: ReadMesh,
        joints: str,
    ) -> None:
        self.path, self.collected, self.read_mesh, self.welds = path, collected, read_mesh, joints
        self.massless_are_fixed = True
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
        body = Rigid(link, fixed)
        try:
            self._add_link(link, pose, body)
            if not body.pieces and link == WORLD:
                return
            if not fixed and not sum(weight.mass for weight in body.weights):
                self._without_mass(body)
            body.finish(self.collected)
        except JointError:
            raise
        except (FormatError, MeshError) as error:
            self.collected.lack(f"link {link}", str(error))

    def _without_mass(self, body: Rigid) -> None:
        if self.massless_are_fixed or not body.pieces:
            body.fixed = True
            self.collected.messages.append(
                f"{body.name}: it has no mass, and is taken as fixed: density gives it one"
            )
        else:
            body.weights = [of_pieces(body.pieces)]

    def _add_link(self, name: str, pose: Pose, body: Rigid) -> None:
        link = self.links[name]
        pieces: list[NDArray[np.float64]] = []
        for number, collision in enumerate(link.findall("collision")):
            pieces += self._pieces(collision, pose, f"collision {number} of {name}", body)
        body.pieces += pieces
        self._add_friction(link, name, body)
        weight = self._weight(link, pose, name, pieces)
        if weight is not None:
            body.weights.append(weight)
        for joint, child in self.joints.get(name, []):
            self._follow(joint, child, name, pose, body)

    def _follow(self, joint: ET.Element, child: str, name: str, pose: Pose, body: Rigid) -> None:
        here = pose.then(self._origin(joint))
        kind = joint.get("type", "")
        if kind == "floating":
            self.waiting.append((child, here, False))
            return
        if kind != "fixed":
            joint_of(child, kind, self.welds, self.collected, name)
        if name == WORLD:
            self.waiting.append((child, here, True))
        else:
            self._add_link(child, here, body)

    def _weight(
        self, link: ET.Element, pose: Pose, name: str, pieces: list[NDArray[np.float64]]
    ) -> Weight | None:
        """What <inertial> says, in the world; without an inertia the shape's, of its mass."""
        inertial = link.find("inertial")
        given = None if inertial is None else inertial.find("mass")
        if inertial is None or given is None:
            return None
        mass = values(given.get("value"), 1, f"mass of {name}")[0]
        if mass < 0:
            raise FormatError(f"mass of {name} must not be negative, not {mass:g}")
        tensor = inertial.find("inertia")
        here = pose.then(self._origin(inertial))
        if tensor is not None:
            xx, yy, zz, xy, xz, yz = (
                values(tensor.get(key, "0"), 1, f"inertia of {name}: {key}")[0]
                for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
            )
            own = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
            return Weight(mass, np.zeros(3), own).placed(here)
        filled = of_pieces(pieces)
        share = mass / filled.mass if filled.mass > 0 else 0.0
        return Weight(mass, here.position, share * filled.inertia)

    def _add_friction(self, link: ET.Element, name: str, body: Rigid) -> None:
        """Bullet's coefficient, which it multiplies with the other body's."""
        lateral = link.find("contact/lateral_friction")
        if lateral is None:
            return
        friction = values(lateral.get("value"), 1, f"lateral_friction of {name}")[0]
        body.frictions.append(friction)
        self.collected.messages.append(
            f"{name}: friction {friction:g}: of two bodies the smaller counts, not the product"
        )

    def _pieces(
        self, collision: ET.Element, pose: Pose, what: str, body: Rigid
    ) -> list[NDArray[np.float64]]:
        here = pose.then(self._origin(collision))
        geometry = collision.find("geometry")
        shape = None if geometry is None else next(iter(geometry), None)
        if shape is None:
            raise FormatError(f"{what} has no geometry")
        if shape.tag == "box":
            size = values(shape.get("size"), 3, f"{what}: size")
            if min(size) <= 0:
                raise FormatError(f"{what}: size must be positive, not {size}")
            return [here.apply(box_corners([x / 2 for x in size]))]
        if shape.tag == "mesh":
            scale = values(shape.get("scale", "1 1 1"), None, f"{what}: scale")
            x, y, z = scale * 3 if len(scale) == 1 else values(shape.get("scale", "1 1 1"), 3, what)
            try:
                part = self.read_mesh(self._file(shape.get("filename", "")), (x, y, z))
            except OSError as error:
                raise FormatError(f"{what}: {error.filename}: {error.strerror}") from None
            self.collected.say(what, part.messages)
            body.tolerance = max(body.tolerance, part.tolerance)
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
        """A mesh's path, looked for beside the file and in the folders above it: tools see names
        from a folder of their own, and `package://name/...` from a package's."""
        scheme, found, rest = name.partition("://")
        insides = [rest.partition("/")[2], rest] if found and scheme != "file" else [rest or name]
        folders = [self.path.parent, *self.path.resolve().parents]
        places = (folder / inside for folder in folders for inside in insides if inside)
        file = next((place for place in places if place.exists()), None)
        if file is None:
            raise FormatError(f"{name} is neither beside it nor in a folder above it")
        return file

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
