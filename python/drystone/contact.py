"""One time step's contact problem, on Coulomb's round cone.

Given velocities without contacts `free`, a mass matrix M and contacts with Jacobian J, find
impulses p and velocities v = free + M^-1 J' p such that at every contact, with u = J v there,

    0 <= p_n  complementary to  u_n + offset >= 0,    |p_t| <= mu p_n,
    p_t = -mu p_n u_t / |u_t|  where it slides.

A puck of 2 kg on ice with mu = .1 moves at 3 and 4 m/s along the tangents, and falls at .1 m/s:

>>> import numpy as np
>>> from drystone import contact
>>> J = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
>>> solution = contact.solve(2 * np.eye(3), J, 0.1, free=[3, 4, -0.1])
>>> solution.status, solution.velocities.round(6)
('solved', array([2.994, 3.992, 0.   ]))
>>> solution.impulses.round(6)
array([ 0.2  , -0.012, -0.016])
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drystone import _core
from drystone._core import ContactError
from drystone.common.arrays import floats, vector
from drystone.common.compressed import (
    Compressed,
    by_columns,
    by_rows,
    is_sparse,
    of_diagonal_blocks,
    times,
)
from drystone.common.numbers import number, optional_number, whole
from drystone.common.text import counted

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from drystone.common.compressed import Matrix

__all__ = ["ContactError", "Solution", "solve"]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Solution:
    """The answer of `solve`."""

    impulses: NDArray[np.float64]
    """(d k,), N s: of each contact along its normal, then along its tangents, in the order of J's
    rows; what the bodies get is J' p."""
    velocities: NDArray[np.float64]
    """(n,), at the end of the step, in the units of `free`."""
    error: float
    """How far the worst contact is from Coulomb's law, m/s. Zero if and only if the law holds.

    It is the length of p - P(p - (u + mu |u_t| n)), where P projects on the contact's friction
    cone, and an impulse p counts as the speed that it gives at its own contact."""
    tolerance: float
    """What `error` was compared with, m/s."""
    status: str
    """"solved" (`error` is at most `tolerance`), or "limit": this is the best that was found."""
    islands: int
    """How many independent groups of bodies the contacts connect; each is solved by itself."""
    sweeps: int
    """Sweeps over the contacts, of all islands together. The same on every machine."""
    newton_steps: int
    """Newton steps, all islands together."""

    def __repr__(self) -> str:
        sizes = f"{len(self.impulses)} impulses, {len(self.velocities)} velocities"
        work = f"{counted(self.sweeps, 'sweep')}, {counted(self.newton_steps, 'Newton step')}"
        return f"<Solution: {self.status}, {sizes}; error {self.error:.1e} m/s, {work}>"


def solve(
    M: Matrix,
    J: Matrix,
    mu: ArrayLike,
    free: ArrayLike,
    offset: ArrayLike = 0.0,
    restitution: ArrayLike = 0.0,
    start: Solution | ArrayLike | None = None,
    *,
    dimension: int | None = None,
    tolerance: float | None = None,
    scale: float = 0.0,
) -> Solution:
    """Solve one step's contact problem of k contacts with d components each (2 or 3, as in space).

    - `M` (n, n), symmetric positive definite: a NumPy array or SciPy sparse matrix, or (n,) its
      diagonal, or (m, b, b) its m diagonal blocks. kg, kg m^2.
    - `J` (d k, n), a NumPy array or SciPy sparse matrix: contact after contact the row of the
      normal, then of the tangents, square to it and to one another. J v is the velocity of the
      second body relative to the first; positive along the normal means that they part.
    - `mu`, one for all or (k,): coefficients of friction, zero or more. Above 100 it counts as 100:
      nothing slides unless it is pushed within 0.6 degrees of the face.
    - `free` (n,): the velocities at the end of the step if there were no contacts. m/s, rad/s.
    - `offset`, one for all or (k,): how fast a contact may close, gap / dt, m/s. Negative: how fast
      it has to part.
    - `restitution`, one for all or (k,), from 0 to 1: a contact that would close beyond its offset
      parts at this share of the normal speed that it has in `free` (Newton's law of impact, which
      may gain energy where several contacts with friction collide at once).
    - `start`: a `Solution`, or impulses (d k,), to begin from, such as those of the step before.
      It saves work; where several impulses are solutions, it may decide which is found.
    - `dimension`: d. Needed only where `mu`, `offset` and `restitution` are single numbers and J's
      rows could be contacts in the plane and in space.
    - `tolerance`, m/s: the largest `error` that counts as solved. By default 1e-8 times the largest
      relative velocity of the contacts in `free`, or times `scale` (m/s; g dt, say) if that is
      larger.

    Masses may differ a million times, contacts may be redundant. With offsets of zero or more, and
    no restitution, no energy comes from contacts. The same input gives the same bits.

    Raises ContactError for shapes that do not match, entries that are not finite, and an M that is
    not symmetric positive definite. A problem that was not solved is a status, not an error.
    """
    free = vector(free, "free", ContactError)
    mass = _mass(M, free.size)
    jacobian = by_rows(J, "J", ContactError)
    if jacobian.shape[1] != free.size:
        raise ContactError(
            f"J has {jacobian.shape[1]} columns, but free has {free.size} entries: "
            "give one of each for every unknown"
        )
    laws = {"mu": floats(mu, "mu", ContactError), "offset": floats(offset, "offset", ContactError)}
    laws["restitution"] = floats(restitution, "restitution", ContactError)
    d = _dimension(jacobian.shape[0], laws, dimension)
    contacts = jacobian.shape[0] // d
    friction, offsets, shares = (_each(law, name, contacts) for name, law in laws.items())
    if np.any(shares):
        offsets = _rebounding(times(jacobian, free)[::d], offsets, shares)
    begin = start.impulses if isinstance(start, Solution) else start
    tolerance = optional_number(tolerance, "tolerance", ContactError)
    if tolerance is not None and not tolerance >= 0:
        raise ContactError(f"tolerance is {tolerance}: it must be zero or more, m/s")
    scale = number(scale, "scale", error=ContactError)
    if not 0 <= scale < np.inf:
        raise ContactError(f"scale is {scale}: it must be zero or more, m/s")
    core = _core.contact_solve(
        d,
        mass.arrays,
        jacobian.arrays,
        friction,
        free,
        offsets,
        None if begin is None else vector(begin, "start", ContactError),
        tolerance,
        scale,
    )
    return Solution(
        core.impulses,
        core.velocities,
        core.error,
        core.tolerance,
        core.status,
        core.islands,
        core.sweeps,
        core.newton_steps,
    )


def _dimension(rows: int, laws: dict[str, NDArray[np.float64]], given: int | None) -> int:
    """Components of a contact, from what says how many contacts there are."""
    if given is not None:
        if whole(given, "dimension") not in (2, 3):
            raise ContactError(f"dimension is {given}: it must be 2 or 3")
        candidates = [given]
    else:
        counts = {law.size for law in laws.values() if law.ndim == 1}
        candidates = [d for d in (2, 3) if not counts or rows in {d * count for count in counts}]
    fitting = [d for d in candidates if rows % d == 0]
    if not fitting:
        raise ContactError(
            f"J has {rows} rows, not {' or '.join(map(str, candidates or (2, 3)))} a contact: "
            "give the normal and one tangent (plane) or two (space), and one mu a contact"
        )
    if len(fitting) > 1 and rows > 0:
        raise ContactError(
            f"J's {rows} rows could be {rows // 2} contacts in the plane or {rows // 3} in space: "
            "say dimension=2 or dimension=3, or give one mu for each contact"
        )
    return fitting[-1]


def _each(law: NDArray[np.float64], name: str, contacts: int) -> NDArray[np.float64]:
    if law.ndim > 1 or (law.ndim == 1 and law.size != contacts):
        raise ContactError(
            f"{name} is of shape {law.shape}: give one number, or one for each contact, {contacts}"
        )
    if name == "restitution" and not np.all((law >= 0) & (law <= 1)):
        raise ContactError("restitution must be from 0 to 1")
    return np.ascontiguousarray(np.broadcast_to(law, (contacts,)))


def _rebounding(
    normal: NDArray[np.float64], offset: NDArray[np.float64], share: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Offsets where contacts that would close part again."""
    return np.where((share > 0) & (normal < 0) & (normal + offset < 0), share * normal, offset)


def _mass(M: Matrix, n: int) -> Compressed:
    if is_sparse(M):
        mass = by_columns(M, "M", ContactError)
    else:
        array = floats(M, "M", ContactError)
        if array.ndim == 1:
            mass = of_diagonal_blocks(array.reshape(-1, 1, 1))
        elif array.ndim == 3 and array.shape[1] == array.shape[2]:
            mass = of_diagonal_blocks(array)
        else:
            mass = by_columns(array, "M", ContactError)
    if mass.shape != (n, n):
        raise ContactError(
            f"M is of shape {mass.shape}, but free has {n} entries: "
            "give a row and a column for each"
        )
    return mass
