"""Assemblies of COMPAS (https://compas.dev), as `compas.json_dump` writes them, or as objects.

An assembly is a graph: its nodes hold blocks, which are meshes of polygons, and say whether the
block is a support. A model of compas_dem holds elements instead, with materials. Interfaces between
blocks, on edges, are not read: contacts are found anew.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.imports.collected import Collected, FormatError
from drystone.imports.compas_data import inner, matrix_of
from drystone.imports.compas_kind import kind_of
from drystone.imports.fields import entries, finite
from drystone.meshes import MeshError
from drystone.meshes.part import Part, part_from
from drystone.meshes.reading import Triangles

if TYPE_CHECKING:
    from numpy.typing import NDArray

PLANE = 3e-7
"""A face whose corners are within this share of its extent of a plane is plane: five times the
rounding of single precision, as for meshes."""


def read(data: Any, collected: Collected, **options: Any) -> str:
    """Add the blocks of an assembly or a model, and return the name of the format. The `options`
    are those of `read_part`."""
    if kind_of(data) == "Mesh":
        _add(collected, "mesh", data, None, options)
        return "COMPAS mesh"
    found = inner(data)
    if "elements" in found:
        _read_model(found, collected, options)
        return "COMPAS model"
    graph = inner(found.get("graph"))
    nodes = entries(graph.get("node"), "the assembly's graph has no nodes")
    for key, node in nodes.items():
        block = node.get("block") if isinstance(node, dict) else None
        if block is None:
            collected.leave_out(f"node {key}", "it has no block")
            continue
        density = node.get("density")
        _add(
            collected,
            key,
            block,
            None,
            options,
            density=None if density is None else finite(density, f"block {key}: density"),
            fixed=bool(node.get("is_support")),
        )
    _interfaces(graph, collected)
    return "COMPAS assembly"


def _read_model(model: dict[str, Any], collected: Collected, options: dict[str, Any]) -> None:
    """The elements of a model, named by their graph nodes or their place in it."""
    materials = model.get("materials") or {}
    whole = matrix_of(model.get("transformation"))
    graph = inner(model.get("graph") or {})
    names = {
        str(node.get("element")): str(key)
        for key, node in (graph.get("node") or {}).items()
        if isinstance(node, dict)
    }
    elements = entries(model.get("elements"), "the model has no elements")
    for number, (guid, element) in enumerate(elements.items()):
        fields = inner(element)
        name = names.get(str(guid), str(number))
        geometry = fields.get("geometry")
        if kind_of(geometry) != "Mesh":
            collected.lack(f"element {name}", "its geometry is no mesh")
            continue
        _add(
            collected,
            name,
            geometry,
            whole @ matrix_of(fields.get("transformation")),
            options,
            density=_density(fields.get("material"), materials, name),
            fixed=bool(fields.get("is_support")),
        )
    _interfaces(graph, collected)


def _density(material: Any, materials: Any, name: str) -> float | None:
    """kg/m^3 of a material, or of the one with that key."""
    if isinstance(material, str) and isinstance(materials, dict):
        material = materials.get(material)
    density = inner(material).get("density") if isinstance(material, dict) else None
    return None if density is None else finite(density, f"element {name}: density")


def _add(
    collected: Collected,
    name: str,
    block: Any,
    place: NDArray[np.float64] | None,
    options: dict[str, Any],
    **body: Any,
) -> None:
    vertices, triangles, said = _mesh(inner(block), name)
    if place is not None:
        vertices = vertices @ place[:3, :3].T + place[:3, 3]
    try:
        read = Triangles(name, vertices, triangles, repeats=False)
        part: Part = part_from(read, tolerance=collected.mesh_tolerance, **options)
    except MeshError as error:
        raise MeshError(f"block {name}: {error}") from None
    collected.say(f"block {name}", [*said, *part.messages])
    factor, tolerance = part.density_factor, part.tolerance
    collected.add(
        name,
        part.pieces,
        density_factor=factor,
        tolerance=tolerance,
        triangles=part.triangles,
        **body,
    )


def _mesh(block: dict[str, Any], key: str) -> tuple[Any, Any, list[str]]:
    """Vertices (k, 3), triangles (n, 3), and what was done to the faces."""
    points = entries(block.get("vertex"), f"block {key} has no vertices")
    numbers = {str(vertex): number for number, vertex in enumerate(points)}
    vertices = [_point(point, f"block {key}: vertex {vertex}") for vertex, point in points.items()]
    triangles: list[list[int]] = []
    warped, farthest = 0, 0.0
    for face, corners in entries(block.get("face"), f"block {key} has no faces").items():
        try:
            ring = [numbers[str(corner)] for corner in corners]
        except (KeyError, TypeError, ValueError):
            raise FormatError(
                f"block {key}: face {face} uses vertices that are not there"
            ) from None
        off = _off_plane([vertices[corner] for corner in ring])
        if not off:
            triangles += [[ring[0], *pair] for pair in pairwise(ring[1:])]
            continue
        # From its middle, so that both blocks at a face fill it alike and no triangle folds over.
        warped, farthest = warped + 1, max(farthest, off)
        middle = np.mean([vertices[corner] for corner in ring], axis=0)
        triangles += [[len(vertices), *pair] for pair in pairwise([*ring, ring[0]])]
        vertices.append(middle.tolist())
    said = []
    if warped:
        said.append(
            f"{warped} of its faces are not plane, by up to {farthest:.2g} in its unit: they are "
            "filled with triangles from their middle"
        )
    triangles_of = np.array(triangles, dtype=np.int64).reshape(-1, 3)
    return np.array(vertices, dtype=float), triangles_of, said


def _point(point: dict[str, Any], what: str) -> list[float]:
    return [finite(point.get(axis, 0.0), what) for axis in "xyz"]


def _off_plane(ring: list[list[float]]) -> float:
    """How far corners are from their plane; 0 if that is rounding."""
    if len(ring) < 4 or (len(ring) == 4 and _diagonals_meet(*ring)):
        return 0.0
    corners = np.array(ring)
    arms = corners - corners.mean(axis=0)
    normal = np.linalg.svd(arms)[2][2]
    off = float(abs(arms @ normal).max())
    return off if off > PLANE * float(np.ptp(corners, axis=0).max()) else 0.0


def _diagonals_meet(a: list[float], b: list[float], c: list[float], d: list[float]) -> bool:
    """Whether the diagonals of a quadrilateral are in one plane, by far less than rounding is."""
    u, v, w = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    x, y, z = d[0] - b[0], d[1] - b[1], d[2] - b[2]
    normal = v * z - w * y, w * x - u * z, u * y - v * x
    apart = sum(n * (q - p) for n, p, q in zip(normal, a, b, strict=True))
    extent = max(abs(u), abs(v), abs(w), abs(x), abs(y), abs(z))
    # |apart| / |normal| is their distance, and each corner is half of it off.
    return apart * apart <= (0.1 * PLANE * extent) ** 2 * sum(n * n for n in normal)


def _interfaces(graph: dict[str, Any], collected: Collected) -> None:
    edges = graph.get("edge") or {}
    count = sum(len(ends) for ends in edges.values() if isinstance(ends, dict))
    if count:
        collected.leave_out(f"{count} edges with interfaces", "contacts are found anew")
