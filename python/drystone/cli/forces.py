"""Which contact forces the command line shows without being asked."""

from __future__ import annotations

from dataclasses import replace

from drystone.equilibrium.verdict import Verdict

MOST_POINTS = 20_000
"""Verdicts with more contact points are shown with the forces that they were found with: those of
least norm take many times as long as a verdict, here some seconds."""


def with_forces_in_time(verdict: Verdict) -> Verdict:
    """The verdict, of a large scene with the forces that it was found with."""
    if len(verdict.forces) <= MOST_POINTS:
        return verdict
    return replace(verdict, forces=verdict.forces.as_found())
