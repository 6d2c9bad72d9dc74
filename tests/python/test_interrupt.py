"""Ctrl-C reaches inside every long call within half a second, and leaves what it stopped usable."""

from __future__ import annotations

import json
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import repeat
from typing import Any

import numpy as np
import pytest

import drystone as ds
from drystone import lcp
from drystone.paper import motion, table

WAIT = 0.5
"""Seconds: the most between Ctrl-C and its effect."""
PATIENCE = 3.0
"""How many times longer a slow machine may take."""
SOON = 0.1
"""Seconds of work before Ctrl-C. None of the calls below ends within many times that."""


@dataclass(frozen=True)
class Since:
    """How long something takes, other programs on the machine not counted."""

    wall: float = field(default_factory=time.monotonic)
    processor: float = field(default_factory=time.process_time)

    def seconds(self) -> float:
        """The processor's time on all threads, or the clock's where that is less."""
        return min(time.monotonic() - self.wall, time.process_time() - self.processor)


class CtrlC:
    """Sends the main thread an interrupt, once, some time after it is asked to."""

    sent: Since | None = None

    def __init__(self, after: float) -> None:
        self._timer = threading.Timer(after, self._send)

    def _send(self) -> None:
        self.sent = Since()
        signal.raise_signal(signal.SIGINT)

    def soon(self, *_: object) -> None:
        """Also the `progress` of a call: then it is sent from within the work."""
        if self._timer.ident is None:
            self._timer.start()

    def end(self) -> None:
        self._timer.cancel()
        if self._timer.ident is not None:
            self._timer.join()


@contextmanager
def ctrl_c(after: float = SOON) -> Iterator[CtrlC]:
    """An interrupt to be sent, with a limit on the wait for its effect."""
    interrupt = CtrlC(after)
    try:
        yield interrupt
    finally:
        interrupt.end()
    assert interrupt.sent is not None, "the work ended before it could be interrupted"
    waited = interrupt.sent.seconds()
    assert waited < WAIT * PATIENCE, f"{waited:.2f} s until Ctrl-C had an effect"


def interrupted(call: Callable[[], Any], after: float = SOON) -> None:
    with ctrl_c(after) as interrupt:

        def begun() -> None:
            interrupt.soon()
            call()

        with pytest.raises(KeyboardInterrupt):
            begun()


def endlessly(call: Callable[[], Any]) -> None:
    """For what is over soon: the interrupt meets one of many calls."""
    for _ in repeat(None):
        call()


def full(n: int) -> tuple[Any, Any]:
    """A dense problem that takes some n pivots, and so seconds."""
    random = np.random.default_rng(0)
    half = random.standard_normal((n, n))
    return half.T @ half / n, -np.abs(random.standard_normal(n))


def leaning(rows: int, columns: int, k: float = 0.5) -> ds.Scene:
    """A wall of bricks in space under sideways gravity, k g, which takes long to judge."""
    scene = json.loads(ds.scenes.brick_wall(rows, columns).to_json())
    scene["gravity"] = [k * 9.81, 0.1, -9.81]
    return ds.Scene.from_json(json.dumps(scene))


@pytest.mark.parametrize(
    ("method", "after"),
    [
        pytest.param("dantzig", SOON, id="while M is checked"),
        pytest.param("lemke", 10 * SOON, id="between pivots"),
    ],
)
def test_a_complementarity_problem(method: str, after: float) -> None:
    M, q = full(2000)
    interrupted(lambda: lcp.solve(M, q, method=method), after)


def test_a_solver_keeps_its_rows_and_its_vector() -> None:
    M, q = full(2000)
    solver = lcp.Solver(M, q)
    solver.add_rows(range(2000))
    interrupted(solver.solve)
    assert list(solver.rows) == list(range(2000))
    solver.remove_rows(range(200, 2000))
    answer = solver.solve()
    assert answer.status == "solved"
    np.testing.assert_allclose(answer.w[:200], lcp.solve(M[:200, :200], q[:200]).w, atol=1e-7)


def test_a_table_of_the_paper() -> None:
    """What was cut short has done less work, which no table may show."""
    long = table.Example("Column 400", lambda: ds.scenes.column(400), {})
    interrupted(lambda: table.measure(examples=[long]))


def test_motions_of_the_paper(monkeypatch: pytest.MonkeyPatch) -> None:
    long = motion.Motion("Column", lambda: ds.scenes.column(10), 1_000_000, "")
    monkeypatch.setattr(motion, "MOTIONS", [long])
    monkeypatch.setattr(motion, "REPEATS", 1)
    interrupted(motion.measure_motions)


@pytest.mark.parametrize("method", ["equilibrium", "lcp"])
def test_a_check(method: str) -> None:
    scene = leaning(30, 30)
    interrupted(lambda: ds.check(scene, method=method))


def test_whether_it_must_stand() -> None:
    scene = ds.scenes.wall(rows=4, columns=4, friction=0.5).with_gravity((1.7, -9.66))
    interrupted(lambda: ds.check(scene, strong=True))


def test_a_structure_has_the_blocks_that_it_had() -> None:
    scene = leaning(30, 30)
    names = [body.name for body in scene.bodies if not body.fixed]
    structure = ds.Structure(scene)
    structure.add(*names)
    interrupted(structure.check)
    assert structure.blocks == tuple(names)
    structure.remove(*names[1:])
    assert structure.stands() == ds.check(scene, blocks=names[:1]).stable


def test_the_step_of_one_block_that_proves_long_lets_others_in() -> None:
    # A wall under sideways gravity falls until the plinth comes on which all of it stands.
    wall = json.loads(ds.scenes.wall(80, columns=80, friction=0.5).to_json())
    wall["gravity"] = [0.35 * 9.81, -9.81]
    plinth = next(body for body in wall["bodies"] if body["fixed"])
    below = plinth["position"][1] - plinth["box"]["size"][1]
    wall["bodies"].append({**plinth, "name": "earth", "position": [plinth["position"][0], below]})
    plinth["fixed"] = False
    scene = ds.Scene.from_json(json.dumps(wall))
    names = [body.name for body in scene.bodies if not body.fixed and body.name != plinth["name"]]
    structure = ds.Structure(scene, blocks=names)
    assert not structure.stands()
    structure.add(plinth["name"])
    # Another thread asks for the interrupt: kept out until the step is over, it would be too late.
    with ctrl_c() as interrupt:
        other = threading.Timer(SOON / 2, interrupt.soon)
        other.start()
        with pytest.raises(KeyboardInterrupt):
            structure.stands()
        other.join()
    assert set(structure.blocks) == {*names, plinth["name"]}


def test_a_step_leaves_the_world_as_it_was_before_it() -> None:
    scene = leaning(30, 30)
    world, other = ds.World(scene), ds.World(scene)
    hashed = world.state_hash()
    interrupted(world.step)
    assert (world.steps, world.state_hash()) == (0, hashed)
    assert np.array_equal(world.poses, other.poses)
    assert np.array_equal(world.velocities, other.velocities)


@pytest.mark.parametrize("after", [SOON, 5 * SOON])
def test_the_first_step_of_what_falls_at_once(after: float) -> None:
    scene = leaning(12, 12, k=1.5)
    interrupted(lambda: endlessly(lambda: ds.World(scene).step()), after)


def test_a_run_is_left_within_a_step() -> None:
    world = ds.World(leaning(30, 30))
    assert world.run(0).status == "finished"
    with ctrl_c() as interrupt:
        interrupt.soon()
        run = world.run(1000)
    assert (run.status, run.steps) == ("interrupted", 0)


def test_a_run_hands_back_the_steps_that_were_made() -> None:
    with ctrl_c() as interrupt:
        run = ds.simulate(ds.scenes.wall84(), steps=100_000, reuse="none", progress=interrupt.soon)
    assert run.status == "interrupted"
    assert 0 < run.steps < 100_000


def test_a_plan_hands_back_the_best_so_far() -> None:
    scene = ds.scenes.column(2000)
    with ctrl_c() as interrupt:
        plan = ds.plan(scene, test="lp", shortcuts=False, progress=interrupt.soon)
    assert plan.status == "interrupted"
    assert not plan.found
    assert plan.tests > 0


@pytest.mark.parametrize("test", ["reuse", "lcp"])
def test_the_time_of_a_plan_is_the_limit_of_all_that_it_does(test: str) -> None:
    scene = leaning(30, 30)
    begun = Since()
    plan = ds.plan(scene, test=test, time_limit=0.2)
    assert begun.seconds() < 0.2 + WAIT * PATIENCE
    assert plan.status == "time_limit"


def test_scenes_being_made_read_and_looked_at() -> None:
    interrupted(lambda: endlessly(lambda: ds.scenes.random_stack(1000)))
    scene = ds.scenes.wall(300, 300)
    interrupted(lambda: endlessly(scene.to_json))
    interrupted(lambda: endlessly(lambda: scene.contacts))
    text = scene.to_json()
    interrupted(lambda: endlessly(lambda: ds.Scene.from_json(text)))


def test_what_a_handler_raises_is_what_comes_out() -> None:
    class AlarmError(Exception):
        pass

    def ring(*_: object) -> None:
        raise AlarmError

    scene = ds.scenes.brick_wall(40, 40)

    def alarmed(call: Callable[[ds.Scene], Any]) -> None:
        signal.setitimer(signal.ITIMER_REAL, SOON)
        call(scene)

    before = signal.signal(signal.SIGALRM, ring)
    try:
        for call in (lambda scene: ds.check(scene, method="lcp"), ds.plan, ds.simulate):
            with pytest.raises(AlarmError):
                alarmed(call)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
