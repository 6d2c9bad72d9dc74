"""A problem of compas_dem as a scene of drystone."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Literal

import numpy as np

import drystone as ds
from compas_drystone.conditions import accelerations, acting, displaced, gravity, split
from drystone.imports import load

if TYPE_CHECKING:
    from compas_dem.models import BlockModel
    from compas_dem.problem import Problem


def scene_of(
    problem: Problem,
    model: BlockModel | None = None,
    *,
    held: Iterable[int] = (),
    live: str | None = None,
    mu: float | None = None,
    density: float | None = None,
    tolerance: float | Literal["auto"] | None = None,
) -> ds.Scene:
    """The scene of a problem: its blocks, named by their graph nodes, and what acts on them.

    Prescribed displacements of supports are settlements of the scene (`ds.Scene.add_settlement`):
    small, translations in metres, rotations in radians about the centroid.

    `model` is that of the problem unless given. Blocks in `held` are supports besides those of the
    model. The loads of the boundary condition called `live` are left out. `mu`
    is the friction coefficient (that of the contact model unless given), `density` (kg/m^3) that of
    every block (that of its material unless given), `tolerance` as in `drystone.imports.load`.

    Body forces are accelerations, and added to gravity. Contacts are found by drystone: those of
    `model.compute_contacts` are not needed.

    Raises ValueError for what drystone does not have: cohesion, tension, prescribed displacements
    of blocks that are no supports; or what is missing: friction, densities. Raises
    drystone.DrystoneError for blocks that make no scene, such as ones that overlap.
    """
    model = problem.model if model is None else model
    permanent, growing = split(problem, live)
    if growing is not None and any(displaced(model, [growing], held)):
        raise ValueError(f"boundary condition {live!r} has displacements: only loads can grow")
    nodes = {block.graphnode for block in model.elements()}
    unknown = sorted(set(held) - nodes)
    if unknown:
        raise ValueError(f"held: no block {unknown[0]} in the model")
    if density is None:
        _all_have_densities(model)
    down = np.array([0.0, 0.0, -gravity(problem.boundary_conditions)])
    scene = load(
        model,
        friction=_friction(problem) if mu is None else mu,
        density=density,
        gravity=(down + accelerations(permanent)).tolist(),
        fixed=[str(node) for node in held],
        tolerance=tolerance,
    ).scene
    fixed = {body.name for body in scene.bodies if body.fixed}
    for one in acting(model, permanent):
        if str(one.block) not in fixed:
            at = None if one.at is None else one.at.tolist()
            scene.add_load(str(one.block), one.force.tolist(), at=at, moment=one.moment.tolist())
    for support in displaced(model, permanent, held):
        name, moved, turned = str(support.block), support.translation, support.rotation
        scene.add_settlement(name, moved.tolist(), turned.tolist())
    return scene


def push_of(
    problem: Problem, scene: ds.Scene, live: str, model: BlockModel | None = None
) -> tuple[dict[str, tuple[float, ...]], tuple[float, ...] | None]:
    """The loads of the boundary condition called `live` as `drystone.limit` takes them: forces and
    moments at centres of mass, N and N m, and an acceleration of all blocks, m/s^2, or None.

    `scene` is that of the problem. Raises ValueError if there is no load on a block that can move.
    """
    model = problem.model if model is None else model
    _, growing = split(problem, live)
    assert growing is not None
    wrenches: dict[str, np.ndarray] = {}
    for one in acting(model, [growing]):
        body = scene.body(str(one.block))
        if body.fixed:
            continue
        arm = np.zeros(3) if one.at is None else one.at - np.array(body.centroid)
        wrench = np.concatenate([one.force, one.moment + np.cross(arm, one.force)])
        wrenches[body.name] = wrenches.get(body.name, 0.0) + wrench
    pull = accelerations([growing])
    if not wrenches and not pull.any():
        raise ValueError(f"boundary condition {live!r} has no load on a block that can move")
    push = {name: tuple(wrench.tolist()) for name, wrench in wrenches.items()}
    return push, tuple(pull.tolist()) if pull.any() else None


def _friction(problem: Problem) -> float:
    law = problem.contact_properties.contact_model
    if law is None:
        raise ValueError('no friction: call problem.set_contact_model("MohrCoulomb", mu=...)')
    for strength, what in ((law.c, "cohesion"), (law.t_c, "tensile strength")):
        if strength:
            raise ValueError(
                f"the contact model has {what} {strength:g}: drystone's joints are dry"
            )
    return float(law.mu)


def _all_have_densities(model: BlockModel) -> None:
    for block in model.elements():
        material = block.material
        if not block.is_support and (material is None or not material.density):
            raise ValueError(
                f"block {block.graphnode} has no material with a density: call "
                "model.assign_material(...), or give density="
            )
