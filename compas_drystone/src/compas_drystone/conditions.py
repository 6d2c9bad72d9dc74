"""Boundary conditions of a problem: the forces, accelerations and displacements in them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from compas_dem.models import BlockModel
    from compas_dem.problem import BoundaryConditionGroup, Problem
    from numpy.typing import NDArray

GRAVITY = 9.81
"""m/s^2, of groups in which no other was set."""


@dataclass(frozen=True, slots=True)
class Acting:
    """A force and a moment on a block, N and N m, world axes."""

    block: int
    force: NDArray[np.float64]
    at: NDArray[np.float64] | None
    """Where, metres; None for the centre of mass."""
    moment: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Displaced:
    """A displacement of a support, m, and its turn about the centroid, rad, world axes."""

    block: int
    translation: NDArray[np.float64]
    rotation: NDArray[np.float64]


def split(
    problem: Problem, live: str | None
) -> tuple[list[BoundaryConditionGroup], BoundaryConditionGroup | None]:
    """The groups whose loads stay, and the one whose loads grow, if one does."""
    groups = list(problem.boundary_conditions)
    if live is None:
        return groups, None
    named = [group for group in groups if group.name == live]
    if not named:
        known = ", ".join(repr(group.name) for group in groups) or "none"
        raise ValueError(f"no boundary condition is called {live!r}; there are: {known}")
    return [group for group in groups if group is not named[0]], named[0]


def gravity(groups: Iterable[BoundaryConditionGroup]) -> float:
    """m/s^2, downwards. A group that was not told keeps 9.81, so another value in any counts."""
    told = {float(group.g) for group in groups} - {GRAVITY}
    if len(told) > 1:
        raise ValueError(f"boundary conditions set different gravities: {sorted(told)}")
    return told.pop() if told else GRAVITY


def accelerations(groups: Iterable[BoundaryConditionGroup]) -> NDArray[np.float64]:
    """(3,): the sum of all body forces, m/s^2."""
    given = [force.acceleration for group in groups for force in group.body_forces]
    return np.sum([np.zeros(3), *np.array(given, dtype=float).reshape(-1, 3)], axis=0)


def acting(model: BlockModel, groups: Iterable[BoundaryConditionGroup]) -> Iterator[Acting]:
    """Point and surface loads. Those on supports are left out: nothing follows from them."""
    blocks = {block.graphnode: block for block in model.elements()}
    for group in groups:
        for load in group.point_loads:
            block = _block(blocks, load.block_index, "a point load")
            at = None if load.point is None else np.array(list(load.point), dtype=float)
            found = Acting(load.block_index, _three(load.force), at, _three(load.moment))
            if not block.is_support:
                yield found
        for load in group.surface_loads:
            block = _block(blocks, load.block_index, "a surface load")
            mesh = block.modelgeometry
            if load.face_index not in set(mesh.faces()):
                raise ValueError(f"block {load.block_index} has no face {load.face_index}")
            force = _three(load.load) * mesh.face_area(load.face_index)
            at = np.array(list(mesh.face_center(load.face_index)), dtype=float)
            if not block.is_support:
                yield Acting(load.block_index, force, at, np.zeros(3))


def _block(blocks: dict[int, Any], node: int, what: str) -> Any:
    if node not in blocks:
        raise ValueError(f"{what} is on block {node}, which is not in the model")
    return blocks[node]


def _three(value: Iterable[float] | None) -> NDArray[np.float64]:
    return np.zeros(3) if value is None else np.array(list(value), dtype=float)


def _parts(entry: Any, what: str) -> list[float]:
    """Of a displacement, which is a translation or a rotation; free parts are zero."""
    return [part or 0.0 for part in getattr(entry, what, None) or (0.0,) * 3]


def displaced(
    model: BlockModel, groups: Iterable[BoundaryConditionGroup], held: Iterable[int] = ()
) -> Iterator[Displaced]:
    """Prescribed displacements of supports, and of blocks that are `held`. Of a translation what is
    left free stays where it is."""
    blocks = {block.graphnode: block for block in model.elements()}
    fixed = set(held)
    for group in groups:
        for entry in group.displacements:
            block = _block(blocks, entry.block_index, "a displacement")
            moved, turned = (_three(_parts(entry, what)) for what in ("translation", "rotation"))
            if not (moved.any() or turned.any()):
                continue
            if not (block.is_support or entry.block_index in fixed):
                raise ValueError(
                    f"block {entry.block_index} has a prescribed displacement in boundary "
                    f"condition {group.name!r}, but is no support: drystone displaces supports only"
                )
            yield Displaced(entry.block_index, moved, turned)
