"""Answers of drystone as `Results` of compas_dem."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot
from typing import TYPE_CHECKING, Any

import compas.geometry as cg
import numpy as np
from compas_dem.problem import Results

from compas_drystone.contacts import Between, Vector, between

if TYPE_CHECKING:
    from compas_dem.models import BlockModel
    from compas_dem.problem import Problem
    from numpy.typing import ArrayLike

    import drystone as ds

SHOWN = 0.01
"""The furthest that a motion takes a centre of mass, or a corner by turning, as a share of the
diagonal of the blocks: it is the beginning of a motion, and this is how large it is shown."""


def results_of(
    problem: Problem,
    model: BlockModel,
    scene: ds.Scene,
    forces: ds.ContactForces | None,
    motion: Mapping[str, ArrayLike],
    *,
    to_scale: bool = False,
) -> Results:
    """Contact forces and the beginning of a motion, as compas_dem has them.

    Each two blocks that touch are an edge (u, v), turned as in the model's graph; its resultant is
    the force of u on v. `motion` is (6,) for each block that moves: along x, y and z, and turning
    about them, in any unit; with `to_scale` metres and radians. The transformation of a block is
    the identity if it does not move.
    """
    results = Results(model_id=str(model.guid), problem_id=str(problem.guid))
    _move(results, model, scene, motion, to_scale)

    def edge_of(a: int, b: int) -> tuple[int, int]:
        if model.graph.has_edge((a, b)):
            return a, b
        if model.graph.has_edge((b, a)):
            return b, a
        return min(a, b), max(a, b)

    for one in between(scene, forces, edge_of) if forces is not None else ():
        _fill(results, one)
    return results


def _fill(results: Results, one: Between) -> None:
    contact, count = one.data(), len(one.points)
    shape = cg.Line(*one.points) if count == 2 else contact.geometry
    total = _sum(one.vectors)
    told = {
        "contact_data": contact,
        "contact_points": [list(point) for point in one.points],
        "contact_geometry": shape,
        "contact_frame": one.frame,
        "face_contact": count > 2,
        "edge_contact": count == 2,
        "point_contact": count == 1,
        "resultant_global": total,
        "resultant_local": _sum(one.locals),
        "force_magnitude": hypot(*total),
        "force_point": contact.resultantpoint,
        "force_vector": [list(vector) for vector in one.vectors],
        "force_normal": [n for _, _, n in one.locals],
        "force_tangent1": [u for u, _, _ in one.locals],
        "force_tangent2": [v for _, v, _ in one.locals],
        "nodal_force_magnitudes": [hypot(*vector) for vector in one.vectors],
        "force_on_node": one.edge[1],
    }
    if count > 2:
        told["contact_polygon"] = shape
    for name, value in told.items():
        results.set_edge(one.edge, name, value)


def _sum(vectors: list[Vector]) -> list[float]:
    return [sum(along) for along in zip(*vectors, strict=True)]


def _move(
    results: Results,
    model: BlockModel,
    scene: ds.Scene,
    motion: Mapping[str, ArrayLike],
    to_scale: bool,
) -> None:
    blocks = list(model.elements())
    moving = {name: np.asarray(values, dtype=float) for name, values in motion.items()}
    step = _step(blocks, scene, moving, to_scale) if moving else 0.0
    for block in blocks:
        name, placed = str(block.graphnode), cg.Transformation()
        if name in moving:
            placed = _rigid(step * moving[name], np.array(scene.body(name).centroid))
        results.set_node(block.graphnode, "transformation", placed)


def _step(
    blocks: list[Any], scene: ds.Scene, moving: Mapping[str, np.ndarray], to_scale: bool
) -> float:
    """By how much a motion is multiplied, so that it can be seen."""
    if to_scale:
        return 1.0
    corners = {str(block.graphnode): _corners(block) for block in blocks}
    fastest = 0.0
    for name, values in moving.items():
        reach = np.linalg.norm(corners[name] - np.array(scene.body(name).centroid), axis=1).max()
        turning = np.linalg.norm(values[3:]) * reach
        fastest = max(fastest, float(np.linalg.norm(values[:3])), float(turning))
    diagonal = float(np.linalg.norm(np.ptp(np.concatenate(list(corners.values())), axis=0)))
    return SHOWN * diagonal / fastest if fastest > 0 else 0.0


def _corners(block: object) -> np.ndarray:
    mesh = block.modelgeometry  # type: ignore[attr-defined]
    return np.array([mesh.vertex_coordinates(vertex) for vertex in mesh.vertices()], dtype=float)


def _rigid(motion: np.ndarray, centre: np.ndarray) -> cg.Transformation:
    """Turned about its centre of mass, then moved."""
    angle = float(np.linalg.norm(motion[3:]))
    axis = (motion[3:] / angle).tolist() if angle > 0 else [0.0, 0.0, 1.0]
    turned = cg.Rotation.from_axis_and_angle(axis, angle, point=centre.tolist())
    return cg.Transformation.from_matrix(
        (cg.Translation.from_vector(motion[:3].tolist()) * turned).matrix
    )
