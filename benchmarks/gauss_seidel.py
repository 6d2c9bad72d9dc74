"""Block Gauss-Seidel for contact problems: each contact in turn gets the impulse of its own law.

The peer of `fclib.py`, and its judge. u = W p + q; every contact's own 3 x 3 (2 x 2) problem is
solved exactly: it parts, sticks, or slides, and then one number is looked for, by which its tangent
velocity opposes the impulse.

Jourdan, Alart and Jean, A Gauss-Seidel like algorithm to solve frictional contact problems, 1998.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Swept:
    """What so many sweeps found."""

    impulses: Floats
    sweeps: int
    seconds: float


def coulomb_error(w: Any, q: Floats, friction: Floats, impulses: Floats) -> float:
    """The largest error of Coulomb's law over the contacts, m/s, as in `ds.contact.Solution`."""
    k = len(friction)
    u, p = (w @ impulses + q).reshape(k, -1), impulses.reshape(k, -1)
    weight = w.diagonal().reshape(k, -1).mean(axis=1, keepdims=True)
    speed = np.linalg.norm(u[:, 1:], axis=1)
    scaled = weight * p
    moved = scaled - u
    moved[:, 0] -= friction * speed
    return float(np.linalg.norm(scaled - _projected(moved, friction), axis=1).max())


def _projected(x: Floats, friction: Floats) -> Floats:
    """On the cones |p_t| <= mu p_n."""
    size = np.linalg.norm(x[:, 1:], axis=1)
    inside = size <= friction * x[:, 0]
    polar = friction * size <= -x[:, 0]
    normal = np.maximum(0.0, (x[:, 0] + friction * size) / (1 + friction**2))
    on_edge = np.empty_like(x)
    on_edge[:, 0] = normal
    on_edge[:, 1:] = x[:, 1:] * (friction * normal / np.where(size > 0, size, 1))[:, None]
    on_edge[polar] = 0
    return np.where(inside[:, None], x, on_edge)


def solve(w: Any, q: Floats, friction: Floats, tolerance: float, seconds: float) -> Swept:
    """Sweep until the error is within the tolerance, but no longer than so many seconds."""
    d = len(q) // len(friction)
    rows = w.tocsr()
    places = [slice(d * k, d * (k + 1)) for k in range(len(friction))]
    parts = [rows[at] for at in places]
    columns = [np.unique(part.indices) for part in parts]
    blocks = [part[:, used].toarray() for part, used in zip(parts, columns, strict=True)]
    own = [part[:, at].toarray() for part, at in zip(parts, places, strict=True)]
    contacts = [_Contact.of(block, mu) for block, mu in zip(own, friction, strict=True)]
    p = np.zeros(len(q))
    begun, sweeps = time.perf_counter(), 0
    while time.perf_counter() - begun < seconds:
        for at, used, block, itself, contact in zip(
            places, columns, blocks, own, contacts, strict=True
        ):
            p[at] = contact.solve(block @ p[used] + q[at] - itself @ p[at])
        sweeps += 1
        if coulomb_error(w, q, friction, p) <= tolerance:
            break
    return Swept(p, sweeps, time.perf_counter() - begun)


@dataclass(frozen=True, slots=True)
class _Contact:
    """One contact's W with its tangents turned so that their part is diagonal."""

    turn: Floats
    w: Floats
    friction: float

    @classmethod
    def of(cls, w: Floats, friction: float) -> _Contact:
        turn = np.eye(len(w))
        turn[1:, 1:] = np.linalg.eigh(w[1:, 1:])[1]
        return cls(turn, turn.T @ w @ turn, float(friction))

    def solve(self, q: Floats) -> Floats:
        """The impulse for the velocity q without it."""
        w, mu = self.w, self.friction
        if q[0] >= 0 or w[0, 0] <= 0:
            return np.zeros(len(q))
        turned = self.turn.T @ q
        # It sticks: as if it slid and nothing gave way.
        p = self._at(0.0, turned) if (w.diagonal() > 0).all() else None
        if p is None or not np.hypot.reduce(p[1:]) <= mu * p[0]:
            p = self._slides(turned)
        return self.turn @ np.array(p)

    def _at(self, alpha: float, q: Floats) -> list[float]:
        """The impulse with u_n = 0 and u_t = -alpha p_t."""
        above, below = -q[0], self.w[0, 0]
        tangents = [(self.w[0, k], 1 / (self.w[k, k] + alpha), q[k]) for k in range(1, len(q))]
        for lean, soft, speed in tangents:
            above += lean * soft * speed
            below -= lean * soft * lean
        normal = above / below if below > 0 else float("inf")
        return [normal, *(-(speed + lean * normal) * soft for lean, soft, speed in tangents)]

    def _slides(self, q: Floats) -> list[float]:
        """By bisection of alpha's logarithm: the impulse leaves the cone below it."""
        middle = float(np.trace(self.w))
        low, high = 1e-14 * middle, 1e14 * middle
        for _ in range(64):
            alpha = (low * high) ** 0.5
            p = self._at(alpha, q)
            if sum(x * x for x in p[1:]) > (self.friction * p[0]) ** 2 or p[0] < 0:
                low = alpha
            else:
                high = alpha
        normal, *tangents = self._at(high, q)
        size = sum(x * x for x in tangents) ** 0.5
        share = self.friction * normal / size if size > 0 else 0.0
        return [normal, *(share * x for x in tangents)]
