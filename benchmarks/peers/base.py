"""What a peer is: something that answers a workload and says how long its solver took."""

from __future__ import annotations

import math
import time
from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from importlib import metadata
from typing import ClassVar, Protocol

import drystone as ds
from assembly import Assembly, Floats, Indices, Mask
from steps import Step, Workload


@dataclass(frozen=True, slots=True)
class Answer:
    """One peer's answer to one question."""

    stands: bool | None
    """None: the solver ended without an answer."""
    seconds: float
    """Time of the solver alone: building its matrices and editing its model are left out."""
    iterations: int
    residual: float = math.nan
    """`Assembly.residual` of the forces returned; NaN if there are none (it falls)."""


@dataclass(slots=True)
class Run:
    """One peer's answers to one workload."""

    answers: list[Answer] = field(default_factory=list)
    cut_off: str = ""
    """Why it did not get to the end; empty if it did."""
    extra_seconds: float = 0.0
    """Time counted beyond that of the answers: a set-up that the solver counts as its own."""
    entries: int | None = None
    """Stored numbers of the factor, where the solver says."""

    @property
    def seconds(self) -> float:
        """Total time of the solver."""
        return self.extra_seconds + sum(answer.seconds for answer in self.answers)

    @property
    def iterations(self) -> int:
        """Pivots, or iterations of whatever kind the solver makes."""
        return sum(answer.iterations for answer in self.answers)


class Session(Protocol):
    """A solver that follows one sequence of steps."""

    def answer(self, step: Step) -> Answer:
        """Take the step and answer."""
        ...


class Peer(ABC):
    """A way to answer a workload."""

    name: ClassVar[str]
    """In tables and results."""
    package: ClassVar[str]
    """The Python package that it needs."""

    def version(self) -> str | None:
        """The version of its package, None if that is not installed."""
        try:
            return metadata.version(self.package)
        except metadata.PackageNotFoundError:
            return None

    def refuses(self, assembly: Assembly, workload: Workload) -> str:
        """Why it cannot answer this workload at all; empty if it can."""
        return ""

    @abstractmethod
    def open(self, assembly: Assembly, cap: float) -> Session:
        """A session with no block present. `cap` bounds the seconds of any one solve."""

    def run(self, scene: ds.Scene, assembly: Assembly, workload: Workload, cap: float) -> Run:
        """Answer question by question, until done or `cap` seconds are spent.

        The cap bounds the solver's time, and five times the cap bounds the wall time with the
        building of matrices in it.
        """
        return self.follow(self.open(assembly, cap), workload, cap)

    def follow(self, session: Session, workload: Workload, cap: float) -> Run:
        """Take a session through the steps."""
        run = Run()
        spent = 0.0
        begin = time.perf_counter()
        for step in workload.steps:
            if spent > cap or time.perf_counter() - begin > 5 * cap:
                run.cut_off = f"> {cap:g} s at {len(run.answers)} questions"
                break
            answer = session.answer(step)
            spent += answer.seconds
            run.answers.append(answer)
        return run


class Present:
    """The blocks present, and the columns and rows that a sub-assembly keeps of the whole."""

    def __init__(self, assembly: Assembly) -> None:
        self.assembly = assembly
        self.mask: Mask = assembly.nobody()

    def take(self, step: Step) -> None:
        """Change what is present."""
        self.mask[list(step.removed)] = False
        self.mask[list(step.added)] = True

    @property
    def generators(self) -> Indices:
        """Generators between bodies that are present or fixed."""
        return self.assembly.generators(self.mask)

    @property
    def rows(self) -> Indices:
        """Rows of the bodies present, ascending."""
        return self.mask[:-1].repeat(3).nonzero()[0]

    def residual(self, generators: Indices, forces: Floats) -> float:
        """Of the forces (N) of some generators."""
        return self.assembly.residual(self.mask, generators, forces)
