"""drystone: the contact problem from scratch, and with the two kinds of reuse.

So far it answers a workload only inside its own planner, so it offers just the questions that the
planner asks (`Workload.planned`). A session that takes arbitrary steps goes here, as `open`.

Timed: `Plan.test_seconds`, the planner's own clock. The analysis of the complete assembly is in it,
and so are the edits of the problem at each step, which the other peers are spared.
"""

from __future__ import annotations

from typing import ClassVar

import drystone as ds
from assembly import Assembly
from drystone import _core
from peers.base import Answer, Peer, Run, Session
from steps import Workload


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
        plan = _core.plan(scene._core, self.test, len(workload.steps), 5 * cap)
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


class Reuse(Planner):
    """The forces of the sub-assembly it grew from, on a kept basis of the generators."""

    name = "drystone reuse"
    test = "reuse"
