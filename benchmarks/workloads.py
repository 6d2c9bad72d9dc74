"""The sequences of questions measured. Every peer answers the same steps."""

from __future__ import annotations

import random
from collections.abc import Callable

import drystone as ds
from assembly import Assembly
from drystone import _core
from peers.highs import WarmSession
from steps import Step, Workload


def add_in_order(scene: ds.Scene, assembly: Assembly, plan: ds.Plan) -> Workload:
    """The planner's own questions: it grows the assembly block by block from the supports upward.

    A block with which something falls is taken off again. If the whole assembly falls, the planner
    asks nothing; then the blocks are put on by height, whatever the answers. If the paper's search
    asks too much to be repeated, they are put on in the order that was planned.
    """
    if plan.status == "whole_falls":
        steps = tuple(Step((), (body,)) for body in _upward(scene, assembly)[:-1])
        return Workload("add", steps, planned=False, note="the whole assembly falls")
    ended, asked = _questions(scene)
    if plan.found and ended == "test_limit":
        one_by_one = tuple(Step((), (body,)) for body in _planned(assembly, plan)[:0:-1])
        note = f"as planned: the paper's search asks more than {len(asked)}"
        return Workload("add", one_by_one, planned=False, note=note)
    questions: list[Step] = []
    present: set[int] = set()
    for bodies, added in asked:
        parent = bodies - {added}
        questions.append(Step(tuple(sorted(present - parent)), tuple(sorted(bodies - present))))
        present = bodies
    note = "" if plan.found else f"the planner ended with {plan.status}"
    return Workload("add", tuple(questions), planned=True, note=note)


def remove_in_order(scene: ds.Scene, assembly: Assembly, plan: ds.Plan) -> Workload:
    """The complete assembly, then one block less at every step, in the order that was planned.

    Without a plan the highest block goes first.
    """
    order = _planned(assembly, plan) or _upward(scene, assembly)[::-1]
    steps = [Step((), tuple(range(len(assembly))))]
    steps += [Step((body,), ()) for body in order[:-1]]
    return Workload("remove", tuple(steps), planned=False)


def random_with_backtracking(
    scene: ds.Scene, assembly: Assembly, plan: ds.Plan, seed: int = 1, most: int = 2000
) -> Workload:
    """Grows by a random block that touches what is there, and steps back now and then.

    A block with which something falls is taken off again; so are the last one to three blocks at
    one step in five. It ends when one block is missing, or after two questions a block, at most
    `most`. HiGHS says what falls.
    """
    draw = random.Random(seed)
    neighbours = _neighbours(assembly)
    oracle = WarmSession(assembly, "primal", cap=float("inf"))
    placed: list[int] = []
    steps: list[Step] = []
    taken_off: list[int] = []
    while len(placed) < len(assembly) - 1 and len(steps) < min(2 * len(assembly), most):
        present = {-1, *placed}
        candidates = [
            body
            for body in range(len(assembly))
            if body not in present and not present.isdisjoint(neighbours[body])
        ]
        # The last question is not asked again, unless nothing else is left.
        added = draw.choice([c for c in candidates if c not in taken_off] or candidates)
        step = Step(tuple(taken_off), (added,))
        steps.append(step)
        placed.append(added)
        taken_off = []
        if not oracle.answer(step).stands:
            taken_off.append(placed.pop())
        if draw.random() < 0.2:
            for _ in range(min(draw.randint(1, 3), len(placed))):
                taken_off.append(placed.pop())
    return Workload("random", tuple(steps), planned=False)


WORKLOADS: dict[str, Callable[[ds.Scene, Assembly, ds.Plan], Workload]] = {
    "add": add_in_order,
    "remove": remove_in_order,
    "random": random_with_backtracking,
}


def _planned(assembly: Assembly, plan: ds.Plan) -> list[int]:
    """The order that was planned, the first to leave first; empty if there is none."""
    index = {name: i for i, name in enumerate(assembly.names)}
    return [index[name] for name in plan.order]


def _questions(scene: ds.Scene, most: int = 5000) -> tuple[str, list[tuple[set[int], int]]]:
    """How the paper's search ends, without shortcuts, and its (bodies, body added last)."""
    asked: list[tuple[set[int], int]] = []
    structure = ds.Structure(scene)._core
    present: set[int] = set()

    def listen(bodies: list[int], added: int) -> tuple[bool, int]:
        nonlocal present
        now = set(bodies)
        asked.append((now, added))
        stands, _, pivots = structure.step(sorted(present - now), sorted(now - present))
        present = now
        return stands, pivots

    plan = _core.plan(scene._core, listen, node_limit=most, shortcuts=False)
    return plan.status, asked


def _upward(scene: ds.Scene, assembly: Assembly) -> list[int]:
    """Bodies by the height of their centroid, the lower index first among equals."""
    heights = {body.name: body.centroid[1] for body in scene.bodies}
    return sorted(range(len(assembly)), key=lambda i: (round(heights[assembly.names[i]], 9), i))


def _neighbours(assembly: Assembly) -> list[set[int]]:
    """For each body the bodies that it touches, -1 for a fixed one."""
    lists: list[set[int]] = [set() for _ in range(len(assembly))]
    for a, b in assembly.bodies.tolist():
        if a >= 0:
            lists[a].add(b)
        if b >= 0:
            lists[b].add(a)
    return lists
