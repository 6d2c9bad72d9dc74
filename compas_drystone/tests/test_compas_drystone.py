"""compas_dem's reference scripts, loads, limits and sequences, through its own `Problem`."""

# ruff: noqa: E402  (what is imported below is not everywhere)
from __future__ import annotations

import contextlib
import io
import math
import runpy
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

WHY = "compas_dem is not installed: pip install compas_drystone[test]"
pytest.importorskip("compas_dem", reason=WHY)

import compas
from compas.data import json_dumps, json_loads
from compas.geometry import Box
from compas_dem.models import BlockModel
from compas_dem.problem import Problem, Solver
from reference_models import (
    DENSITY,
    FRICTION,
    arch,
    barrel_vault,
    problem_of,
    three_blocks,
    two_blocks,
)

import drystone as ds
from compas_drystone import Drystone, drystone_sequence, drystone_solve, scene_of

G = 9.81
pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning")


def solved(problem: Problem, **parameters: Any) -> Any:
    problem.set_solver(Drystone(**parameters))
    return problem.solve()


def unbalanced(problem: Problem, results: Any, extra: dict[int, Any] | None = None) -> float:
    """The largest force or moment (about its centre of mass) left on a block, as a share
    of the weight of all."""
    scene = scene_of(problem)
    weight, left = 0.0, {}
    for body in scene.bodies:
        if not body.fixed:
            weight += G * body.mass
            own = np.array([0, 0, -G * body.mass, 0, 0, 0])
            left[int(body.name)] = own + np.asarray((extra or {}).get(int(body.name), np.zeros(6)))
    centres = {int(body.name): np.array(body.centroid) for body in scene.bodies}
    for u, v in results.edges():
        points = np.array(results.contact_point((u, v)))
        vectors = np.array(results.force_vector((u, v)))
        for block, sign in ((u, -1.0), (v, 1.0)):
            if block in left:
                moments = np.cross(points - centres[block], sign * vectors).sum(axis=0)
                left[block] += np.concatenate([sign * vectors.sum(axis=0), moments])
    return float(np.abs(list(left.values())).max() / weight)


@pytest.mark.parametrize("build", [two_blocks, three_blocks, arch, barrel_vault])
def test_reference_scripts(build: Callable[[], BlockModel]) -> None:
    """Forces balance every block, push only, and stay within Coulomb's cone; the transformations
    are identities. The edges hold the model's own interfaces, but for those of two supports."""
    model = build()
    model.compute_contacts()
    problem = problem_of(model)
    results = solved(problem)
    assert results.metadata["stable"]
    assert unbalanced(problem, results) < 1e-9
    supports = {block.graphnode for block in model.supports()}
    interfaces = {
        edge
        for edge in model.graph.edges()
        if model.graph.edge_attribute(edge, "contacts") and not set(edge) <= supports
    }
    assert interfaces <= set(results.edges())
    for edge in results.edges():
        contact = results.contact_data(edge)
        total = np.array(results.resultant_global(edge))
        assert np.allclose(
            list(contact.resultant if hasattr(contact, "resultant") else total), total
        )
        for point in contact.forces:
            assert point["c_nn"] < 1e-6
            assert math.hypot(point["c_u"], point["c_v"]) <= FRICTION * point["c_np"] + 1e-6
    for block in model.elements():
        assert results.displacement(block.graphnode) == [0, 0, 0]


def test_resultants_are_those_of_rbe_where_they_are_unique() -> None:
    """Of two blocks on each other all are; of three by symmetry the vertical ones."""
    pytest.importorskip("compas_cra", reason="compas_cra is not installed")
    for build, axes in ((two_blocks, (0, 1, 2)), (three_blocks, (1, 2))):
        model = build()
        model.compute_contacts()
        problem = problem_of(model)
        problem.set_solver(Solver.RBE())
        with contextlib.redirect_stdout(io.StringIO()):
            theirs = problem.solve(verbose=False)
        ours = solved(problem)
        assert set(ours.edges()) == set(theirs.edges())
        for edge in theirs.edges():
            apart = np.subtract(ours.resultant_global(edge), theirs.resultant_global(edge))
            assert np.abs(apart[list(axes)]).max() < 1e-5 * DENSITY * G * 3, (build.__name__, edge)
            assert ours.contact_frame(edge).zaxis.dot(theirs.contact_data(edge).frame.zaxis) > 0.999


def test_forces_at_a_joint_are_in_its_own_frame() -> None:
    """Two unit cubes on a plate: 2 m g between the lower and the plate, upwards on the lower."""
    results = solved(problem_of(two_blocks()))
    assert results.resultant_global((0, 1)) == pytest.approx((0, 0, 2 * DENSITY * G), abs=1e-6)
    assert results.resultant_local((0, 1)) == pytest.approx((0, 0, 2 * DENSITY * G), abs=1e-6)
    assert list(results.force_point((0, 1))) == pytest.approx((0.5, 0.5, 0), abs=1e-9)
    assert results.face_contact((0, 1))
    assert results.contact_polygon((0, 1)).area == pytest.approx(1)
    assert results.metadata["mu"] == FRICTION


def test_results_and_solvers_are_data() -> None:
    problem = problem_of(arch())
    problem.set_solver(Drystone(forces="any", mu=0.6))
    results = problem.solve()
    again = json_loads(json_dumps(results))
    assert again.metadata == results.metadata
    assert again.resultant_global((3, 4)) == results.resultant_global((3, 4))
    solver = json_loads(json_dumps(problem))._solver
    assert isinstance(solver, Drystone)
    assert solver.parameters == problem._solver.parameters


def test_a_structure_that_falls_begins_to_move() -> None:
    """A beam whose middle is beyond its support tips: its free end goes down."""
    foot = Box.from_corner_corner_height([0, 0, -1], [1, 1, -1], 1)
    beam = Box.from_corner_corner_height([0, 0, 0], [3, 1, 0], 0.2)
    model = BlockModel.from_boxes([foot, beam])
    model.add_support(0)
    results = solved(problem_of(model))
    assert not results.metadata["stable"]
    assert results.metadata["falling"] == [1]
    placed = results.transformation(1)
    end = compas.geometry.Point(3, 0.5, 0).transformed(placed)
    assert end.z < -0.005
    results.displacement_scale = 2.0
    assert compas.geometry.Point(3, 0.5, 0).transformed(results.transformation(1)).z < 1.5 * end.z
    assert results.displacement(0) == [0, 0, 0]


def column(sideways: float = 0.0) -> tuple[Problem, Any]:
    """A cube of 1 m on a plate, with a point load sideways at the middle of its top."""
    plate = Box.from_corner_corner_height([-1, -1, -0.1], [2, 2, -0.1], 0.1)
    cube = Box.from_corner_corner_height([0, 0, 0], [1, 1, 0], 1)
    model = BlockModel.from_boxes([plate, cube])
    model.add_support(0)
    problem = problem_of(model, friction=2.0)
    live = problem.add_boundary_condition("Live")
    if sideways:
        problem.add_point_load_at_point(
            1, [0.5, 0.5, 1.0], [sideways, 0, 0], boundary_condition=live
        )
    return problem, live


def test_the_limit_of_a_push_at_the_top() -> None:
    """H h = m g b / 2: half the weight overturns a cube."""
    problem, live = column(1.0)
    results = solved(problem, live="Live")
    assert results.metadata["limit"] == pytest.approx(DENSITY * G / 2, rel=1e-9)
    assert results.metadata["bounds"][0] == pytest.approx(-DENSITY * G / 2, rel=1e-9)
    turned = compas.geometry.Point(0.0, 0.5, 0).transformed(results.transformation(1))
    assert turned.z > 0.005  # it lifts off on the side of the push
    # As a permanent load it is borne up to there, and not beyond.
    for share, stands in ((0.99, True), (1.01, False)):
        problem, _ = column(share * DENSITY * G / 2)
        results = solved(problem)
        assert results.metadata["stable"] is stands
    assert live.name == "Live"


def test_loads_are_those_of_the_boundary_conditions() -> None:
    """Point loads with a moment, a pressure on a face, a body force and another gravity: the
    resultant below is their sum, and every block is balanced."""
    problem, live = column()
    mesh = problem.model.graph.node_element(1).modelgeometry
    top = max(mesh.faces(), key=lambda face: mesh.face_center(face).z)
    problem.add_surface_load(1, top, [0, 0, -500.0], boundary_condition=live)
    live.add_point_load(1, [100.0, 0, -200.0], moment=[0, 0, 30.0])
    other = problem.add_boundary_condition("Other")
    other.add_global_body_force(0.5, 0, 0)
    other.add_gravity(9.0)
    results = solved(problem)
    expected = (DENSITY * 0.5 + 100.0, 0.0, -DENSITY * 9.0 - 700.0)
    assert results.resultant_global((0, 1)) == pytest.approx(np.negative(expected), abs=1e-6)
    extra = np.array([100 + DENSITY * 0.5, 0, -700 + DENSITY * (G - 9), 0, 0.0, 30.0])
    extra[3:] += np.cross([0, 0, 0.5], [0, 0, -500.0])
    assert unbalanced(problem, results, {1: extra}) < 1e-9


def test_a_body_force_grows() -> None:
    """Sideways a cube bears g times its width by its height."""
    problem, live = column()
    live.add_global_body_force(0, 1.0, 0)
    assert solved(problem, live="Live").metadata["limit"] == pytest.approx(G, rel=1e-9)


def test_an_arch_is_built_with_a_prop_at_a_time() -> None:
    """Without, no order exists. The steps of the sequence stand with what it holds."""
    model = arch()
    problem = problem_of(model, friction=0.7)
    assert not drystone_sequence(problem).found
    sequence = drystone_sequence(problem, hold=1)
    assert sequence.found
    assert sorted(sequence.order) == list(range(1, 29))
    assert json_loads(json_dumps(sequence)).order == sequence.order
    assert sequence.assembly_order[0] == sequence.order[-1]
    for k in (0, 10, 27):
        assert solved(problem, **sequence.step(k)).metadata["stable"]
    bare = {**sequence.step(10), "held": []}
    assert not solved(problem, **bare).metadata["stable"]
    assert "Order found" in str(sequence)
    with pytest.raises(ValueError, match="step 29 of a sequence of 28 blocks"):
        sequence.step(29)


def test_strong() -> None:
    assert solved(problem_of(two_blocks()), strong=True).metadata["must_stand"] is True


def test_the_problem_s_other_solvers_are_as_before() -> None:
    problem = problem_of(two_blocks())
    solver = Solver()
    solver.name = "Nobody"
    problem.set_solver(solver)
    with pytest.raises(ValueError, match="Nobody"):
        problem.solve()
    assert drystone_solve(problem).metadata["stable"]


def test_compas_finds_the_plug_in() -> None:
    import compas_drystone

    assert compas_drystone.__all_plugins__ == ["compas_drystone.solver"]
    assert Problem.solve.knows_drystone


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda p: p.set_contact_model("MohrCoulomb", mu=0.5, c=10.0), "cohesion 10"),
        (
            lambda p: p.boundary_conditions[0].add_displacement(1, dz=-0.1),
            "no support",
        ),
        (lambda p: p.boundary_conditions[0].add_point_load(7, [0, 0, 1]), "block 7"),
        (lambda p: p.boundary_conditions[0].add_surface_load(1, 99, [0, 0, 1]), "no face 99"),
        (lambda p: p.model.graph.node_element(1).__setattr__("_material", None), "density"),
    ],
)
def test_what_drystone_does_not_have_is_said(change: Callable[[Problem], None], said: str) -> None:
    problem, _ = column(1.0)
    change(problem)
    with pytest.raises(ValueError, match=said):
        solved(problem)


def _points(block: Any) -> list[Any]:
    return [block.modelgeometry.vertex_coordinates(v) for v in block.modelgeometry.vertices()]


def test_supports_are_displaced() -> None:
    model = arch()
    problem = problem_of(model)
    spread = problem.add_boundary_condition("Spread")
    first, last = (np.mean(_points(model.graph.node_element(node)), axis=0) for node in (0, 29))
    outwards = 0.02 if last[0] > first[0] else -0.02
    spread.add_displacement(29, dx=outwards)
    before = solved(problem_of(arch()))
    results = solved(problem)
    assert results.metadata["settled"] == "solved"
    assert len(results.metadata["hinges"]) == 3
    x, y, z = results.displacement(29)
    assert (x, y, z) == pytest.approx((outwards, 0.0, 0.0), abs=1e-12)
    assert min(results.displacement(block.graphnode)[2] for block in model.elements()) < -0.005
    thrust = [abs(r.resultant_global((28, 29))[0]) for r in (before, results)]
    assert thrust[1] < thrust[0]
    spread.add_rotation(29, [0.0, 0.001, 0.0])
    assert solved(problem).metadata["settled"] == "solved"
    with pytest.raises(ValueError, match="only loads can grow"):
        solved(problem, live="Spread")


def test_wrong_names_are_said() -> None:
    problem, _ = column(1.0)
    for parameters, said in (
        ({"live": "Snow"}, "no boundary condition is called 'Snow'; there are: 'Live'"),
        ({"held": [9]}, "no block 9"),
        ({"blocks": [9]}, "no block 9"),
    ):
        with pytest.raises(ValueError, match=said):
            solved(problem, **parameters)
    empty, _ = column()
    with pytest.raises(ValueError, match="no load on a block that can move"):
        solved(empty, live="Live")


def test_scenes_are_drystone_s() -> None:
    scene = scene_of(problem_of(two_blocks()))
    assert isinstance(scene, ds.Scene)
    assert scene.names == ["0", "1", "2"]
    assert scene.body("2").mass == pytest.approx(DENSITY)


def test_the_example_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["arch.py"])
    program = Path(__file__).resolve().parent.parent / "examples/arch.py"
    with contextlib.redirect_stdout(io.StringIO()) as said:
        runpy.run_path(str(program), run_name="__main__")
    assert "The load may be 85.5 times as large" in said.getvalue()
    assert "Order found for 18 blocks" in said.getvalue()
