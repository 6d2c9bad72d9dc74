"""How much more load a structure bears, and how it collapses there."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TextIO, TypeAlias

from drystone import _core
from drystone.common import later
from drystone.common.cones import FACETS, INSCRIBED, ROUND, Cone, core_cones
from drystone.common.drawn import Answer
from drystone.common.json_text import write_json
from drystone.common.numbers import Floats, name_of, names_of, vector
from drystone.common.text import MOST_ROWS, counted, shorten
from drystone.equilibrium.contact_force import ANY, ContactForces
from drystone.scene import Scene
from drystone.scene.scene import scene_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Push: TypeAlias = Mapping[str, Floats]
"""Body and the force on its centroid, N, world axes: two numbers in the plane, three in space;
behind them, if given, the moment beside it, N m: one number, in space three."""

CoreForces = list[tuple[str, tuple[float, ...], tuple[float, float, float]]]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class LimitEnd:
    """An end of the interval of load factors, with what proves it."""

    factor: float
    """The load factor; plus or minus infinity if nothing limits it."""
    mechanism: dict[str, NDArray[np.float64]]
    """Velocity of every block that moves in the collapse: (3,), x and y in m/s and the turn in
    rad/s, counter-clockwise; in space (6,). The largest of any speed of a centre of mass, and of
    any turn times the distance to the block's furthest corner, is 1 m/s; blocks at rest are left
    out. Contacts open in it or stay closed; one that slides opens too, by the angle of friction
    (the associated flow rule, see `limit`)."""
    forces: ContactForces | None
    """Contact forces that hold the structure there; None without a limit."""
    imbalance: float
    """What these forces leave unbalanced on the worst block, as a share of its load or of the
    largest force on it: rounding."""
    closing: float
    """How fast a contact closes in the mechanism, as a share of its fastest point: rounding."""
    bound: float
    """The factor at which the loads do no work in the mechanism, so that no factor beyond it can
    stand. The same number as `factor`, computed in another way: it is the proof."""

    @classmethod
    def _of(cls, core: _core.LimitEnd) -> LimitEnd:
        forces = None if core.forces is None else ContactForces(None, ANY, core.forces)
        mechanism = dict(zip(core.names, core.velocities, strict=True))
        return cls(core.factor, mechanism, forces, core.imbalance, core.closing, core.bound)

    def __repr__(self) -> str:
        moving = f"{counted(len(self.mechanism), 'block')} in its mechanism"
        names = f" ({shorten(self.mechanism)})" if self.mechanism else ""
        return f"<LimitEnd: factor {self.factor:.6g}, {moving}{names}>"

    def table(self, rows: int = MOST_ROWS) -> str:
        """The velocities of the first `rows` blocks of the mechanism, as text."""
        return later.table(self, rows)

    def to_dict(self) -> dict[str, Any]:
        """Everything, in types that JSON knows; what is no finite number is None."""
        return {
            "factor": finite(self.factor),
            "mechanism": {name: motion.tolist() for name, motion in self.mechanism.items()},
            "imbalance": finite(self.imbalance),
            "closing": finite(self.closing),
            "bound": finite(self.bound),
        }


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Limit(Answer):
    """The answer of `limit`."""

    status: str
    """"solved"; "no_solution" if the structure falls under every factor (`factor` is then not a
    number, and `mechanism` says how it falls whatever the push); or why the solver stopped without
    an answer."""
    lower: LimitEnd
    """The least factor with which the structure can stand."""
    upper: LimitEnd
    """The greatest."""
    pivots: int
    """Pivots, from forces that hold the structure to those at the limit."""
    iterations: int
    """Matrices factored by the interior-point method."""
    seconds: float
    """Wall time."""
    names: tuple[str, ...]
    """The movable bodies that are there."""
    push: dict[str, tuple[float, ...]]
    """The forces and moments that were asked about, N and N m."""
    gravity: tuple[float, ...] | None
    """What was added to gravity, m/s^2, times the factor."""
    scene: Scene = field(repr=False)
    """The scene asked about."""

    @property
    def factor(self) -> float:
        """The greatest factor; infinite if nothing limits it."""
        return self.upper.factor

    @property
    def bounds(self) -> tuple[float, float]:
        """(least, greatest): it can stand for the factors between them, and no others."""
        return self.lower.factor, self.upper.factor

    @property
    def mechanism(self) -> dict[str, NDArray[np.float64]]:
        """How it collapses at the greatest factor; see `LimitEnd.mechanism`."""
        return self.upper.mechanism

    @property
    def forces(self) -> ContactForces | None:
        """The contact forces at the greatest factor; see `LimitEnd.forces`."""
        return self.upper.forces

    def __copy__(self) -> Limit:
        return self  # nobody can change it

    def __str__(self) -> str:
        work = counted(self.pivots, "pivot") if self.pivots else ""
        if self.iterations or not work:
            work += (", " if work else "") + counted(self.iterations, "iteration")
        moving = f"{len(self.mechanism)} of {counted(len(self.names), 'block')}"
        falls = f"{moving} ({shorten(self.mechanism)})"
        if self.status == "no_solution":
            return f"Stands under no factor of the push, falls: {falls}; {work}."
        if self.status != "solved":
            return f"No answer ({self.status}): {work}."
        least, greatest = self.bounds
        told = f"Can stand for load factors from {least:.6g} to {greatest:.6g}"
        if not self.mechanism:
            return f"{told}: nothing limits the push; {work}."
        return f"{told}, collapse: {falls}; {work}."

    def __repr__(self) -> str:
        return f"<Limit: {self}>"

    def table(self, rows: int = MOST_ROWS) -> str:
        """The velocities of the first `rows` blocks that collapse at the greatest factor, as text.

        >>> import drystone as ds
        >>> print(ds.limit(ds.scenes.column(3), push={"2": (1, 0)}).table())
          collapses   x [m/s]   y [m/s]   turns [rad/s]
         ───────────────────────────────────────────────
          2                 1         0               0
        """
        return later.table(self, rows)

    def to_dict(self) -> dict[str, Any]:
        """Everything but the scene and the forces, in types that JSON knows."""
        return {
            "status": self.status,
            "factor": finite(self.factor),
            "bounds": [finite(bound) for bound in self.bounds],
            "push": {name: list(force) for name, force in self.push.items()},
            "gravity": None if self.gravity is None else list(self.gravity),
            "lower": self.lower.to_dict(),
            "upper": self.upper.to_dict(),
            "pivots": self.pivots,
            "iterations": self.iterations,
            "seconds": self.seconds,
        }

    def write_json(self, file: TextIO) -> None:
        """Write `to_dict` as JSON to an open text file."""
        write_json(self.to_dict(), file)


def limit(
    scene: Scene,
    push: Push | None = None,
    gravity: Floats | None = None,
    blocks: Iterable[str] | None = None,
    *,
    facets: int = FACETS,
    cone: Cone = ROUND,
) -> Limit:
    """How much of a push does a structure bear, and how does it collapse beyond?

    Finds the load factors t with which it can stand under its own loads and t times the push.

    `push` gives forces on bodies (see `Push`), `gravity` an acceleration that is added to gravity,
    m/s^2: at least one of the two. `blocks` names the movable bodies of a sub-assembly, as in
    `check`; `cone` is "round", "inscribed" or "circumscribed" there, and `facets` the edges of a
    pyramid.

    The factors form an interval, `Limit.bounds`; an end is infinite where nothing limits it. "Can
    stand" means that some contact forces within the friction cones balance all loads (the static,
    or lower bound, theorem of limit analysis). Beyond the end a mechanism proves that there are
    none.

    Where blocks slide in the mechanism, they also open a little (the associated flow rule), which
    real friction does not do. The factor is then an upper bound: the structure may begin to move
    earlier. Where nothing slides, but blocks turn about corners, it is exact.

    Raises SceneError for an unknown name, a fixed body, wrong numbers or bodies that overlap.

    >>> import drystone as ds
    >>> tower = ds.scenes.column(11, friction=2.0)  # ten unit blocks on a fixed one
    >>> lim = ds.limit(tower, gravity=(9.81, 0))
    >>> round(lim.factor, 9), len(lim.mechanism)
    (0.1, 10)
    """
    names = names_of(blocks)
    cones = core_cones(facets, INSCRIBED if cone == ROUND else cone)
    scene = copy.copy(scene_of(scene))
    forces, pull = core_push(scene, push, gravity)
    core = _core.limit(scene._core, forces, pull, names, cones, cone == ROUND)
    return limit_of(core, scene, movable(scene, names), forces, pull)


def movable(scene: Scene, names: list[str] | None) -> tuple[str, ...]:
    """Those of some bodies that can move, or of all, in the order of the scene."""
    wanted = None if names is None else set(names)
    free = (body.name for body in scene.bodies if not body.fixed)
    return tuple(name for name in free if wanted is None or name in wanted)


def core_push(
    scene: Scene, push: Push | None, gravity: Floats | None
) -> tuple[CoreForces, tuple[float, ...] | None]:
    """A push as the core takes it; TypeError or SceneError for what is none."""
    if push is None and gravity is None:
        raise _core.SceneError("nothing pushes: give push= (forces on bodies) or gravity=")
    if push is not None and not isinstance(push, Mapping):
        raise TypeError(
            f"push must be a dict of forces by body, as {{'7': (100, 0)}}, not {push!r:.80}"
        )
    n = scene.dimension
    more = 1 if n == 2 else 3
    forces: CoreForces = []
    for name, force in (push or {}).items():
        wanted = f"{n} numbers of force, and {more} of moment behind them if there is one"
        given = vector(force, (n, n + more), f"the push on {name_of(name)!r}", wanted)
        moment = (*(0.0,) * (3 - more), *given[n:]) if len(given) > n else (0.0, 0.0, 0.0)
        forces.append((name, given[:n], (moment[0], moment[1], moment[2])))
    return forces, None if gravity is None else vector(gravity, n, "gravity")


def limit_of(
    core: _core.Limit,
    scene: Scene,
    names: Iterable[str],
    forces: CoreForces,
    gravity: tuple[float, ...] | None,
) -> Limit:
    """The answer, from that of the core."""
    in_plane = scene.dimension == 2
    told = {name: (*force, *(moment[2:] if in_plane else moment)) for name, force, moment in forces}
    return Limit(
        core.status,
        LimitEnd._of(core.lower),
        LimitEnd._of(core.upper),
        core.pivots,
        core.iterations,
        core.seconds,
        tuple(names),
        told,
        gravity,
        scene,
    )


def finite(value: float) -> float | None:
    """The value, or None for what JSON has no number for."""
    return value if -float("inf") < value < float("inf") else None
