"""What a falling block would have to bear on: said of verdicts that fall."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from drystone.common.text import shown
from drystone.scene import NearMiss

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drystone import _core

MOST_SAID = 4
"""Blocks that a verdict's text names; `Verdict.unsupported` has all."""

MOST_TOUCHED = 8
"""Bodies that the text on one block names; `Unsupported.touches` has all."""


@dataclass(frozen=True, slots=True, repr=False)
class Unsupported:
    """A falling block that nothing bears from below."""

    name: str
    touches: tuple[str, ...]
    """What it touches, from the side or from above."""
    nearest: str | None
    """The nearest of the other bodies; None if there is none."""
    distance: float | None
    """How far that one is, in metres; zero where they meet at a corner or an edge only."""

    def __str__(self) -> str:
        touched = f"{_listed(self.touches)} only, not from above" if self.touches else "nothing"
        text = f'Block "{shown(self.name)}" touches {touched}'
        if self.nearest is None:
            return text + "."
        nearest = shown(self.nearest)
        if self.distance == 0.0:
            return f'{text}; "{nearest}" meets it at a corner or an edge that bears nothing.'
        return f'{text}; "{nearest}" is {self.distance:.3g} m away.'

    def __repr__(self) -> str:
        return f"<Unsupported: {self}>"


@dataclass(frozen=True, slots=True)
class Explanation:
    """Why blocks fall that bear on nothing."""

    unsupported: tuple[Unsupported, ...] = ()
    near_misses: tuple[NearMiss, ...] = ()

    @classmethod
    def of(cls, scene: _core.Scene, names: Sequence[str], falling: Sequence[str]) -> Explanation:
        """Of a verdict on `names`, of which `falling` fall; nothing to say if none does."""
        if not falling:
            return cls()
        blocks, pairs = scene.explain_fall(list(names), list(falling))
        return cls(
            tuple(
                Unsupported(name, tuple(touches), *(nearest or (None, None)))
                for name, touches, nearest in blocks
            ),
            tuple(NearMiss(*pair) for pair in pairs),
        )

    def lines(self) -> list[str]:
        """Sentences, the first few of either kind."""
        return _some(self.unsupported, "blocks") + _some(self.near_misses, "gaps")

    def to_dict(self) -> dict[str, Any]:
        """In types that JSON knows."""
        return {
            "unsupported": [
                asdict(block) | {"touches": list(block.touches)} for block in self.unsupported
            ],
            "near_misses": [asdict(pair) for pair in self.near_misses],
        }


def _some(things: Sequence[Unsupported] | Sequence[NearMiss], called: str) -> list[str]:
    said = [str(thing) for thing in things[:MOST_SAID]]
    rest = len(things) - len(said)
    return [*said, f"And {rest} more such {called}."] if rest else said


def _listed(names: Sequence[str]) -> str:
    told = ", ".join(f'"{shown(name)}"' for name in names[:MOST_TOUCHED])
    rest = len(names) - MOST_TOUCHED
    return f"{told} and {rest} more" if rest > 0 else told
