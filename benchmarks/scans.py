"""Contacts of two scans that lie on one another: seconds and memory.

    python benchmarks/scans.py [TRIANGLES ...]

A plate of rolling ground, as dense above as below, and another that was cast on it, with the same
corners or scanned anew: shifted by a third of a triangle and turned by 0.1 rad. Half of the
triangles of each lie on the other's. The tolerance is what two such scans may differ by. Seconds
are of processor time, of taking in both and of finding the contacts, and in brackets by the clock;
the memory is the most that the process had so far.
"""

from __future__ import annotations

import resource
import sys
import time

import numpy as np
from numpy.typing import NDArray

import drystone as ds

TURN, SHIFT = 0.1, 1 / 3
"""Of a scan made anew: rad, and in triangles."""

CURVED = 4.0
"""Tolerance in sides of triangles squared, 1/m: twice a half of the curvature, an eighth of which
the middle of a side is off."""


def ground(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """Height, m: bumps of some 2 cm on a square metre."""
    return 0.02 * np.sin(9 * x + 1) * np.cos(7 * y) + 0.004 * np.sin(40 * x) * np.sin(37 * y)


def plate(side: int, above: bool, anew: bool) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A closed surface of about 4 `side`^2 triangles: the ground and a plane 0.2 m from it."""
    turn, shift, half = (TURN, SHIFT / side, 0.4) if anew else (0.0, 0.0, 0.5)
    u, v = np.meshgrid(*[np.linspace(-half, half, side + 1)] * 2, indexing="ij")
    x = np.cos(turn) * u - np.sin(turn) * v + shift
    y = np.sin(turn) * u + np.cos(turn) * v
    z = ground(x, y)
    flat = np.full_like(z, -0.2 if above else 0.2)
    count = (side + 1) ** 2
    points = np.concatenate([np.stack([x, y, h], -1).reshape(-1, 3) for h in (z, flat)])
    number = np.arange(count).reshape(side + 1, side + 1)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    up = np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
    rim = np.concatenate([number[:-1, 0], number[-1, :-1], number[:0:-1, -1], number[0, :0:-1]])
    following = np.roll(rim, -1)
    sides = [(rim, following + count, following), (rim, rim + count, following + count)]
    walls = np.concatenate([np.stack(t, -1) for t in sides])
    faces = np.concatenate([up, up[:, ::-1] + count, walls])
    return points, faces if above else faces[:, ::-1]


def measured(triangles: int, anew: bool) -> str:
    """One line of the table."""
    side = round((triangles / 4) ** 0.5)
    start = time.process_time()
    scene = ds.Scene(dimension=3, friction=0.5, contact_tolerance=CURVED / side**2)
    lower, upper = plate(side, True, False), plate(side, False, anew)
    scene.add_surface(*lower, name="below", fixed=True)
    scene.add_surface(*upper, name="above")
    taken = time.process_time()
    clock = time.perf_counter()
    contacts = len(scene.contacts)
    found, clock = time.process_time(), time.perf_counter() - clock
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    scans = "anew" if anew else "same corners"
    cells = (
        len(lower[1]),
        scans,
        contacts,
        f"{taken - start:.1f}",
        f"{found - taken:.1f} ({clock:.1f})",
        f"{memory:.2f}",
    )
    return "| " + " | ".join(map(str, cells)) + " |"


def main() -> None:
    """The table."""
    print(
        "| triangles each | scans | contacts | take in, s | contacts, s | memory, GiB |",
        "|---|---|---|---|---|---|",
        sep="\n",
    )
    for triangles in map(int, sys.argv[1:] or ("10000", "100000", "1000000")):
        for anew in (False, True):
            print(measured(triangles, anew), flush=True)


if __name__ == "__main__":
    main()
