"""Does it stand? Forces if it does, and how it begins to fall if it does not."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from os import PathLike
from typing import TYPE_CHECKING, Any, TextIO

from drystone import _core
from drystone.common import later
from drystone.common.cones import CONES, FACETS, ROUND, core_cones
from drystone.common.json_text import Rows, write_json
from drystone.common.text import MOST_ROWS, counted, shorten
from drystone.equilibrium.bearing import Explanation, Unsupported
from drystone.equilibrium.contact_force import CANONICAL, ContactForce, ContactForces, which_forces
from drystone.scene import NearMiss, Scene

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Verdict:
    """The answer of `check`."""

    stable: bool
    """An equilibrium within the friction cones exists. Without friction this is sufficient for
    standing; with friction it is necessary."""
    status: str
    """"solved"; "borderline" if neither is proved, that it stands or that it falls (see `doubt`);
    or why the solver stopped without an answer. `stable` is False unless it is solved.

    It stands if forces within the cones leave each block an imbalance of at most 1e-9 of the
    largest force on it and 1e-6 of its own load. It falls if there is a motion that closes no
    contact in which the loads do work by more than ten times what rounding could make of the
    forces. Residuals are refined to 32 digits before both, or neither, are said to hold."""
    forces: ContactForces
    """One entry a contact point of the bodies checked; computed when first read.

    Where faces meet, many forces hold a structure. These are the unique ones of least norm: of all
    that do within the friction cones those that elastic layers between the faces would bear
    (docs/theory/canonical-forces.md). They are as symmetric as the structure and its loads, and
    the same for every method and order. Of what falls they are the ones of least norm under which
    it has its `accelerations`. With `forces="any"` in `check` they are those that the verdict was
    found with."""
    names: tuple[str, ...]
    """The movable bodies checked, in the order of the rows of `accelerations`."""
    accelerations: NDArray[np.float64]
    """(bodies, 3): x and y in m/s^2, and the angular one in rad/s^2, counter-clockwise. In space
    (bodies, 6): x, y and z, and the angular ones about x, y and z.

    Zero if and only if stable. Where a contact with friction slides they are those of the convex
    model (maximum dissipation), in which it also opens: a block on a slope of angle a accelerates
    by g sin(a - phi) in the direction phi = atan(friction) off the slope, not by Coulomb's
    g (sin a - friction cos a) along it."""
    falling: tuple[str, ...]
    """Names of the bodies that accelerate."""
    pivots: int
    """Major plus minor cycles, as in the paper's Table I."""
    major_cycles: int
    minor_cycles: int
    iterations: int
    """Of the interior-point method: matrices factored. Zero where pivots alone gave the answer."""
    residual: float
    """How far the computed solution is from satisfying its problem, in the problem's scale."""
    virtual_motion: bool
    """What falls is known, but not how it begins to: `accelerations` are those along a motion that
    proves the fall, and `falling` are the blocks that move in it. So where masses differ by 1e7 and
    more, and the complementarity problem cannot be solved to an accuracy that tells."""
    doubt: tuple[float, float] | None
    """Of a borderline verdict: the least imbalance that any forces leave, in the load of a block,
    and the power of the collapse, as a multiple of what rounding could make of the forces."""
    seconds: float
    """Wall time of the solve."""
    scene: Scene = field(repr=False)
    """The scene checked."""
    certain: bool = True
    """Whether Coulomb's round cone has the same verdict. True in the plane, without friction and
    with round cones, and of what stands within inscribed pyramids or falls within circumscribed
    ones. False where the pyramids' edges may have decided: see `cone` of `check`."""

    @classmethod
    def _of(
        cls, core: _core.Verdict, scene: Scene, cone: str = CONES[0], forces: str = CANONICAL
    ) -> Verdict:
        return cls(
            core.stable,
            core.status,
            ContactForces(core.forces, forces),
            tuple(core.names),
            core.accelerations,
            tuple(core.falling),
            core.pivots,
            core.major_cycles,
            core.minor_cycles,
            core.iterations,
            core.residual,
            core.virtual_motion,
            core.doubt,
            core.seconds,
            scene,
            _certain(core, scene, cone),
        )

    def __copy__(self) -> Verdict:
        return replace(self, scene=copy.copy(self.scene))

    def acceleration(self, name: str) -> NDArray[np.float64]:
        """The row of `accelerations` of the body called `name`, in m/s^2 and rad/s^2."""
        try:
            row: NDArray[np.float64] = self.accelerations[self.names.index(name)]
        except ValueError:
            raise _core.SceneError(f"{name!r} is not a movable body of this check") from None
        return row

    @property
    def borders(self) -> tuple[ContactForce, ...]:
        """The forces that need the normal of slightly rounded borders: those that bear where a
        corner meets a corner, or in space an edge an edge along it or a corner an edge. Sharp
        bodies could slip there, however small the push."""
        return self.forces.at_borders

    @property
    def unsupported(self) -> tuple[Unsupported, ...]:
        """The falling blocks that nothing bears from below, each with the nearest of the bodies
        that it does not touch. Looked for when asked for; empty of what stands."""
        return self._explanation().unsupported

    @property
    def near_misses(self) -> tuple[NearMiss, ...]:
        """Pairs of bodies of which one falls and that do not touch, but would with a contact
        tolerance ten times larger. Looked for when asked for; empty of what stands."""
        return self._explanation().near_misses

    def _explanation(self) -> Explanation:
        return Explanation.of(self.scene._core, self.names, self.falling)

    def __str__(self) -> str:
        work = counted(self.pivots, "pivot") if self.pivots or not self.iterations else ""
        if self.iterations:
            work += (", " if work else "") + counted(self.iterations, "iteration")
        work += f", residual {self.residual:.1e}"
        if self.doubt is not None:
            imbalance, power = self.doubt
            return (
                f"Borderline, neither standing nor falling is proved: forces leave {imbalance:.1e}"
                f" of a block's load, a fall has {power:.1e} times the power of rounding; {work}."
            )
        if self.status != "solved":
            return f"No answer ({self.status}): {work}."
        if not self.certain:
            work += "; undecided between inscribed and circumscribed friction cones"
        if self.stable:
            points = counted(len(self.forces), "contact point")
            if self.borders:
                points += f" ({len(self.borders)} bearing where only corners or edges meet)"
            return f"Stands: {counted(len(self.names), 'block')}, {points}; {work}."
        blocks = f"{len(self.falling)} of {counted(len(self.names), 'block')}"
        fall = f"Falls: {blocks} ({shorten(self.falling)}); {work}."
        return "\n".join([fall, *self._explanation().lines()])

    def __repr__(self) -> str:
        return f"<Verdict: {str(self).splitlines()[0]}>"

    def to_dict(self) -> dict[str, Any]:
        """Everything but the scene, in types that JSON knows."""
        lines = self.forces.json_lines()
        return self._told([force for some in lines for force in json.loads(f"[{some}]")])

    def write_json(self, file: TextIO) -> None:
        """Write `to_dict` as JSON to an open text file, piece by piece: forces and accelerations
        of a large scene are never in memory as objects."""
        write_json(self._streamed(), file)

    def _streamed(self) -> dict[str, Any]:
        return self._told(Rows(self.forces.json_lines()))

    def _told(self, forces: object) -> dict[str, Any]:
        return {
            "stable": self.stable,
            "status": self.status,
            "certain": self.certain,
            "virtual_motion": self.virtual_motion,
            "doubt": None if self.doubt is None else list(self.doubt),
            "falling": list(self.falling),
            **self._explanation().to_dict(),
            "accelerations": {
                name: row.tolist() for name, row in zip(self.names, self.accelerations, strict=True)
            },
            "forces_kind": self.forces.kind,
            "forces": forces,
            "pivots": self.pivots,
            "major_cycles": self.major_cycles,
            "minor_cycles": self.minor_cycles,
            "iterations": self.iterations,
            "residual": self.residual,
            "seconds": self.seconds,
        }

    def table(self, rows: int = MOST_ROWS) -> str:
        """The first `rows` forces of what stands, or accelerations of what falls, as text.

        >>> import drystone as ds
        >>> print(ds.check(ds.scenes.column(2)).table())
          contact      x [m]   y [m]   normal [N]   tangential [N]
         ──────────────────────────────────────────────────────────
          ground - 1    -0.5       0        4.905                0
          ground - 1     0.5       0        4.905                0
        """
        return later.table(self, rows)

    def draw(self, path: str | PathLike[str]) -> None:
        """Write a picture of the forces, or of the fall; the name ends in .svg or .png."""
        later.save_figure(later.figure(self), path)

    def _repr_svg_(self) -> str | None:
        return later.svg_if_possible(self)


def check(
    scene: Scene,
    blocks: Iterable[str] | None = None,
    method: str = "equilibrium",
    *,
    facets: int = FACETS,
    cone: str = ROUND,
    forces: str = CANONICAL,
) -> Verdict:
    """Compute the contact forces and accelerations of `scene` at rest.

    `blocks` names the movable bodies of a sub-assembly; fixed bodies are always there. By default
    every body is. Raises SceneError for an unknown name or bodies that overlap.

    `method` "equilibrium" looks for forces that balance the loads: by pivots, block by block from
    the supports, as long as these are easy to find, else by the interior-point method, which gives
    the accelerations of what falls as well. "interior" takes the interior-point method in any case.
    "lcp" solves the complementarity problem by Dantzig's method, as the paper does. The verdict is
    the same, and so are the forces unless `forces` is "any": then they are those that the method
    has found, of the many that hold a redundant structure; see `Verdict.forces`.

    In space `cone` "round" takes Coulomb's cones as they are. The others are pyramids of `facets`
    edges: "inscribed" ones lie within the round cones, so that a structure is never said to stand
    because of them; "circumscribed" ones lie around, so that none is said to fall because of them.
    "both" asks the inscribed ones first and, if it falls there, the circumscribed ones: `certain`
    is then false only where the two differ. More facets narrow that gap as 1 - cos(pi / facets).
    "lcp" knows pyramids only, and takes inscribed ones for "round".

    >>> import drystone as ds
    >>> verdict = ds.check(ds.scenes.column(4))
    >>> verdict.stable
    True
    """
    if isinstance(blocks, str):
        raise _core.SceneError(f"blocks must be a list of names, not the string {blocks!r}")
    names = None if blocks is None else list(blocks)
    scene = copy.copy(scene)  # the one checked, whatever becomes of it
    core_cones(facets, cone, (ROUND, *CONES))
    round_cone = cone == ROUND and method != "lcp"
    inner = CONES[0] if cone in ("both", ROUND) else cone
    core = _core.check(scene._core, names, method, (facets, inner), round_cone)
    verdict = Verdict._of(core, scene, ROUND if round_cone else inner, which_forces(forces))
    if cone == "both" and verdict.status == "solved" and not verdict.certain:
        outer = _core.check(scene._core, names, method, (facets, CONES[1]))
        if outer.status == "solved" and not outer.stable:
            return replace(verdict, certain=True)
    return verdict


def _certain(core: _core.Verdict, scene: Scene, cone: str) -> bool:
    if core.status != "solved":
        return False
    if scene.dimension == 2 or cone == ROUND:
        return True
    frictionless = scene._core.largest_friction() == 0.0
    return frictionless or core.stable == (cone == CONES[0])
