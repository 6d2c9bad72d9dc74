"""What pictures and pages say of bodies that overlap."""

from __future__ import annotations

from collections.abc import Sequence

from drystone.common.text import counted
from drystone.scene import Overlap, Scene

MOST_LISTED = 8
"""Pairs that the note under a picture lists; `Scene.overlaps` has all."""


def titled(scene: Scene, overlaps: Sequence[Overlap]) -> tuple[str, str]:
    """Title and note of a scene's picture."""
    blocks = counted(sum(not body.fixed for body in scene.bodies), "block")
    if not overlaps:
        return f"{blocks}, {counted(len(scene.contacts), 'contact point')}", ""
    return f"{blocks}, {counted(len(overlaps), 'overlap')} (red)", "\n".join(said(overlaps))


def said(overlaps: Sequence[Overlap]) -> list[str]:
    """A line for each pair, the deepest first, and how many more there are."""
    deepest = sorted(overlaps, key=lambda pair: -pair.depth)
    lines = [
        f"{pair.a} and {pair.b}: {pair.depth:.3g} m deep, "
        f"{pair.contact_tolerance:.3g} m are tolerated"
        for pair in deepest[:MOST_LISTED]
    ]
    rest = len(overlaps) - len(lines)
    return [*lines, f"and {rest} more"] if rest else lines


def names_in(overlaps: Sequence[Overlap]) -> set[str]:
    """Every body of some pair."""
    return {name for pair in overlaps for name in (pair.a, pair.b)}
