"""MJCF, the scene descriptions of MuJoCo: bodies made of boxes and meshes, and planes.

A body without joints is part of its parent, and fixed if that is the world. Meshes are convex
hulls, as MuJoCo collides them; geoms of one body may overlap, and masses add up as they are given.
The defaults are those of MuJoCo's XML reference.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np

from drystone.imports.collected import Collected, FormatError
from drystone.imports.markup import values
from drystone.imports.mjcf_assets import Defaults, Meshes, given_inertial, mesh_folders, uniform
from drystone.imports.mjcf_files import included
from drystone.imports.mjcf_frames import Frames, between
from drystone.imports.pose import Pose, box_corners
from drystone.imports.rigid import JointError, Rigid, joint_of
from drystone.imports.weight import (
    Weight,
    of_capsule,
    of_cylinder,
    of_ellipsoid,
    of_pieces,
    together,
)
from drystone.meshes import MeshError

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


def read(
    root: ET.Element,
    path: Path,
    collected: Collected,
    simplify: float | None = None,
    joints: str = "error",
) -> None:
    """Add the bodies and planes of a model. A body that cannot be taken is left out, and said."""
    _Model(included(root, path), path, collected, simplify, joints).read()


class _Model:
    def __init__(
        self,
        root: ET.Element,
        path: Path,
        collected: Collected,
        simplify: float | None,
        joints: str,
    ) -> None:
        self.root, self.collected, self.joints = root, collected, joints
        self.compiler = _joined(root, "compiler")
        self.frames = Frames.of(self.compiler)
        self.defaults = Defaults(root)
        folders = mesh_folders(path, self.compiler)
        self.meshes = Meshes(root, folders, self.defaults, self.frames, simplify)
        self.unnamed = Counter[str]()

    def read(self) -> None:
        gravity = _joined(self.root, "option").get("gravity")
        x, y, z = values(gravity, 3, "option gravity") if gravity else (0.0, 0.0, -9.81)
        self.collected.gravity = (x, y, z)
        for tag, count in Counter(
            child.tag for child in self.root if child.tag not in READ
        ).items():
            inside = sum(len(section) for section in self.root.findall(tag)) or count
            self.collected.leave_out(f"{tag} ({inside})", ONLY)
        if "settotalmass" in self.compiler:
            self.collected.leave_out("settotalmass", "masses are taken as they are given")
        for world in self.root.findall("worldbody"):
            self._children(world, Pose.identity(), None, "main", "")
        if self.collected.bodies:
            self.collected.messages.append(
                "friction: the smaller coefficient of two bodies counts, in MuJoCo the larger"
            )

    def _children(
        self, parent: ET.Element, pose: Pose, body: Rigid | None, inherited: str, suffix: str
    ) -> list[Weight]:
        """What is in an element; `body` is what it belongs to, None for the world. Returns what the
        geoms weigh."""
        weights = []
        for child in parent:
            if child.tag == "geom":
                weights += self._geom_of(child, pose, body, inherited, suffix)
            elif child.tag == "body":
                self._body(child, pose, body, inherited, suffix)
            elif child.tag == "frame":
                here = pose.then(self.frames.pose(child.attrib))
                own = child.get("childclass", inherited)
                weights += self._children(child, here, body, own, suffix)
            elif child.tag == "replicate":
                for number, here in self._copies(child, pose):
                    weights += self._children(child, here, body, inherited, suffix + number)
            elif child.tag not in SILENT:
                where = "the world" if body is None else body.name
                self.collected.leave_out(f"{child.tag} in {where}", ONLY)
        return weights

    def _copies(self, element: ET.Element, pose: Pose) -> list[tuple[str, Pose]]:
        """The ending of names, and the frame, of every copy that <replicate> makes."""
        count = int(values(element.get("count"), 1, "replicate count")[0])
        if not 0 < count <= MOST_COPIES:
            raise FormatError(f"replicate count is {count}: give 1 to {MOST_COPIES}")
        step = self.frames.pose(element.attrib, "offset")
        copies, here = [], pose
        for number in range(count):
            digits = str(number).zfill(len(str(count - 1)))
            copies.append((element.get("sep", "") + digits, here))
            here = here.then(step)
        return copies

    def _body(
        self, element: ET.Element, pose: Pose, parent: Rigid | None, inherited: str, suffix: str
    ) -> None:
        inherited = element.get("childclass", inherited)
        own = element.get("name")
        name = own + suffix if own else self._number("body")
        here = pose.then(self.frames.pose(element.attrib))
        joints = [_kind(child) for child in element if child.tag in ("joint", "freejoint")]
        free = bool(joints) and joints == ["free"]
        if joints and not free:
            to = "the world" if parent is None else parent.name
            joint_of(name, next(k for k in joints if k != "free"), self.joints, self.collected, to)
        if parent is not None and not free:
            self._fill(element, here, parent, inherited, suffix, name)
            return
        body = Rigid(name, fixed=not free)
        try:
            self._fill(element, here, body, inherited, suffix, name)
            body.finish(self.collected)
        except JointError:
            raise
        except (FormatError, MeshError) as error:
            self.collected.lack(f"body {name}", str(error))

    def _fill(
        self,
        element: ET.Element,
        here: Pose,
        body: Rigid,
        inherited: str,
        suffix: str,
        name: str,
    ) -> None:
        """Put the geoms of an element into a body, and what they weigh or its <inertial> says."""
        inertial = element.find("inertial")
        use = self.compiler.get("inertiafromgeom", "auto")
        weights = self._children(element, here, body, inherited, suffix)
        if inertial is not None and use != "true":
            weights = [given_inertial(inertial.attrib, self.frames, here, name)]
        if weights:
            body.weights.append(self._bounded(together(weights)))

    def _bounded(self, weight: Weight) -> Weight:
        """With the least mass and inertia, and the balance, that the compiler sets."""
        least_mass = values(self.compiler.get("boundmass", "0"), 1, "boundmass")[0]
        least = values(self.compiler.get("boundinertia", "0"), 1, "boundinertia")[0]
        inertia = weight.inertia
        moments, axes = np.linalg.eigh(inertia)
        if 2 * moments.max() > moments.sum() and self.compiler.get("balanceinertia") == "true":
            inertia = moments.mean() * np.eye(3)
        elif moments.min() < least:
            inertia = axes @ np.diag(np.maximum(moments, least)) @ axes.T
        return Weight(max(weight.mass, least_mass), weight.center, inertia)

    def _geom_of(
        self, element: ET.Element, pose: Pose, body: Rigid | None, inherited: str, suffix: str
    ) -> list[Weight]:
        own = element.get("name")
        name = own + suffix if own else self._number(f"geom of {body.name}" if body else "geom")
        if body is not None:
            return self._geom(element, pose, body, inherited, name)
        alone = Rigid(name, fixed=True)
        try:
            self._geom(element, pose, alone, inherited, name)
            if alone.pieces:
                alone.finish(self.collected)
        except (FormatError, MeshError) as error:
            self.collected.lack(f"geom {alone.name}", str(error))
        return []

    def _geom(
        self, element: ET.Element, pose: Pose, body: Rigid, inherited: str, name: str
    ) -> list[Weight]:
        """Add what collides of a geom; what it weighs."""
        geom = self.defaults.of(element, inherited)
        kind = geom.get("type", "mesh" if "mesh" in geom and "type" not in geom else "sphere")
        collides = geom.get("contype") != "0" or geom.get("conaffinity") != "0"
        if kind == "plane" and body.fixed:
            friction = self._friction(geom, name)
            self.collected.add_plane(name, pose.then(self.frames.pose(geom)), friction)
            return []
        if not collides and (body.fixed or geom.get("mass") == "0"):
            self.collected.leave_out(f"{kind} {name}", "it collides with nothing")
            return []
        here, piece, weight = self._shape(kind, geom, name, pose)
        if not collides:
            self.collected.leave_out(f"{kind} {name}", "it collides with nothing, but weighs")
        elif piece is None:
            self.collected.leave_out(f"{kind} {name}", ONLY)
        else:
            body.pieces.append(here.apply(piece))
            body.frictions.append(self._friction(geom, name))
        return [uniform(weight, geom, name).placed(here)]

    def _friction(self, geom: dict[str, str], name: str) -> float:
        if not geom.get("friction"):
            return 1.0
        return values(geom["friction"], None, f"{name}: friction")[0]

    def _shape(
        self, kind: str, geom: dict[str, str], name: str, pose: Pose
    ) -> tuple[Pose, np.ndarray | None, Weight]:
        """Where a geom is, its corners if it can be taken, and its weight at 1 kg/m^3."""
        here = pose.then(self.frames.pose(geom))
        if kind == "mesh":
            mesh = self.meshes.shape(geom.get("mesh"), name)
            return here, mesh.hull, mesh.weight
        if "mesh" in geom:
            raise FormatError(f"{name}: a {kind} fitted to a mesh: take the mesh itself")
        size = values(geom.get("size", ""), None, f"{name}: size")
        if "fromto" in geom:
            along, half = between(geom, name)
            here = pose.then(along)
            size = [*size[:1], half] if kind in ("cylinder", "capsule") else [*size[:1] * 2, half]
        needed = {"sphere": 1, "cylinder": 2, "capsule": 2, "box": 3, "ellipsoid": 3}.get(kind)
        if needed is None:
            return here, None, Weight(0.0, np.zeros(3), np.zeros((3, 3)))
        size = size[:needed]
        if len(size) < needed:
            raise FormatError(f"{name}: size needs {needed} numbers, not {geom.get('size')!r}")
        if min(size) <= 0:
            raise FormatError(f"{name}: size must be positive, not {geom.get('size')!r}")
        if kind == "box":
            piece = box_corners(size)
            return here, piece, of_pieces([piece])
        return here, None, _ROUND[kind](size)

    def _number(self, kind: str) -> str:
        self.unnamed[kind] += 1
        return f"{kind} {self.unnamed[kind]}"


MOST_COPIES = 10_000
"""Of one <replicate>."""

_ROUND: dict[str, Callable[[list[float]], Weight]] = {
    "sphere": lambda size: of_ellipsoid(size * 3),
    "ellipsoid": of_ellipsoid,
    "cylinder": lambda size: of_cylinder(*size),
    "capsule": lambda size: of_capsule(*size),
}


def _kind(joint: ET.Element) -> str:
    return "free" if joint.tag == "freejoint" else joint.get("type", "hinge")


def _joined(root: ET.Element, tag: str) -> dict[str, str]:
    """The attributes of all sections of one kind."""
    return {key: value for section in root.findall(tag) for key, value in section.attrib.items()}
