"""The one set of numbers that every peer is given: G, F and M^-1 of a complete assembly.

A sub-assembly stands if some f >= 0 has G f = -F, over the generators whose bodies are all present
or fixed. See `drystone._core.generators`: row 3 i + k of G is body i's x force, y force and moment.

Peers get the numbers scaled, since the defaults of most solvers assume entries near one. With g the
largest applied acceleration:

    balance @ x = load,  x >= 0       rows M^-1 / g, columns scaled to a largest entry of one
    normals @ u >= 0,  target         rows of G' M^-1/2 with norm one; u = M^1/2 v / g

The first states equilibrium as a linear program. The second gives the accelerations v as Gauss's
principle does: minimise |u - target|^2 / 2; the multipliers are the contact forces.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

import drystone as ds
from drystone import _core

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Assembly:
    """The generators of all movable bodies of a scene, raw and scaled."""

    names: tuple[str, ...]
    G: sp.csc_matrix
    """(3 bodies, generators), wrench of a unit force of each generator."""
    applied: Floats
    """(3 bodies,), N and N m."""
    inverse_mass: Floats
    """(3 bodies,), 1/kg and 1/(kg m^2)."""
    bodies: Indices
    """(generators, 2), the movable bodies that a generator acts on, -1 for a fixed one."""
    gravity: float
    """g: the largest applied acceleration, m/s^2."""
    balance: sp.csc_matrix
    load: Floats
    normals: sp.csr_matrix
    target: Floats
    balance_scale: Floats
    """Force (N) of a generator is its x in `balance` times this."""
    normals_scale: Floats
    """Force (N) of a generator is its multiplier in `normals` times this."""

    @classmethod
    def of(cls, scene: ds.Scene) -> Assembly:
        """The numbers of `scene`."""
        g = _core.generators(scene._core)
        shape = (3 * len(g.names), len(g.indptr) - 1)
        G = sp.csc_matrix((g.data, g.indices.astype(np.int32), g.indptr), shape=shape)
        gravity = float(np.max(np.abs(g.applied * g.inverse_mass), initial=0.0)) or 1.0
        accelerations = sp.csc_matrix(sp.diags(g.inverse_mass) @ G)
        largest = abs(accelerations).max(axis=0).toarray().ravel()
        root = np.sqrt(g.inverse_mass)
        normals = sp.csr_matrix((sp.diags(root) @ G).T)
        norms = np.sqrt(np.asarray(normals.multiply(normals).sum(axis=1)).ravel())
        return cls(
            names=tuple(g.names),
            G=G,
            applied=g.applied,
            inverse_mass=g.inverse_mass,
            bodies=g.bodies,
            gravity=gravity,
            balance=sp.csc_matrix(accelerations @ sp.diags(1 / largest)),
            load=-g.applied * g.inverse_mass / gravity,
            normals=sp.csr_matrix(sp.diags(1 / norms) @ normals),
            target=root * g.applied / gravity,
            balance_scale=gravity / largest,
            normals_scale=gravity / norms,
        )

    def __len__(self) -> int:
        return len(self.names)

    def nobody(self) -> Mask:
        """A mask of bodies, none present. One place more than bodies: index -1, always present."""
        present = np.zeros(len(self) + 1, dtype=bool)
        present[-1] = True
        return present

    def generators(self, present: Mask) -> Indices:
        """Generators that act only on bodies present or fixed."""
        return np.flatnonzero(present[self.bodies].all(axis=1))

    def touching(self) -> tuple[Indices, ...]:
        """For each body the generators that act on it."""
        named = self.bodies.ravel()
        order = np.argsort(named, kind="stable")
        ends = np.searchsorted(named[order], np.arange(len(self) + 1))
        return tuple(order[ends[i] : ends[i + 1]] // 2 for i in range(len(self)))

    def residual(self, present: Mask, generators: Indices, forces: Floats) -> float:
        """How far `forces` (N) are from an equilibrium: 0 is exact.

        The larger of the bodies' largest remaining acceleration, relative to g, and the largest
        pulling force, relative to the largest applied load.
        """
        if not np.all(np.isfinite(forces)):
            return float("inf")
        wrench = self.G[:, generators] @ forces + self.applied
        rows = np.repeat(present[:-1], 3)
        remaining = np.max(np.abs(wrench * self.inverse_mass)[rows], initial=0.0) / self.gravity
        load = np.max(np.abs(self.applied), initial=0.0) or 1.0
        return float(max(remaining, np.max(-forces, initial=0.0) / load))


def rows_of(bodies: Indices) -> Indices:
    """The rows 3 i + k of some bodies."""
    return (3 * bodies[:, None] + np.arange(3)).ravel()
