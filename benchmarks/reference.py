"""The right answers: HiGHS's interior point method, a fresh model for every question.

Where there are more questions than time, evenly spread ones are answered and the rest are left
open; the results say how many were checked.
"""

from __future__ import annotations

import time

from assembly import Assembly
from peers import highs
from peers.base import Present
from steps import Workload

SECONDS = 20.0
"""Wall time for one workload's right answers."""


def verdicts(assembly: Assembly, workload: Workload, seconds: float = SECONDS) -> list[bool | None]:
    """For each question whether it stands, None where that was not found out."""
    count = len(workload.steps)
    right: list[bool | None] = [None] * count
    masks = [mask.copy() for mask in workload.sub_assemblies(assembly)]
    present = Present(assembly)
    model = highs.new_model(float("inf"))
    model.setOptionValue("solver", "ipm")
    begin = time.perf_counter()
    for question in _spread(count):
        if time.perf_counter() - begin > seconds:
            break
        present.mask = masks[question]
        highs.load_model(model, present)
        right[question], _ = highs.solve(model)
    return right


def _spread(count: int) -> list[int]:
    """0 .. count - 1 such that every beginning of the list is spread evenly: bits reversed."""
    bits = max(count - 1, 1).bit_length()
    reversed_bits = (int(format(i, f"0{bits}b")[::-1], 2) for i in range(2**bits))
    # From the end: the last questions are mostly the largest.
    return [count - 1 - i for i in reversed_bits if i < count]
