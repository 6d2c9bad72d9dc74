"""Ctrl-C reaches inside every long call within half a second, and leaves what it stopped usable."""

from __future__ import annotations

import json
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest

import drystone as ds
from drystone import lcp

WAIT = 0.5
"""Seconds: the most between Ctrl-C and its effect."""
PATIENCE = 3.0
"""How many times longer a busy machine may take."""
AFTER = 0.15
"""Seconds of work before Ctrl-C: the calls below take many times longer."""


@contextmanager
def ctrl_c(after: float = AFTER) -> Iterator[None]:
    """Sends the main thread an interrupt, and measures the wait for its effect."""
    sent: list[float] = []

    def send() -> None:
        sent.append(time.monotonic())
        signal.raise_signal(signal.SIGINT)

    timer = threading.Timer(after, send)
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()
    assert sent, "the work ended before it could be interrupted"
    waited = time.monotonic() - sent[0]
    assert waited < WAIT * PATIENCE, f"{waited:.2f} s until Ctrl-C had an effect"


def interrupted(call: Callable[[], Any], after: float = AFTER) -> None:
    with ctrl_c(after), pytest.raises(KeyboardInterrupt):
        call()


def semidefinite(n: int, rank: int, seed: int = 0) -> tuple[Any, Any]:
    random = np.random.default_rng(seed)
    half = random.standard_normal((rank, n))
    return half.T @ half / n, half.T @ random.standard_normal(rank)


def leaning(rows: int, columns: int) -> ds.Scene:
    """A wall of bricks in space under sideways gravity, which takes long to judge."""
    scene = json.loads(ds.scenes.brick_wall(rows, columns).to_json())
    scene["gravity"] = [0.5 * 9.81, 0.1, -9.81]
    return ds.Scene.from_json(json.dumps(scene))


@pytest.mark.parametrize("method", ["dantzig", "lemke"])
def test_a_complementarity_problem(method: str) -> None:
    M, q = semidefinite(1200, 900)
    interrupted(lambda: lcp.solve(M, q, method=method), after=0.5)


def test_a_solver_keeps_its_rows_and_its_vector() -> None:
    M, q = semidefinite(900, 700)
    solver = lcp.Solver(M, q)
    solver.add_rows(range(900))
    interrupted(solver.solve)
    assert list(solver.rows) == list(range(900))
    solver.remove_rows(range(200, 900))
    answer = solver.solve()
    assert answer.status == "solved"
    np.testing.assert_allclose(answer.w[:200], lcp.solve(M[:200, :200], q[:200]).w, atol=1e-7)


@pytest.mark.parametrize("method", ["equilibrium", "lcp"])
def test_a_check(method: str) -> None:
    scene = leaning(24, 24)
    interrupted(lambda: ds.check(scene, method=method), after=0.4)


def test_a_structure_has_the_blocks_that_it_had() -> None:
    scene = leaning(20, 20)
    names = [body.name for body in scene.bodies if not body.fixed]
    structure = ds.Structure(scene)
    structure.add(*names)
    interrupted(structure.check, after=0.3)
    assert structure.blocks == tuple(names)
    structure.remove(*names[1:])
    assert structure.stands() == ds.check(scene, blocks=names[:1]).stable


def test_a_step_leaves_the_world_as_it_was_before_it() -> None:
    scene = leaning(12, 12)
    world, other = ds.World(scene), ds.World(scene)
    hashed = world.state_hash()
    interrupted(world.step, after=0.3)
    assert (world.steps, world.state_hash()) == (0, hashed)
    assert np.array_equal(world.poses, other.poses)
    assert np.array_equal(world.velocities, other.velocities)


def test_a_run_hands_back_the_steps_that_were_made() -> None:
    with ctrl_c():
        run = ds.simulate(leaning(12, 12), steps=1000)
    assert run.status == "interrupted"


def test_a_plan_hands_back_the_best_so_far() -> None:
    with ctrl_c(0.3):
        plan = ds.plan(ds.scenes.brick_wall(40, 40))
    assert plan.status == "interrupted"
    assert not plan.found


@pytest.mark.parametrize("test", ["reuse", "lcp"])
def test_the_time_of_a_plan_is_the_limit_of_all_that_it_does(test: str) -> None:
    scene = leaning(30, 30)
    begun = time.monotonic()
    plan = ds.plan(scene, test=test, time_limit=0.2)
    assert time.monotonic() - begun < 0.2 + WAIT * PATIENCE
    assert plan.status == "time_limit"


def test_scenes_being_made_read_and_looked_at() -> None:
    interrupted(lambda: ds.scenes.random_stack(1000))
    scene = ds.scenes.wall(300, 300)
    interrupted(lambda: [scene.to_json() for _ in range(20)])
    interrupted(lambda: [scene.contacts for _ in range(20)])
    text = scene.to_json()
    interrupted(lambda: [ds.Scene.from_json(text) for _ in range(20)])


def test_what_a_handler_raises_is_what_comes_out() -> None:
    class AlarmError(Exception):
        pass

    def ring(*_: object) -> None:
        raise AlarmError

    scene = ds.scenes.brick_wall(40, 40)
    before = signal.signal(signal.SIGALRM, ring)
    try:
        for call in (lambda: ds.check(scene), lambda: ds.plan(scene), lambda: ds.simulate(scene)):
            signal.setitimer(signal.ITIMER_REAL, 0.2)
            with pytest.raises(AlarmError):
                call()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
