"""Copies go on as the first does, bit for bit, and leave it alone; arrays are read-only."""

from __future__ import annotations

import copy
import pickle
import threading
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import pytest

import drystone as ds
from drystone import _core

WAYS: dict[str, Callable[[Any], Any]] = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda thing: pickle.loads(pickle.dumps(thing)),
}
way = pytest.mark.parametrize("make", WAYS.values(), ids=WAYS)


def _same(a: Any, b: Any) -> bool:
    """Equal to the bit, whatever it is made of; times apart."""
    if isinstance(a, ds.Scene):
        return bool(a.to_json() == b.to_json())
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and np.array_equal(a, b)
    if is_dataclass(a):
        names = [f.name for f in fields(a) if "seconds" not in f.name]
        return type(a) is type(b) and all(_same(getattr(a, n), getattr(b, n)) for n in names)
    if isinstance(a, tuple | list):
        return len(a) == len(b) and all(map(_same, a, b))
    return bool(a == b)


@way
@pytest.mark.parametrize("space", [False, True])
@pytest.mark.parametrize("reuse", ["full", "motionless", "none"])
def test_worlds(make: Callable[[Any], Any], space: bool, reuse: str) -> None:
    scene = ds.scenes.fall7()
    world = ds.World(scene.extruded() if space else scene, reuse=reuse, restitution=0.25)
    world.run(20)
    world.apply_force("3", (5, 0, 0)[: world.dimension])
    twin = make(world)
    before = world.state_hash()
    gone = twin.run(40)
    assert (world.steps, world.state_hash()) == (20, before)
    assert _same(world.run(40), gone)
    assert world.snapshot() == twin.snapshot()


@way
@pytest.mark.parametrize(
    "scene",
    [ds.scenes.arch(15), ds.scenes.wall(6, 6), ds.scenes.square_pyramid(3)],
    ids=["arch", "wall", "pyramid"],
)
def test_structures(make: Callable[[Any], Any], scene: ds.Scene) -> None:
    names = [body.name for body in scene.bodies if not body.fixed]
    structure = ds.Structure(scene, names[::2], facets=5, cone="circumscribed")
    structure.stands()
    structure.add(*names[1::4])
    twin = make(structure)

    def go_on(one: ds.Structure) -> list[Any]:
        answers = []
        for block in names[::3]:
            one.remove(block)
            answers += [one.stands(), one.check(), one.pivots, one.entries]
        one.add(*names)
        return [*answers, one.check(), one.blocks]

    there = structure.blocks
    gone = go_on(twin)
    assert structure.blocks == there
    assert _same(go_on(structure), gone)


@way
@pytest.mark.parametrize("generators", [False, True])
def test_solvers(make: Callable[[Any], Any], generators: bool) -> None:
    rng = np.random.default_rng(5)
    G = rng.normal(size=(20, 60))
    if generators:
        solver = ds.lcp.Solver.from_generators(G, rng.random(20), rng.normal(size=20), 500)
    else:
        solver = ds.lcp.Solver(G.T @ G, rng.normal(size=60), pivot_limit=500)
    solver.add_rows(range(0, 60, 2))
    solver.solve()
    solver.add_rows([1, 3])
    twin = make(solver)

    def go_on(one: ds.lcp.Solver) -> list[Any]:
        one.remove_rows([0, 4])
        first = one.solve()
        one.set_q(one.q * 1.25)
        one.add_rows(range(30))
        return [first, one.solve(), one.rows, one.q, one.counts, len(one)]

    rows = solver.rows
    gone = go_on(twin)
    assert np.array_equal(solver.rows, rows)
    assert _same(go_on(solver), gone)


def test_states_of_a_solver_and_its_copies() -> None:
    solver = ds.lcp.Solver(np.eye(3), [-1.0, -2.0, -3.0])
    solver.add_rows([0, 1])
    solver.solve()
    both = {"solver": solver, "state": solver.snapshot()}
    twins = copy.deepcopy(both)
    twins["solver"].remove_rows([0, 1])
    twins["solver"].restore(twins["state"])
    assert list(twins["solver"].rows) == [0, 1]
    with pytest.raises(ds.LcpError, match="another solver"):
        pickle.loads(pickle.dumps(solver)).restore(both["state"])


@way
def test_scenes_and_answers(make: Callable[[Any], Any]) -> None:
    scene = ds.scenes.wall(3, 3)
    things = [
        scene,
        scene.extruded(),
        ds.check(scene),
        ds.plan(scene),
        ds.plan(ds.scenes.arch(5)),
        ds.simulate(scene, steps=3, forces=True),
        ds.World(scene).step(),
        ds.lcp.solve(np.eye(2), [-1.0, 1.0]),
        scene.body("1"),
        scene.extruded().body("1"),
    ]
    for thing in things:
        twin = make(thing)
        assert type(twin) is type(thing)
        assert _same(thing, twin)
        if hasattr(twin, "to_dict"):
            assert twin.to_dict() == thing.to_dict()
        own = thing if isinstance(thing, ds.Scene) else getattr(thing, "scene", None)
        if own is not None:
            other = twin if isinstance(twin, ds.Scene) else twin.scene
            count = len(own)
            other.add_box((50, 50, 50)[: other.dimension], (1, 1, 1)[: other.dimension])
            assert len(own) == count
            assert len(other) == count + 1


def test_an_answer_keeps_the_scene_it_is_about() -> None:
    scene = ds.scenes.column(3)
    count = len(scene)
    structure = ds.Structure(scene)
    world = ds.World(scene)
    answers = [ds.check(scene), ds.plan(scene), ds.simulate(scene, steps=1), structure.check()]
    scene.add_box((9, 0.5), (1, 1))
    answers[-1].scene.add_box((19, 0.5), (1, 1))
    assert [len(answer.scene) for answer in answers[:3]] == [count] * 3
    assert (len(structure.check().scene), len(world.scene)) == (count, count)


def test_pickles_of_a_structure_are_checked() -> None:
    structure = ds.Structure(ds.scenes.column(3), ["1"])
    again, (scene, cones, state) = structure.__reduce__()[:2]
    assert again(scene, cones, state).blocks == ("1",)
    damaged = bytes([*state[:40], state[40] ^ 1, *state[41:]])
    for bad, where in ((damaged, scene), (b"", scene), (state, ds.scenes.column(4))):
        with pytest.raises(ds.DrystoneError, match="structure"):
            again(where, cones, bad)


def test_arrays_are_read_only() -> None:
    scene, world = ds.scenes.column(3), ds.World(ds.scenes.column(3))
    step, run = world.step(), world.run(2, forces=True)
    solver = ds.lcp.Solver(np.eye(2), [-1.0, 1.0])
    solver.add_rows([0, 1])
    arrays = {
        "poses": world.poses,
        "velocities": world.velocities,
        "still": world.motionless,
        "rows": solver.rows,
        "q": solver.q,
        "vertices": scene.body("1").vertices,
        "solid": scene.extruded().body("1").vertices,
        "inertia": scene.extruded().body("1").inertia,
        "piece": scene.extruded().body("1").pieces[0].vertices,
        "accelerations": ds.check(scene).accelerations,
        "step": step.motionless,
        "z": solver.solve().z,
        "w": ds.lcp.solve(np.eye(2), [-1.0, 1.0]).w,
        **{f.name: getattr(run, f.name) for f in fields(run)},
    }
    for name, array in arrays.items():
        if isinstance(array, np.ndarray):
            assert not array.flags.writeable, name
            with pytest.raises(ValueError, match="read-only"):
                array[...] = 0


def test_generators_are_the_callers() -> None:
    """They are made for each call: solvers that want memory to write on take them as they are."""
    scene = ds.scenes.column(3)
    found = _core.generators(scene._core)
    assert found.data.flags.writeable
    assert found.applied.flags.writeable
    found.data[:] = 0.0
    assert _core.generators(scene._core).data.any()
    assert ds.check(scene).stable


class _Meeting:
    """Lets another thread look at an object in the middle of a call."""

    def __init__(self, look: Callable[[], object]) -> None:
        self.look = look
        self.errors: list[BaseException] = []

    def __call__(self, *_: object) -> None:
        thread = threading.Thread(target=self._look)
        thread.start()
        thread.join()

    def _look(self) -> None:
        try:
            self.look()
        except BaseException as error:
            self.errors.append(error)


def test_two_threads_in_one_world() -> None:
    """The one that comes second is told; the first one's steps are those of a world of its own."""
    scene = ds.scenes.wall84()
    world, alone = (ds.World(scene, reuse="none") for _ in range(2))
    steps = 8
    looks = [
        lambda: world.poses,
        world.step,
        lambda: world.apply_impulse("3", (1, 0)),
        world.snapshot,
        lambda: world.remove("3"),
    ]
    meetings = [_Meeting(look) for look in looks]

    def meet(*_: object) -> None:
        for meeting in meetings:
            meeting()

    run = world.run(steps, progress=meet)
    for meeting in meetings:
        assert meeting.errors
        assert all(isinstance(error, ds.BusyError) for error in meeting.errors)
        assert "World" in str(meeting.errors[0])
    assert np.array_equal(run.poses, alone.run(steps).poses)


def test_a_callback_that_uses_its_own_world() -> None:
    world = ds.World(ds.scenes.wall84(), reuse="none")
    with pytest.raises(ds.BusyError, match="in use by another call"):
        world.run(8, progress=lambda *_: world.step())


def test_a_scene_may_change_while_it_is_planned() -> None:
    """The plan is of the scene as it was when it was asked for."""
    scene = ds.scenes.random_stack(60, seed=3, friction=0.5)
    wanted = ds.plan(scene, "lcp", shortcuts=False)
    adding = _Meeting(lambda: scene.add_box((500.0 + len(scene), 0.5), (1, 1)))
    found = ds.plan(scene, "lcp", shortcuts=False, progress=adding)
    assert adding.errors == []
    assert (found.order, len(found.scene)) == (wanted.order, len(wanted.scene))


def test_threads_that_hammer_on_one_object() -> None:
    """Whatever the interleaving: an answer or a BusyError, and nothing else."""
    structure = ds.Structure(ds.scenes.wall(8, 8))
    blocks = [body.name for body in structure.check().scene.bodies if not body.fixed]
    rng = np.random.default_rng(2)
    G = rng.normal(size=(60, 120))
    solver = ds.lcp.Solver(G.T @ G, rng.normal(size=120))
    answers, errors = [0], []

    def hammer(seed: int) -> None:
        rng = np.random.default_rng(seed)
        for _ in range(60):
            calls = [
                lambda block: structure.add(blocks[block % len(blocks)]),
                lambda _: structure.check(),
                lambda _: copy.copy(structure).stands(),
                lambda row: solver.add_rows([row % 120]),
                lambda _: solver.solve(),
                lambda _: pickle.dumps(solver),
            ]
            try:
                calls[rng.integers(len(calls))](int(rng.integers(1000)))
                answers[0] += 1
            except ds.BusyError:
                pass
            except BaseException as error:
                errors.append(error)

    threads = [threading.Thread(target=hammer, args=(seed,)) for seed in range(4)]
    [thread.start() for thread in threads]  # type: ignore[func-returns-value]
    [thread.join() for thread in threads]  # type: ignore[func-returns-value]
    assert errors == []
    assert answers[0] > 0
