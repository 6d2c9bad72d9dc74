"""The order whose smallest margin is largest."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

from drystone.planning.answer import Plan

SHARE, LEAST = 1e-3, 1e-4
"""How near to the largest the smallest margin comes: of it, or in g."""

MOST_PLANS = 40
"""Bisection halves the gap with each."""


def robust(planned: Callable[[float], Plan], least: float) -> Plan:
    """The order found with the largest margin, `least` or more; `planned` plans with a margin.

    A plan with the margin t has an order whose structures all bear t or a little more; the smallest
    of their margins is where the search goes on. No order bears more than the complete structure.
    A search that is given up by a limit counts as one without an order; Ctrl-C ends all of it,
    with the best so far.
    """
    best = planned(least)
    if not best.found or not best.order:
        return best
    known = least
    try:
        for better in _ever_better(best, planned):
            best, known = better, min(better.margins)
    except KeyboardInterrupt:
        best = replace(best, status="interrupted")
    return replace(best, margin=known)


def _ever_better(best: Plan, planned: Callable[[float], Plan]) -> Iterator[Plan]:
    """`best`, and plans with larger margins, whose `margins` are known. KeyboardInterrupt if one of
    them was interrupted."""
    most, known = best.margins[0], min(best.margins)
    yield best
    tried = most * (1 - SHARE) if math.isfinite(most) else 2 * known + 1.0
    for _ in range(MOST_PLANS):
        if most - known <= max(SHARE * known, LEAST) or math.isinf(known):
            break
        found = planned(tried)
        if found.status == "interrupted":
            raise KeyboardInterrupt
        if found.found:
            if min(found.margins) > known:
                known = min(found.margins)
                yield found
        else:
            most = tried
        tried = 0.5 * (known + most) if math.isfinite(most) else 2 * known + 1.0
