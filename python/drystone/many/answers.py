"""What came out for each scene, and for all of them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from drystone import _core
from drystone.common.text import counted, shorten, shown


@dataclass(frozen=True, slots=True, repr=False)
class ScenePlan:
    """The answer for one scene."""

    name: str
    """The name given, the file's name without its ending, or "scene"."""
    sha256: str | None
    """SHA-256 of the scene's text; None if the file could not be read."""
    state: str
    """"planned", "bad_input" (no scene can be made of it) or "failed" (something broke: the next
    call tries again)."""
    found: bool
    """An order was found."""
    status: str
    """The plan's status; empty without a plan."""
    error: str
    """What is wrong, after the type of the error; empty with a plan."""
    reused: bool
    """Taken from the folder, not planned now."""
    file: Path | None
    """The file that holds the answer."""
    _record: dict[str, Any] | None = field(repr=False)

    def __repr__(self) -> str:
        ending = self.status if self.state == "planned" else f"{self.state}: {self.error:.80}"
        return f"<ScenePlan: {shown(self.name)!r}, {shown(ending)}>"

    @property
    def plan(self) -> dict[str, Any]:
        """What `Plan.to_dict()` gives, read from the file if there is one; empty without a plan."""
        record = self._record
        if record is None:
            if self.file is None:
                return {}
            record = _read(self.file)
        plan: dict[str, Any] = record.get("plan", {})
        return plan

    @property
    def order(self) -> tuple[str, ...]:
        """Names of the blocks, first removed first; empty if no order was found."""
        return tuple(self.plan.get("order", ()))

    def to_dict(self) -> dict[str, Any]:
        """Everything but the plan itself, in types that JSON knows."""
        return {
            "name": self.name,
            "sha256": self.sha256,
            "state": self.state,
            "found": self.found,
            "status": self.status,
            "error": self.error,
            "reused": self.reused,
            "file": None if self.file is None else str(self.file),
        }


def _read(file: Path) -> dict[str, Any]:
    """The record in a file; DrystoneError if it has been damaged since it was written."""
    try:
        record = json.loads(file.read_bytes())
    except (ValueError, RecursionError):
        record = None
    if not isinstance(record, dict) or not isinstance(record.get("plan", {}), dict):
        raise _core.DrystoneError(f"{file}: this is no plan that drystone wrote; plan it again")
    return record


@dataclass(frozen=True, slots=True, repr=False)
class ManyPlans:
    """The answers for many scenes, in the order of the scenes; equal ones are there once.

    `many["wall"]` is the first of that name, `many[0]` the first of all.
    """

    answers: tuple[ScenePlan, ...]
    interrupted: bool
    """Ctrl-C came before the end: the scenes not reached have no answer."""

    def __iter__(self) -> Iterator[ScenePlan]:
        return iter(self.answers)

    def __len__(self) -> int:
        return len(self.answers)

    def __getitem__(self, which: int | str) -> ScenePlan:
        if isinstance(which, int):
            return self.answers[which]
        for answer in self.answers:
            if answer.name == which:
                return answer
        raise KeyError(which)

    @property
    def found(self) -> int:
        """Scenes with an order."""
        return sum(answer.found for answer in self.answers)

    @property
    def without_order(self) -> tuple[ScenePlan, ...]:
        """Planned, but no order found."""
        return tuple(a for a in self.answers if a.state == "planned" and not a.found)

    @property
    def bad(self) -> tuple[ScenePlan, ...]:
        """Without a plan: bad input, or failed."""
        return tuple(a for a in self.answers if a.state != "planned")

    @property
    def reused(self) -> int:
        """Answers that were in the folder already."""
        return sum(answer.reused for answer in self.answers)

    def __str__(self) -> str:
        parts = [f"{self.found} of {counted(len(self), 'scene')} with an order"]
        if self.without_order:
            parts.append(f"{len(self.without_order)} without")
        if self.bad:
            parts.append(f"{len(self.bad)} not planned ({shorten(a.name for a in self.bad)})")
        if self.reused:
            parts.append(f"{self.reused} taken from before")
        return "; ".join(parts) + (". Interrupted." if self.interrupted else ".")

    def __repr__(self) -> str:
        return f"<ManyPlans: {self}>"

    def to_dict(self) -> dict[str, Any]:
        """Everything but the plans themselves, in types that JSON knows."""
        return {
            "scenes": len(self),
            "found": self.found,
            "without_order": len(self.without_order),
            "bad": len(self.bad),
            "reused": self.reused,
            "interrupted": self.interrupted,
            "answers": [answer.to_dict() for answer in self.answers],
        }
