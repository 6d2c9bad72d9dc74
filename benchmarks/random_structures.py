"""Verdicts on random structures, judged by references that share nothing with the solvers.

    .venv/bin/python benchmarks/random_structures.py [--plane N] [--space N] [--seed S] [--csv FILE]

Each structure (structures/families.py) is checked as it is and as seen in other units of length,
mass and time, turned with its gravity, moved and listed in another order. Counted per family:

- wrong: against the closed form where one is known (towers, squeezed blocks), or a verdict whose
  own numbers do not prove it in rational arithmetic (structures/proofs.py), or different verdicts
  or falling blocks for the same structure seen in another way, or by `Structure`, or by the
  complementarity problem (method "lcp").
- facets: comparisons of falling blocks in space left out, since the lists differ with pyramids of
  8 edges and agree with the round friction cones: on a level contact the edges stay with the
  axes of the world, not with the structure when it is turned: another pyramid, another problem.
- virtual: comparisons of falling blocks left out, since one side knows that it falls but not how it
  begins to (`Verdict.virtual_motion`).
- open: borderline, or without an answer.
"""

from __future__ import annotations

import argparse
import csv
import sys
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

import drystone as ds
from structures.families import Seen, Structure, families, named, scene_of, seen_at_random
from structures.proofs import proves


@dataclass
class Tally:
    """What came out in a family."""

    structures: int = 0
    stand: int = 0
    fall: int = 0
    borderline: int = 0
    unanswered: int = 0
    facets: int = 0
    virtual: int = 0
    wrong: Counter[str] = field(default_factory=Counter)
    examples: list[str] = field(default_factory=list)
    seconds: float = 0.0


def judge(structure: Structure, rng: np.random.Generator, tally: Tally, key: str) -> None:
    """Check one structure in several ways."""
    tally.structures += 1
    scene = scene_of(structure, Seen())
    verdict = ds.check(scene, cone="inscribed")

    def wrong(what: str, detail: str = "") -> None:
        tally.wrong[what] += 1
        tally.examples.append(f"{key}: {what} {detail}")

    if verdict.status != "solved":
        tally.borderline += verdict.status == "borderline"
        tally.unanswered += verdict.status != "borderline"
        tally.examples.append(f"{key}: {verdict}")
        return
    tally.stand += verdict.stable
    tally.fall += not verdict.stable
    if structure.right is not None and verdict.stable != structure.right:
        wrong("reference", f"says {structure.right}")
    why = proves(verdict)
    if why:
        wrong("proof", why)
    if verdict.stable and verdict.falling:
        wrong("falling though it stands")
    # Without friction the rounding of coordinates far away tilts joints: another structure.
    for far in (False, True) if structure.friction > 0 else (False,):
        seen = scene_of(structure, seen_at_random(rng, structure, far))
        other = ds.check(seen, cone="inscribed")
        place = "far" if far else "near"
        if other.status != "solved":
            tally.borderline += other.status == "borderline"
            tally.unanswered += other.status != "borderline"
            tally.examples.append(f"{key} {place}: {other}")
        elif other.stable != verdict.stable:
            wrong(f"seen otherwise, {place}", str(other))
        elif verdict.virtual_motion or other.virtual_motion:
            tally.virtual += 1
        elif set(other.falling) == set(verdict.falling):
            continue
        elif structure.dimension == 3 and structure.friction > 0 and agree_if_round(scene, seen):
            tally.facets += 1
        else:
            wrong(f"other falling blocks, {place}", f"{set(other.falling) ^ set(verdict.falling)}")
    names = [box.name for box in structure.boxes if not box.fixed]
    try:
        stands = ds.Structure(scene, names).stands()
    except ds.DrystoneError as error:
        tally.unanswered += 1
        tally.examples.append(f"{key} Structure: {error}")
        return
    if stands is None:
        tally.borderline += 1
        tally.examples.append(f"{key} Structure: borderline")
    elif stands != verdict.stable:
        wrong("Structure", str(stands))
    lcp = ds.check(scene, method="lcp", cone="inscribed")
    if lcp.status != "solved":
        tally.unanswered += 1
        tally.examples.append(f"{key} lcp: {lcp}")
    elif lcp.stable != verdict.stable:
        wrong("lcp")
    elif verdict.virtual_motion or lcp.virtual_motion:
        tally.virtual += 1
    elif set(lcp.falling) != set(verdict.falling):
        wrong("lcp, other falling blocks", f"{set(lcp.falling) ^ set(verdict.falling)}")


def agree_if_round(scene: ds.Scene, seen: ds.Scene) -> bool:
    """Whether the same blocks fall in both with round friction cones, which turn along."""
    one, other = (ds.check(s, cone="round") for s in (scene, seen))
    return one.status == other.status == "solved" and set(one.falling) == set(other.falling)


def run(counts: dict[int, int], seed: int, only: str | None) -> dict[tuple[int, str], Tally]:
    """All families of the dimensions asked for."""
    tallies = {}
    for d, total in counts.items():
        every = [(n, f) for n, f in families(d) if only is None or only in n]
        for index, (name, family) in enumerate(every):
            tally = tallies.setdefault((d, name), Tally())
            begin = time.perf_counter()
            for k in range(-(-total // len(every))):
                rng = np.random.default_rng([seed, d, index, k])
                judge(named(family(rng), name), rng, tally, f"{d}D {name} [{seed},{d},{index},{k}]")
            tally.seconds = time.perf_counter() - begin
            print(
                f"{d}D {name}: {dict(tally.wrong)} {tally.borderline} {tally.unanswered}",
                file=sys.stderr,
            )
    return tallies


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--plane", type=int, default=10_000)
    parser.add_argument("--space", type=int, default=1_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", help="families with this in their name")
    parser.add_argument("--csv", type=Path)
    options = parser.parse_args()
    tallies = run({2: options.plane, 3: options.space}, options.seed, options.only)
    table = Table(
        "family",
        "structures",
        "stand",
        "fall",
        "wrong",
        "borderline",
        "no answer",
        "facets",
        "virtual",
        "s",
    )
    rows = []
    for (d, name), t in tallies.items():
        row = [
            f"{d}D {name}",
            t.structures,
            t.stand,
            t.fall,
            sum(t.wrong.values()),
            t.borderline,
            t.unanswered,
            t.facets,
            t.virtual,
        ]
        rows.append([*row, f"{t.seconds:.1f}"])
        table.add_row(*map(str, rows[-1]))
    Console().print(table)
    for t in tallies.values():
        for example in t.examples:
            print(example)
    if options.csv:
        with options.csv.open("w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow([column.header for column in table.columns])
            writer.writerows(rows)
    return 1 if any(t.wrong for t in tallies.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
