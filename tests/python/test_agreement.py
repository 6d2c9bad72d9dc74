"""Verdicts against an independent linear program with a margin, on a thousand random assemblies.

The program is built here from the contacts and masses that a scene shows, not from the core's
generators: for contact forces n (normal) and t (tangential) with |t| <= mu n at every point,

    minimise e   subject to   |a_x|, |a_y|, r |alpha| <= e g   for every block,

where a and alpha are the accelerations of the block under these forces and its weight, and r is
the distance of its furthest corner from its centroid. The least e is the assembly's margin: the
part of a weight that has to stay unbalanced somewhere.

`check` says that a block is at rest below 1e-9 g, and finds the accelerations that are least in the
metric of the masses. So what stands by `check` has e <= 1e-9. The program's accelerations have at
most the square 3 M (e g)^2 in that metric, M the total mass; so those of `check` are at most
3 sqrt(M / m) e g for a box of mass m (its radius of gyration is r / sqrt(3)), and what falls has
e > 0 by more than rounding.
"""

from __future__ import annotations

import json
import math
from collections import Counter

import highspy
import numpy as np
import pytest
from scipy import sparse

import drystone as ds
from conftest import dropped
from drystone.statics import QuietHighs

STANDS = 1e-9
"""Ten times HiGHS's own tolerance: a smaller margin cannot be told from none."""
FALLS = 1e-6
"""A block that overhangs its edge by a millionth of its width. Between the two: not decided."""
ASSEMBLIES = 1000
TESTS = ("lcp", "reuse", "reuse-dantzig")


def margin(scene: ds.Scene) -> float:
    """The least share e of gravity that stays unbalanced: 0 for an assembly that stands."""
    balance, right = _balance(scene)
    rows, columns = balance.shape
    ones = np.ones((rows, 1))
    matrix = sparse.csc_array(sparse.block_array([[balance, ones], [-balance, ones]]))
    program = highspy.HighsLp()
    program.num_row_, program.num_col_ = 2 * rows, columns + 1
    program.col_cost_ = np.append(np.zeros(columns), 1.0)
    program.col_lower_ = np.zeros(columns + 1)
    program.col_upper_ = np.full(columns + 1, highspy.kHighsInf)
    program.row_lower_ = np.concatenate((right, -right))
    program.row_upper_ = np.full(2 * rows, highspy.kHighsInf)
    program.a_matrix_.format_ = highspy.MatrixFormat.kColwise
    program.a_matrix_.start_ = matrix.indptr
    program.a_matrix_.index_ = matrix.indices
    program.a_matrix_.value_ = matrix.data
    for solver in ("simplex", "ipm"):
        highs = QuietHighs()
        highs.setOptionValue("threads", 1)
        highs.setOptionValue("solver", solver)
        # The tightest that HiGHS takes.
        highs.setOptionValue("primal_feasibility_tolerance", 1e-10)
        highs.setOptionValue("dual_feasibility_tolerance", 1e-10)
        highs.passModel(program)
        highs.run()
        if highs.getModelStatus() == highspy.HighsModelStatus.kOptimal:
            return highs.getInfo().objective_function_value
    raise AssertionError("HiGHS has no answer: e = 1 without any force is feasible")


def _balance(scene: ds.Scene) -> tuple[sparse.csc_array, np.ndarray]:
    """`balance @ f = right` says that every block is at rest, in units of gravity.

    Columns are the two edges of every contact's friction cone (equal ones without friction),
    scaled to a largest entry of one, which scales only the unit of the force.
    """
    g = math.hypot(*scene.gravity)
    place = {body.name: i for i, body in enumerate(b for b in scene.bodies if not b.fixed)}
    bodies = {body.name: body for body in scene.bodies}
    columns = []
    for contact in scene.contacts:
        normal = np.array(contact.normal)
        tangent = np.array([-normal[1], normal[0]])
        for side in (contact.friction, -contact.friction):
            column = np.zeros(3 * len(place))
            for name, force in (
                (contact.a, -normal - side * tangent),
                (contact.b, normal + side * tangent),
            ):
                if name in place:
                    body = bodies[name]
                    arm = np.array(contact.point) - body.centroid
                    reach = np.max(np.linalg.norm(body.vertices - body.centroid, axis=1))
                    moment = arm[0] * force[1] - arm[1] * force[0]
                    column[3 * place[name] :][:3] = (
                        *force / (body.mass * g),
                        moment * reach / (body.inertia * g),
                    )
            columns.append(column / np.max(np.abs(column)))
    right = np.tile(np.append(-np.array(scene.gravity) / g, 0.0), len(place))
    matrix = np.column_stack(columns) if columns else np.zeros((len(right), 0))
    return sparse.csc_array(matrix), right


def changed(scene: ds.Scene, rng: np.random.Generator) -> ds.Scene:
    """The same blocks with other densities, some of them gone, on ground that may tilt."""
    data = json.loads(scene.to_json())
    if rng.uniform() < 0.3:
        for body in data["bodies"]:
            body["density"] = float(rng.uniform(0.5, 2.0))
    if rng.uniform() < 0.3:
        movable = [body for body in data["bodies"] if not body.get("fixed")]
        gone = rng.permutation(len(movable))[: rng.integers(0, 1 + len(movable) // 4)]
        for k in gone:
            data["bodies"].remove(movable[k])
    if rng.uniform() < 0.5:
        tilt = rng.uniform(-1, 1) * math.atan(data["friction"])
        data["gravity"] = [9.81 * math.sin(tilt), -9.81 * math.cos(tilt)]
    return ds.Scene.from_json(json.dumps(data))


def random_assembly(rng: np.random.Generator, most: int = 60) -> tuple[str, ds.Scene]:
    """An assembly of 2 to `most` blocks with friction 0 to 1, and its kind."""
    friction = float(rng.uniform()) if rng.uniform() < 0.9 else float(rng.integers(2))
    blocks = int(rng.integers(3, most + 1))
    seed = int(rng.integers(1, 10**6))
    kind = str(rng.choice(["dropped", "stack", "wall", "arch"]))
    if kind == "dropped":
        scene = dropped(rng, 2 + blocks // 5, friction)
    elif kind == "stack":
        scene = ds.scenes.random_stack(2 + blocks // 2, seed=seed, friction=friction)
    elif kind == "wall":
        rows = int(rng.integers(1, 1 + math.isqrt(blocks)))
        scene = ds.scenes.wall(rows, max(2, blocks // rows - 1), seed=seed, friction=friction)
    else:
        thickness = rng.uniform(0.06, 0.3)
        scene = ds.scenes.arch(min(blocks, 30), thickness=thickness, friction=friction)
    return kind, changed(scene, rng)


def test_verdicts_agree_with_the_linear_program_on_a_thousand_assemblies() -> None:
    rng = np.random.default_rng(2006)
    seen: Counter[tuple[str, bool | None]] = Counter()
    for number in range(ASSEMBLIES):
        kind, scene = random_assembly(rng)
        unbalanced = margin(scene)
        decided = unbalanced < STANDS or unbalanced > FALLS
        verdict = ds.check(scene)
        assert verdict.status == "solved", f"assembly {number}"
        assert verdict.residual <= 1e-9
        if decided:
            assert verdict.stable == (unbalanced < STANDS), f"assembly {number}: {unbalanced:.1e}"
            assert ds.check(scene, method="lcp").stable == verdict.stable, f"assembly {number}"
        if verdict.stable:
            plans = [ds.plan(scene, test, node_limit=20, shortcuts=False) for test in TESTS]
            visited = [[(record.size, record.stable) for record in p.records] for p in plans]
            assert visited[0] == visited[1] == visited[2], f"assembly {number}"
        seen[kind, verdict.stable if decided else None] += 1
    assert sum(count for (_, stable), count in seen.items() if stable is None) < ASSEMBLIES // 50
    # Neither answer is rare in any kind.
    assert min(seen[kind, stable] for kind, _ in seen for stable in (False, True)) >= 20


def test_verdicts_agree_next_to_the_limit() -> None:
    """Ground tilted until the assembly falls: the program agrees within 1e-6 rad of there.

    The loads that forces in the cones can balance form a convex cone, so there is one such tilt.
    """
    rng = np.random.default_rng(1)
    limits = 0
    while limits < 40:
        _, scene = random_assembly(rng)
        steepest = float(rng.choice([-1.4, 1.4]))
        stands = ds.check(tilted(scene, 0)).stable
        if not stands or ds.check(tilted(scene, steepest)).stable:
            continue
        held, fell = 0.0, steepest
        while abs(fell - held) > 1e-9:
            middle = (held + fell) / 2
            stands = ds.check(tilted(scene, middle)).stable
            held, fell = (middle, fell) if stands else (held, middle)
        step = math.copysign(1e-6, steepest)
        assert margin(tilted(scene, held)) < 2 * STANDS
        assert margin(tilted(scene, fell + step)) > STANDS
        if abs(held) > abs(step):  # without friction any tilt brings all down
            assert margin(tilted(scene, held - step)) < STANDS
            limits += 1


def tilted(scene: ds.Scene, angle: float) -> ds.Scene:
    """The same scene with gravity turned by `angle`, in radians."""
    data = json.loads(scene.to_json())
    data["gravity"] = [9.81 * math.sin(angle), -9.81 * math.cos(angle)]
    return ds.Scene.from_json(json.dumps(data))


def test_plans_by_program_and_by_contact_problem_are_the_same() -> None:
    rng = np.random.default_rng(15)
    statuses: Counter[str] = Counter()
    for _ in range(100):
        _, scene = random_assembly(rng, most=15)
        lp, lcp, reuse = (ds.plan(scene, test, node_limit=500) for test in ("lp", "lcp", "reuse"))
        for other in (lp, reuse):
            assert (other.found, other.status, other.order) == (lcp.found, lcp.status, lcp.order)
            assert (other.reached, other.falls_next) == (lcp.reached, lcp.falls_next)
        for taken in range(len(lcp.order)):
            assert margin(part(scene, lcp.order[taken:])) < STANDS
        statuses[lcp.status] += 1
    assert statuses["found"] >= 15
    assert statuses["no_order"] >= 5
    assert statuses["whole_falls"] >= 5


def part(scene: ds.Scene, names: tuple[str, ...]) -> ds.Scene:
    """Only the blocks of these `names`, and what is fixed."""
    data = json.loads(scene.to_json())
    data["bodies"] = [b for b in data["bodies"] if b.get("fixed") or b["name"] in names]
    return ds.Scene.from_json(json.dumps(data))


def test_the_margin_of_a_block_on_a_slope_is_known() -> None:
    """The program itself against answers by hand."""
    assert margin(ds.scenes.slope(20, friction=0.4)) < STANDS
    # The force n (-1, 1) / sqrt(2) on ice leaves n / sqrt(2) sideways and 1 - n / sqrt(2) downward
    # of a weight of 1: the larger of the two is least at one half.
    assert margin(ds.scenes.slope(45, friction=0.0, width=9)) == pytest.approx(0.5)
    # In free fall nothing is balanced.
    scene = ds.Scene()
    scene.add_box((0, 5), (1, 1))
    assert margin(scene) == pytest.approx(1.0)
