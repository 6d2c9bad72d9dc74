"""Assemblies of COMPAS (https://compas.dev), as `compas.json_dump` writes them.

An assembly is a graph: its nodes hold blocks, which are meshes of polygons, and say whether the
block is a support. Interfaces between blocks, on its edges, are not read: contacts are found anew.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from drystone.imports.collected import Collected, FormatError
from drystone.imports.fields import entries, finite
from drystone.meshes import MeshError, part_of
from drystone.meshes.rounding import assumed


def is_assembly(data: Any) -> bool:
    """Whether JSON data is an assembly (of COMPAS 2, or of COMPAS 1 with its other keys)."""
    if not isinstance(data, dict):
        return False
    return str(data.get("dtype", data.get("datatype", ""))).rsplit("/", 1)[-1].endswith("Assembly")


def read(data: Any, collected: Collected, max_pieces: int) -> None:
    """Add an assembly's blocks, named by their keys in the graph."""
    graph = _inner(_inner(data).get("graph"))
    nodes = entries(graph.get("node"), "the assembly's graph has no nodes")
    for key, node in nodes.items():
        block = node.get("block") if isinstance(node, dict) else None
        if block is None:
            collected.leave_out(f"node {key}", "it has no block")
            continue
        vertices, triangles = _mesh(_inner(block), key)
        try:
            part = part_of(
                key,
                vertices,
                triangles,
                max_pieces=max_pieces,
                exact=assumed(vertices, tolerance=collected.mesh_tolerance),
            )
        except MeshError as error:
            raise MeshError(f"block {key}: {error}") from None
        collected.say(f"block {key}", part.messages)
        density = node.get("density")
        collected.add(
            key,
            part.pieces,
            density=None if density is None else finite(density, f"block {key}: density"),
            fixed=bool(node.get("is_support")),
            tolerance=part.tolerance,
        )
    _interfaces(graph, collected)


def _inner(value: Any) -> dict[str, Any]:
    """The data of a COMPAS object, with or without its wrapping."""
    if not isinstance(value, dict):
        raise FormatError("not a COMPAS assembly: an object is missing in it")
    for key in ("data", "value"):
        if key in value and ("dtype" in value or "datatype" in value):
            return _inner(value[key])
    return value


def _mesh(block: dict[str, Any], key: str) -> tuple[Any, Any]:
    """Vertices (k, 3), and triangles (n, 3) in fans from the first corner of each polygon."""
    points = entries(block.get("vertex"), f"block {key} has no vertices")
    numbers = {str(vertex): number for number, vertex in enumerate(points)}
    vertices = [
        [finite(point.get(axis, 0.0), f"block {key}: vertex {vertex}") for axis in "xyz"]
        for vertex, point in points.items()
    ]
    triangles = []
    for face, corners in entries(block.get("face"), f"block {key} has no faces").items():
        try:
            first, *others = [numbers[str(corner)] for corner in corners]
        except (KeyError, TypeError, ValueError):
            raise FormatError(
                f"block {key}: face {face} uses vertices that are not there"
            ) from None
        triangles += [[first, *pair] for pair in pairwise(others)]
    return np.array(vertices, dtype=float), np.array(triangles, dtype=np.int64).reshape(-1, 3)


def _interfaces(graph: dict[str, Any], collected: Collected) -> None:
    edges = graph.get("edge") or {}
    count = sum(len(ends) for ends in edges.values() if isinstance(ends, dict))
    if count:
        collected.leave_out(f"{count} edges with interfaces", "contacts are found anew")
