"""What is asked: a sequence of related questions, does this sub-assembly stand?

At each step some blocks are taken away, then some are put on, and then the question is asked.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from assembly import Assembly, Mask


@dataclass(frozen=True, slots=True)
class Step:
    """Indices in `Assembly.names`."""

    removed: tuple[int, ...]
    added: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Workload:
    """The questions asked of one assembly."""

    name: str
    steps: tuple[Step, ...]
    planned: bool
    """Whether `drystone.plan` asks just these questions, so that its own search can be timed."""
    note: str = ""

    def sub_assemblies(self, assembly: Assembly) -> Iterator[Mask]:
        """The blocks present at each question. The mask is reused: copy it to keep it."""
        present = assembly.nobody()
        for step in self.steps:
            present[list(step.removed)] = False
            present[list(step.added)] = True
            yield present
