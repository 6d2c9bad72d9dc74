"""Times every peer on one workload, in turns, and judges every answer."""

from __future__ import annotations

import gc
import math
import statistics
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import drystone as ds
from assembly import Assembly
from peers import Peer, Run
from steps import Workload

ROUNDS = 7
"""Most repetitions."""

REPEAT_WITHIN = 5.0
"""Seconds of solver time: a peer is repeated while its repetitions together take less."""

ACCURATE = 1e-9
"""`Assembly.residual` that an answer "it stands" should not exceed."""


@dataclass(slots=True)
class Measured:
    """One peer on one workload. Answers are judged in the first round."""

    peer: str
    version: str
    queries: int
    refused: str = ""
    """Why it was not run: it cannot, or its package is missing."""
    cut_off: str = ""
    times: list[float] = field(default_factory=list)
    """Seconds of each round."""
    answered: int = 0
    missing: int = 0
    """Questions without an answer: an error, no convergence, or not reached."""
    checked: int = 0
    """Answers compared with the reference."""
    wrong: int = 0
    residual: float = math.nan
    """Largest of the answers "it stands", NaN if no forces are returned."""
    inaccurate: int = 0
    """Answers "it stands" whose residual exceeds 1e-9."""
    iterations: int = 0
    entries: int | None = None
    memory: float = math.nan
    """MB."""

    @property
    def seconds(self) -> float:
        """Median of the rounds."""
        return statistics.median(self.times) if self.times else math.nan

    @property
    def least(self) -> float:
        """Least of the rounds: what other work on the machine disturbed least."""
        return min(self.times, default=math.nan)

    @property
    def right(self) -> bool:
        """Whether it answered everything and nothing is known to be wrong."""
        return not (self.refused or self.cut_off or self.missing or self.wrong)


def measure(
    scene: ds.Scene,
    assembly: Assembly,
    workload: Workload,
    reference: list[bool | None],
    peers: Mapping[str, Peer],
    cap: float,
    say: Callable[[str], None] = lambda text: None,
) -> dict[str, Measured]:
    """Every peer in turn, then all again in the opposite order, and so on."""
    results = {key: _prepare(peer, assembly, workload) for key, peer in peers.items()}
    running = [key for key, result in results.items() if not result.refused]
    for round_ in range(ROUNDS):
        for key in running if round_ % 2 == 0 else running[::-1]:
            say(f"{peers[key].name}, round {round_ + 1}")
            gc.collect()
            run = peers[key].run(scene, assembly, workload, cap)
            results[key].times.append(run.seconds)
            if round_ == 0:
                _judge(results[key], run, reference)
        running = [key for key in running if _repeats(results[key])]
    return results


def _prepare(peer: Peer, assembly: Assembly, workload: Workload) -> Measured:
    version = peer.version()
    result = Measured(peer.name, version or "", len(workload.steps))
    if version is None:
        result.refused = f"the Python package {peer.package} is not installed"
    else:
        result.refused = peer.refuses(assembly, workload)
    result.missing = result.queries if result.refused else 0
    return result


def _repeats(result: Measured) -> bool:
    taken = sum(result.times)
    return not result.cut_off and taken * (1 + 1 / len(result.times)) < REPEAT_WITHIN


def _judge(result: Measured, run: Run, reference: list[bool | None]) -> None:
    given = [answer for answer in run.answers if answer.stands is not None]
    result.cut_off = run.cut_off
    result.answered = len(given)
    result.missing = result.queries - len(given)
    for answer, right in zip(run.answers, reference, strict=False):
        if answer.stands is not None and right is not None:
            result.checked += 1
            result.wrong += answer.stands != right
    residuals = [a.residual for a in given if a.stands and not math.isnan(a.residual)]
    result.residual = max(residuals, default=math.nan)
    result.inaccurate = sum(residual > ACCURATE for residual in residuals)
    result.iterations = run.iterations
    result.entries = run.entries
