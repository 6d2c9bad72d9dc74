"""The solver: a problem of compas_dem in, its results out."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from compas_dem.problem import Problem, Results, Solver

import drystone as ds
from compas_drystone.results import results_of
from compas_drystone.scene import push_of, scene_of

if TYPE_CHECKING:
    from compas_dem.models import BlockModel
    from numpy.typing import NDArray


class Drystone(Solver):
    """Solver configuration, as `Solver.RBE()` is one. The parameters are those of
    `drystone_solve`."""

    def __init__(
        self,
        live: str | None = None,
        blocks: Iterable[int] | None = None,
        held: Iterable[int] = (),
        strong: bool = False,
        forces: Literal["canonical", "any"] = "canonical",
        mu: float | None = None,
        density: float | None = None,
        tolerance: float | Literal["auto"] | None = None,
        verbose: bool = False,
    ) -> None:
        super().__init__()
        self.name = "Drystone"
        self.parameters = {
            "live": live,
            "blocks": None if blocks is None else list(blocks),
            "held": list(held),
            "strong": strong,
            "forces": forces,
            "mu": mu,
            "density": density,
            "tolerance": tolerance,
            "verbose": verbose,
        }

    @classmethod
    def __from_data__(cls, data: dict[str, Any]) -> Drystone:
        return cls(**data["parameters"])


def drystone_solve(
    problem: Problem,
    model: BlockModel | None = None,
    live: str | None = None,
    blocks: Iterable[int] | None = None,
    held: Iterable[int] = (),
    strong: bool = False,
    forces: Literal["canonical", "any"] = "canonical",
    mu: float | None = None,
    density: float | None = None,
    tolerance: float | Literal["auto"] | None = None,
    verbose: bool = False,
) -> Results:
    """Solve a problem with drystone.

    Without `live`: does it stand? `results.metadata["stable"]` says so. The forces are those of
    least norm, or with `forces="any"` the first found, which takes less time. Of a structure that
    falls the transformations show how it begins to.

    With `live`, the name of a boundary condition: how often may its loads be applied, beside all
    others? `results.metadata["limit"]` is that factor, `metadata["bounds"]` the least and the
    greatest with which it can stand. Forces are those at the limit, and transformations show the
    collapse beyond it.

    Where supports are displaced, results are those after it: contact forces, and transformations of
    the true size. `metadata["settled"]` is its status ("no_solution" if no rigid blocks can
    follow), `metadata["hinges"]` the pairs of blocks between which hinges open. A limit does not
    depend on small displacements.

    `blocks` are the graph nodes of the blocks that are there (all unless given; supports always
    are), `held` those that are held in their places, as by hands. `strong=True` also decides
    whether it must stand (`metadata["must_stand"]`). `mu`, `density` and `tolerance` are as in
    `scene_of`. `verbose` prints the answer in words.

    Transformations of blocks that move are the beginning of a motion: how large it is shown is
    `compas_drystone.results.SHOWN`, and `results.displacement_scale` shows more.

    Raises what `scene_of` does, and ValueError for a node that is not in the model.
    """
    model = problem.model if model is None else model
    scene = scene_of(
        problem, model, held=held, live=live, mu=mu, density=density, tolerance=tolerance
    )
    there = None if blocks is None else _names(scene, blocks)
    if live is not None:
        return _limit(problem, model, scene, live, there, verbose)
    verdict = ds.check(scene, there, strong=strong, forces=forces)
    if verbose:
        print(verdict)
    falls = verdict.status == "solved" and not verdict.stable
    motion = dict(zip(verdict.names, verdict.accelerations, strict=True)) if falls else {}
    settled = verdict.settled
    if settled is not None and settled.status == "solved":
        results = results_of(
            problem, model, scene, settled.forces, _displacements(scene, settled), to_scale=True
        )
    else:
        results = results_of(problem, model, scene, verdict.forces, _moving(motion))
    if settled is not None:
        results.metadata.update(
            settled=settled.status,
            hinges=[[int(hinge.a), int(hinge.b)] for hinge in settled.hinges],
        )
    results.metadata.update(
        solver="Drystone",
        mu=scene.friction,
        stable=verdict.stable,
        status=verdict.status,
        must_stand=verdict.must_stand,
        falling=[int(name) for name in verdict.falling],
        forces=verdict.forces.kind,
        seconds=verdict.seconds,
    )
    return results


def _limit(
    problem: Problem,
    model: BlockModel,
    scene: ds.Scene,
    live: str,
    there: list[str] | None,
    verbose: bool,
) -> Results:
    push, gravity = push_of(problem, scene, live, model)
    if there is not None:
        push = {name: wrench for name, wrench in push.items() if name in there}
    found = ds.limit(scene, push, gravity, there)
    if verbose:
        print(found)
    results = results_of(problem, model, scene, found.forces, found.mechanism)
    results.metadata.update(
        solver="Drystone",
        mu=scene.friction,
        stable=found.status == "solved" and found.bounds[0] <= 0 <= found.bounds[1],
        status=found.status,
        limit=found.factor,
        bounds=list(found.bounds),
        falling=[int(name) for name in found.mechanism],
        forces="any",
        seconds=found.seconds,
    )
    return results


def _names(scene: ds.Scene, nodes: Iterable[int]) -> list[str]:
    movable = {body.name for body in scene.bodies if not body.fixed}
    names = [str(node) for node in nodes]
    for name in names:
        if name not in scene.names:
            raise ValueError(f"blocks: no block {name} in the model")
    return [name for name in names if name in movable]


def _displacements(scene: ds.Scene, settled: ds.Settled) -> dict[str, NDArray[np.float64]]:
    """Of centres of mass, and turns: of the blocks, and of the supports that they follow."""
    moved = dict(zip(settled.names, settled.displacements, strict=True))
    for support in scene.settlements:
        assert isinstance(support.rotation, tuple)
        row = np.concatenate([support.displacement, support.rotation])
        moved[support.body] = moved.get(support.body, np.zeros(6)) + row
    return _moving(moved)


def _moving(motion: Mapping[str, NDArray[np.float64]]) -> dict[str, NDArray[np.float64]]:
    return {name: values for name, values in motion.items() if values.any()}


def _teach() -> None:
    """`Problem.solve` gives a problem whose solver is ours to it, and any other to its own."""
    theirs = Problem.solve
    if hasattr(theirs, "knows_drystone"):
        return

    @functools.wraps(theirs)
    def solve(self: Problem, **runtime_options: Any) -> Results:
        solver = self._solver
        if not isinstance(solver, Drystone):
            return theirs(self, **runtime_options)
        model = self.model
        self._check_model_validity(model)
        return drystone_solve(self, model, **{**solver.parameters, **runtime_options})

    solve.knows_drystone = True  # type: ignore[attr-defined]
    Problem.solve = solve


_teach()
