"""Meshes of an MJCF model, and the defaults of its classes."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

import numpy as np

from drystone.common.extras import extra
from drystone.imports.collected import FormatError
from drystone.imports.markup import values
from drystone.imports.mjcf_frames import Frames
from drystone.imports.pose import Pose
from drystone.imports.weight import Weight, of_pieces, of_triangles
from drystone.meshes import MeshError, part_of
from drystone.meshes.hull import hull_corners, hull_triangles, hull_volume
from drystone.meshes.part import MOST_CORNERS
from drystone.meshes.reading import read_triangles

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Defaults:
    """What attributes elements have without saying so, by class."""

    def __init__(self, root: ET.Element) -> None:
        self._classes: dict[str, dict[str, dict[str, str]]] = {"main": {}}
        for default in root.findall("default"):
            self._read(default, default.get("class", "main"), self._classes["main"])

    def of(self, element: ET.Element, inherited: str = "main") -> dict[str, str]:
        """The attributes of an element, those of its class included; FormatError for no class."""
        name = element.get("class", inherited)
        if name not in self._classes:
            raise FormatError(f"no default class is called {name!r}")
        return {**self._classes[name].get(element.tag, {}), **element.attrib}

    def _read(self, element: ET.Element, name: str, outer: dict[str, dict[str, str]]) -> None:
        own = {tag: dict(attributes) for tag, attributes in outer.items()}
        for child in element:
            if child.tag != "default":
                own.setdefault(child.tag, {}).update(child.attrib)
        self._classes[name] = own
        for child in element.findall("default"):
            self._read(child, child.get("class", ""), own)


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """A mesh as it collides, and as it weighs at 1 kg/m^3."""

    hull: NDArray[np.float64]
    weight: Weight


class Meshes:
    """The meshes of a model, read when they are wanted."""

    def __init__(
        self,
        root: ET.Element,
        folders: list[Path],
        defaults: Defaults,
        frames: Frames,
        simplify: float | None,
    ) -> None:
        self._folders, self._frames, self._simplify = folders, frames, simplify
        self._assets: dict[str, dict[str, str]] = {}
        self._known: dict[str, Shape] = {}
        for asset in root.findall("asset"):
            for element in asset.findall("mesh"):
                mesh = defaults.of(element)
                self._assets[mesh.get("name") or PurePosixPath(mesh.get("file", "")).stem] = mesh

    def shape(self, name: str | None, what: str) -> Shape:
        """The mesh called so; FormatError or MeshError if there is none that can be used."""
        if name not in self._assets:
            raise FormatError(f"{what}: no mesh is called {name!r}")
        if name not in self._known:
            try:
                self._known[name] = self._read(self._assets[name])
            except OSError as error:
                raise FormatError(f"mesh {name}: {error.filename}: {error.strerror}") from None
            except (FormatError, MeshError) as error:
                raise type(error)(f"mesh {name}: {error}") from None
        return self._known[name]

    def _read(self, mesh: dict[str, str]) -> Shape:
        points, triangles = self._surface(mesh)
        reference = self._frames.pose(
            {k.removeprefix("ref"): v for k, v in mesh.items() if k in ("refpos", "refquat")}
        )
        x, y, z = values(mesh.get("scale", "1 1 1"), 3, "scale")
        points = (points - reference.position) @ reference.rotation * [x, y, z]
        if not np.isfinite(points).all() or hull_volume(points) <= 0:
            raise MeshError("it encloses no volume")
        hull = hull_corners(points)
        if self._simplify is not None:
            hull = part_of("hull", *hull_triangles(hull), True, 1, self._simplify).pieces[0]
        if len(hull) > MOST_CORNERS:
            raise MeshError(
                f"its convex hull has {len(hull)} corners, more than {MOST_CORNERS}: let it be "
                "simplified with simplify"
            )
        if triangles is None or mesh.get("inertia") == "convex":
            return Shape(hull, of_pieces([hull]))
        corners = points[triangles]
        weight = of_triangles(corners[:, ::-1] if x * y * z < 0 else corners)
        # A surface that is open or inside out encloses nothing to weigh.
        sound = 0 < weight.mass <= (1 + 1e-6) * hull_volume(points) and weight.is_of_a_body()
        return Shape(hull, weight if sound else of_pieces([hull]))

    def _surface(
        self, mesh: dict[str, str]
    ) -> tuple[NDArray[np.float64], NDArray[np.int64] | None]:
        """Vertices, and triangles if there are any."""
        if "builtin" in mesh:
            return _builtin(mesh)
        if "vertex" in mesh:
            numbers = np.array(values(mesh["vertex"], None, "vertex"))
            if numbers.size % 3:
                raise FormatError("its vertices are not three numbers each")
            return numbers.reshape(-1, 3), None
        if "file" not in mesh:
            raise FormatError("it needs a file, vertices or builtin")
        read = read_triangles(self._file(mesh["file"]))
        used, places = np.unique(read.triangles, return_inverse=True)
        return read.vertices[used], places.reshape(-1, 3)

    def _file(self, name: str) -> Path:
        places = [folder / name for folder in self._folders]
        return next((place for place in places if place.exists()), places[0])


def _builtin(mesh: dict[str, str]) -> tuple[NDArray[np.float64], None]:
    with extra("meshes", "files of other tools"):
        import trimesh

    kind, given = mesh["builtin"], values(mesh.get("params", ""), None, "params")
    if kind != "sphere":
        raise FormatError(f"the builtin mesh {kind!r} is not known: export it as a file")
    rounds = int(given[0]) if given and 0 <= given[0] <= 4 else 3
    return np.array(trimesh.creation.icosphere(rounds, radius=1.0).vertices), None


def mesh_folders(path: Path, compiler: dict[str, str]) -> list[Path]:
    """Where mesh files are looked for, the first place that MuJoCo would look at first."""
    named = compiler.get("meshdir", compiler.get("assetdir", ""))
    return [path.parent / named, path.parent]


def uniform(shape: Weight, geom: dict[str, str], what: str) -> Weight:
    """The weight of a geom: its `mass`, or its `density`, in the shape weighed at 1 kg/m^3."""
    if "mass" in geom:
        mass = values(geom["mass"], 1, f"{what}: mass")[0]
    else:
        density = values(geom.get("density", "1000"), 1, f"{what}: density")[0]
        mass = shape.mass * density
    if mass < 0:
        raise FormatError(f"{what}: its mass must not be negative, not {mass:g}")
    if mass == 0 or shape.mass <= 0:
        return Weight(0.0, np.zeros(3), np.zeros((3, 3)))
    return shape.scaled(mass / shape.mass)


def given_inertial(attributes: dict[str, str], frames: Frames, here: Pose, name: str) -> Weight:
    """What an <inertial> says, in the world."""
    what = f"inertial of {name}"
    mass = values(attributes.get("mass"), 1, f"{what}: mass")[0]
    if mass < 0:
        raise FormatError(f"{what}: its mass must not be negative, not {mass:g}")
    if "fullinertia" in attributes:
        xx, yy, zz, xy, xz, yz = values(attributes["fullinertia"], 6, f"{what}: fullinertia")
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    else:
        moments = values(attributes.get("diaginertia", "0 0 0"), 3, f"{what}: diaginertia")
        tensor = np.diag(moments)
    return Weight(mass, np.zeros(3), tensor).placed(here.then(frames.pose(attributes)))
