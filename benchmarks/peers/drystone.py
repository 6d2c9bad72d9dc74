"""drystone: the contact problem from scratch, and with two kinds of reuse.

Reuse is asked as any other peer, step by step, of a live structure. The two that answer only inside
the planner, from scratch and the paper's reuse, are offered just the questions that the planner
asks (`Workload.planned`).

Timed: everything, by clocks of its own. The analysis of the complete assembly is in it, and so are
the edits of the problem at each step, which the other peers are spared.
"""

from __future__ import annotations

from typing import ClassVar

import drystone as ds
from assembly import Assembly
from drystone import _core
from peers.base import Answer, Peer, Run, Session
from steps import Step, Workload


class LiveSession:
    """A structure that follows the steps."""

    def __init__(self, scene: ds.Scene) -> None:
        self.structure = _core.Structure(scene._core)

    def answer(self, step: Step) -> Answer:
        """The forces stay inside, unless they are asked for."""
        return Answer(*self.structure.step(list(step.removed), list(step.added)))


class Reuse(Peer):
    """The forces of the last sub-assembly, on a kept basis of the generators."""

    name = "drystone reuse"
    package = "drystone"

    def open(self, assembly: Assembly, cap: float) -> Session:
        """See `run`: the scene is needed."""
        raise NotImplementedError("a structure is made of a scene")

    def run(self, scene: ds.Scene, assembly: Assembly, workload: Workload, cap: float) -> Run:
        """Step by step; then all forces of the last sub-assembly, with their residual."""
        session = LiveSession(scene)
        run = self.follow(session, workload, cap)
        run.extra_seconds = session.structure.set_up_seconds
        run.entries = session.structure.entries()
        verdict = session.structure.check()
        if run.answers and run.answers[-1].stands:
            last = run.answers[-1]
            run.answers[-1] = Answer(
                last.stands, last.seconds + verdict.seconds, last.iterations, verdict.residual
            )
        return run


class Planner(Peer):
    """One of the planner's own tests."""

    package = "drystone"
    test: ClassVar[str]

    def refuses(self, assembly: Assembly, workload: Workload) -> str:
        """Whatever the planner does not ask."""
        return "" if workload.planned else "answers only what its planner asks"

    def open(self, assembly: Assembly, cap: float) -> Session:
        """None yet: see `run`."""
        raise NotImplementedError("the planner answers all questions in one call")

    def run(self, scene: ds.Scene, assembly: Assembly, workload: Workload, cap: float) -> Run:
        """Plan. The forces stay inside the planner, which refuses residuals above 1e-9.

        As for every peer, five times the cap bounds the wall time: here with the check of the whole
        assembly in it, which comes before the questions.
        """
        plan = _core.plan(
            scene._core,
            self.test,
            len(workload.steps),
            5 * cap,
            shortcuts=False,
            threads=1,
        )
        run = Run()
        spent = 0.0
        for record in plan.records:
            if spent > cap:
                break
            run.answers.append(Answer(record.stable, record.seconds, record.pivots))
            spent += record.seconds
        if len(run.answers) < len(workload.steps):
            run.cut_off = f"> {cap:g} s at {len(run.answers)} questions"
        else:
            run.extra_seconds = plan.test_seconds - spent
        return run


class Lcp(Planner):
    """Dantzig's method from scratch for every question."""

    name = "drystone lcp"
    test = "lcp"


class ReuseDantzig(Planner):
    """Dantzig's method from the solution of the sub-assembly it grew from, as in the paper."""

    name = "drystone reuse-dantzig"
    test = "reuse-dantzig"
