"""Peak memory of one peer on one workload, in a process of its own.

What counts is by how much the resident memory grows, at most, from the moment when the scene, the
numbers, the questions and the peer's library are there: the solver's working memory, its matrices,
and the pages that the allocator keeps. Below about 1 MB it says nothing.
"""

from __future__ import annotations

import ctypes
import importlib
import math
import pickle
import subprocess
import sys
from pathlib import Path

import threads  # noqa: F401  (before NumPy)

STATUS = Path("/proc/self/status")
CLEAR = Path("/proc/self/clear_refs")


def grown(scene: object, workload: object, peer: str, cap: float) -> float:
    """Megabytes; NaN if the system does not tell, or the run fails or takes too long."""
    if not CLEAR.exists():
        return math.nan
    job = pickle.dumps((scene, workload, peer, cap))
    command = [sys.executable, __file__]
    try:
        done = subprocess.run(command, input=job, capture_output=True, timeout=60 + 6 * cap)
    except subprocess.TimeoutExpired:
        return math.nan
    return float(done.stdout) if done.returncode == 0 else math.nan


def _main() -> None:
    from assembly import Assembly
    from peers import PEERS

    scene, workload, key, cap = pickle.load(sys.stdin.buffer)
    peer = PEERS[key]
    importlib.import_module(peer.package)
    assembly = Assembly.of(scene)
    _give_back_free_pages()
    CLEAR.write_text("5")  # the peak starts anew
    before = _kilobytes("VmRSS")
    peer.run(scene, assembly, workload, cap)
    print((_kilobytes("VmHWM") - before) / 1024)


def _give_back_free_pages() -> None:
    """So that memory which was used and freed before does not hide the growth (glibc only)."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)


def _kilobytes(key: str) -> int:
    line = next(line for line in STATUS.read_text().splitlines() if line.startswith(key))
    return int(line.split()[1])


if __name__ == "__main__":
    _main()
