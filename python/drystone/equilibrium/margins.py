"""How far a structure is from falling: sideways, tilted, and with less friction."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Final, Literal, TextIO, TypeAlias, cast

from drystone import _core
from drystone.common import later
from drystone.common.cones import FACETS, INSCRIBED, ROUND, Cone, core_cones
from drystone.common.drawn import Answer
from drystone.common.json_text import write_json
from drystone.common.numbers import names_of, number
from drystone.common.text import MOST_ROWS, counted, place, shorten
from drystone.equilibrium.limits import LimitEnd, finite, limit, movable
from drystone.scene import Scene
from drystone.scene.scene import scene_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from drystone.equilibrium.contact_force import ContactForces

LoadsUnder: TypeAlias = Literal["stay", "turn"]
STAY: Final = "stay"
TURN: Final = "turn"
"""What permanent loads do while a structure is accelerated or tilted."""

TOLERANCE = 1e-3
"""How far the boundary may be off, in g, without a choice."""


class Margin(Answer):
    """The answer of `margin`."""

    __slots__ = (
        "_asked",
        "_friction",
        "acceleration",
        "axes",
        "boundary",
        "direction",
        "end",
        "names",
        "questions",
        "scene",
        "status",
        "tilt",
    )

    status: str
    """"solved", or why the solver stopped without an answer."""
    acceleration: float
    """The least horizontal acceleration that brings it down, over all directions, in parts of
    gravity (0.3 is 0.3 g). Infinite if none does, 0 if it falls anyway. In space it is known to
    `tolerance`: with this acceleration it falls, with one smaller by `tolerance` it stands."""
    direction: tuple[float, ...]
    """Unit vector: where this acceleration pushes every block (the ground is accelerated the other
    way). Zero if it falls anyway."""
    tilt: float | None
    """The least angle, rad, by which the ground can be tilted until it falls. None in space where
    the structure has loads that stay."""
    end: LimitEnd
    """Forces and mechanism there; see `LimitEnd`."""
    axes: tuple[tuple[float, ...], tuple[float, ...]]
    """The horizontal unit vectors along which `boundary` is given; the same twice in the plane."""
    boundary: NDArray[np.float64]
    """(n, 2): points around the origin, in parts of gravity, along `axes`. It stands with an
    acceleration inside their polygon and falls with one outside; the true boundary is at most
    `tolerance` outside of the polygon. Two points in the plane. Nothing beyond 1e6 g is looked
    for."""
    questions: int
    """How many load factors were computed for it."""
    names: tuple[str, ...]
    """The movable bodies that are there."""
    scene: Scene
    """The scene asked about."""

    def __init__(
        self,
        core: _core.Margin,
        names: tuple[str, ...],
        scene: Scene,
        asked: tuple[list[str] | None, tuple[int, str], bool],
    ) -> None:
        self.status = core.status
        self.acceleration = core.acceleration
        self.direction = core.direction
        self.tilt = core.tilt
        self.end = LimitEnd._of(core.end)
        self.axes = core.axes
        self.boundary = core.boundary
        self.questions = core.questions
        self.names, self.scene = names, scene
        self._asked, self._friction = asked, None

    _asked: tuple[list[str] | None, tuple[int, str], bool]
    _friction: float | None

    @property
    def mechanism(self) -> dict[str, NDArray[np.float64]]:
        """How it collapses; see `LimitEnd.mechanism`."""
        return self.end.mechanism

    @property
    def forces(self) -> ContactForces | None:
        """The contact forces at the limit; None if it falls anyway."""
        return self.end.forces if self.acceleration > 0.0 else None

    @property
    def friction(self) -> float:
        """The factor by which all coefficients of friction can be multiplied so that it just
        stands, to 1e-9. Below 1 if it stands: 0.7 means that with 70 % of the friction it still
        would. Infinite if no friction helps. Computed when first read."""
        if self._friction is None:
            names, cones, round_cones = self._asked
            self._friction = _core.least_friction(self.scene._core, names, cones, round_cones)
        return self._friction

    def density(self, name: str) -> tuple[float, float] | None:
        """Between which densities of the body called `name` all stands, as `Body.density` counts:
        kg/m^2, in space kg/m^3. From 0 where it could be left without weight, to infinity where no
        weight is too much; None if it stands with none. The loads of bodies stay as they are.

        Raises SceneError for a body that is not there or fixed.
        """
        names, (facets, inner), round_cones = self._asked
        body = self.scene.body(name)
        weight = [body.mass * g for g in self.scene.gravity]
        arm = [x - y for x, y in zip(body.center_of_mass, body.centroid, strict=True)]
        cone = cast(Cone, ROUND if round_cones else inner)
        push = {name: (*weight, *_moment(arm, weight))}
        found = limit(self.scene, push, blocks=names, facets=facets, cone=cone)
        low, high = (body.density * (1.0 + t) for t in found.bounds)
        return (max(low, 0.0), high) if high >= 0.0 else None

    def __str__(self) -> str:
        moving = f"{len(self.mechanism)} of {counted(len(self.names), 'block')}"
        falls = f"{moving} ({shorten(self.mechanism)})"
        if self.status != "solved":
            return f"No answer ({self.status})."
        if self.acceleration == 0.0:
            return f"No margin, it falls: {falls}."
        if not self.mechanism:
            return "No horizontal acceleration brings it down."
        told = f"Falls at {self.acceleration:.6g} g towards {place(self.direction, 3)}: {falls}"
        if self.tilt is None:
            return f"{told}."
        return f"{told}; tilted by {self.tilt:.6g} rad ({math.degrees(self.tilt):.3g} degrees)."

    def __repr__(self) -> str:
        return f"<Margin: {self}>"

    def table(self, rows: int = MOST_ROWS) -> str:
        """The velocities of the first `rows` blocks that collapse, as text."""
        return later.table(self, rows)

    def to_dict(self) -> dict[str, Any]:
        """Everything but the scene and the forces, in types that JSON knows."""
        return {
            "status": self.status,
            "acceleration": finite(self.acceleration),
            "direction": list(self.direction),
            "tilt": self.tilt,
            "friction": finite(self.friction),
            "mechanism": self.end.to_dict()["mechanism"],
            "axes": [list(axis) for axis in self.axes],
            "boundary": self.boundary.tolist(),
            "questions": self.questions,
        }

    def write_json(self, file: TextIO) -> None:
        """Write `to_dict` as JSON to an open text file."""
        write_json(self.to_dict(), file)


def _moment(arm: Sequence[float], force: Sequence[float]) -> tuple[float, ...]:
    """Of a force on an arm: one number in the plane, three in space."""
    x, y, *z = arm
    a, b, *c = force
    turn = x * b - y * a
    return (y * c[0] - z[0] * b, z[0] * a - x * c[0], turn) if z else (turn,)


def margin(
    scene: Scene,
    blocks: Iterable[str] | None = None,
    *,
    loads: LoadsUnder = STAY,
    tolerance: float = TOLERANCE,
    facets: int = FACETS,
    cone: Cone = ROUND,
) -> Margin:
    """How far is a structure from falling?

    Finds the least horizontal acceleration that brings it down, over all directions; how far the
    ground can be tilted; and how much friction it needs. `blocks`, `facets` and `cone` are as in
    `limit`, and "can stand" means the same.

    `loads` says what permanent loads do. With "stay" they keep their direction and size, like the
    pull of a rope. With "turn" they count as weights: they turn with gravity and are accelerated.

    `tolerance` is how far the boundary in space may be off, in parts of gravity. In the plane there
    are only two directions, and the answers are exact.

    Raises SceneError without gravity, for loads that are to turn and are no weights, and for what
    `limit` does.

    >>> import drystone as ds
    >>> m = ds.margin(ds.scenes.column(11, friction=2.0))
    >>> round(m.acceleration, 6), round(m.tilt, 6), m.friction
    (0.1, 0.099669, 0.0)
    """
    if loads not in (STAY, TURN):
        raise ValueError(f'unknown loads {loads!r}: give "{STAY}" or "{TURN}"')
    off = number(tolerance, "tolerance")
    if not 1e-9 <= off <= 1.0:
        raise _core.SceneError(f"tolerance is {off}: it must be from 1e-9 to 1 (of g)")
    names = names_of(blocks)
    cones = core_cones(facets, INSCRIBED if cone == ROUND else cone)
    scene = copy.copy(scene_of(scene))
    round_cones = cone == ROUND
    core = _core.margin(scene._core, names, loads == TURN, off, cones, round_cones)
    return Margin(core, movable(scene, names), scene, (names, cones, round_cones))
