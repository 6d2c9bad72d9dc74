"""Does it stand? Forces if it does, and how it begins to fall if it does not."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal, TextIO, TypeAlias

from drystone import _core
from drystone.common import later
from drystone.common.cones import CONES, FACETS, ROUND, ConeOfCheck, core_cones
from drystone.common.drawn import Answer
from drystone.common.json_text import Rows, write_json
from drystone.common.numbers import names_of, whole, word
from drystone.common.text import MOST_ROWS, counted, shorten
from drystone.equilibrium.bearing import Explanation, Unsupported
from drystone.equilibrium.contact_force import (
    CANONICAL,
    ContactForce,
    ContactForces,
    WhichForces,
    which_forces,
)
from drystone.equilibrium.settled import Settled
from drystone.equilibrium.strong import Escape, Progress
from drystone.scene import NearMiss, Scene
from drystone.scene.scene import scene_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Method: TypeAlias = Literal["equilibrium", "interior", "lcp"]
"""How `check` finds its answer."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Verdict(Answer):
    """The answer of `check`. It is true where it is `stable`: `if drystone.check(scene): ...`."""

    stable: bool
    """Whether some contact forces within the friction cones balance every block.

    Without friction such a structure stands. With friction it can stand: one without such forces
    certainly falls, but one that has them may still find a way to move."""
    status: str
    """"solved"; "borderline" if it could be proved neither that it stands nor that it falls (see
    `doubt`); or why the solver stopped without an answer. `stable` is False unless it is solved.

    "Stands" is proved by forces within the cones that balance each block: what they leave is at
    most 1e-9 of the largest force on the block, and 1e-6 of its own load. "Falls" is proved by a
    motion that closes no contact and in which the loads do work: at least ten times as much as
    rounding of the forces could. Where both or neither seem to hold, the numbers are computed
    again with 32 digits."""
    forces: ContactForces
    """The contact forces, one entry for each contact point; computed when first read.

    Where whole faces meet, many sets of forces hold the same structure up. This is the one of least
    norm, which thin elastic layers between the faces would find (docs/theory/canonical-forces.md).
    There is only one. It is as symmetric as the structure and its loads, and does not depend on the
    method or on the order of the blocks. Of a structure that falls it is the set of least norm
    under which the blocks have their `accelerations`.

    With `check(..., forces="any")` these are the forces that the verdict was found with."""
    names: tuple[str, ...]
    """The movable bodies checked, in the order of the rows of `accelerations`."""
    accelerations: NDArray[np.float64]
    """(bodies, 3): x and y in m/s^2, and the angular one in rad/s^2, counter-clockwise. In space
    (bodies, 6): x, y and z, and the angular ones about x, y and z.

    Zero if and only if stable. Exact without friction, and where contacts open or stick. Where a
    contact slides with friction they are those of a convex model (maximum dissipation), in which a
    sliding contact also opens. So a block on a slope of angle a accelerates by g sin(a - phi), in a
    direction that leaves the slope by the angle phi = atan(friction). By Coulomb's law, which
    `simulate` has, it would be g (sin a - friction cos a) along the slope."""
    falling: tuple[str, ...]
    """Names of the bodies that accelerate."""
    pivots: int
    """Major plus minor cycles, as in the paper's Table I."""
    major_cycles: int
    minor_cycles: int
    iterations: int
    """Matrices factored by the interior-point method. Zero if pivots alone gave the answer."""
    residual: float
    """How far the computed solution is from satisfying its problem, in the problem's own scale."""
    virtual_motion: bool
    """True if it is proved *that* it falls, but the true accelerations could not be computed (where
    masses differ by 1e7 and more). `accelerations` are then those along the motion that proves the
    fall, and `falling` are the blocks that move in it."""
    doubt: tuple[float, float] | None
    """Of a borderline verdict two numbers: the least imbalance that any forces leave, as a share of
    a block's load; and the power of the collapse, as a multiple of what rounding could make of the
    forces. None of any other verdict."""
    seconds: float
    """Wall time of the solve."""
    scene: Scene = field(repr=False)
    """The scene checked."""
    certain: bool = True
    """Whether the verdict is also that of Coulomb's round cones. False only where pyramids were
    asked for, in space, and their edges may have decided: see `cone` of `check`. It is
    said of `stable`; `must_stand` is None where it is not certain."""
    must_stand: bool | None = None
    """With `strong=True` in `check`: whether rest is the only motion that the contact laws allow.
    False if there is another one, see `escape`, or if it does not stand at all. None if it was not
    asked, or not decided within the budget of the search."""
    escape: Escape | None = None
    """A motion that obeys every law of contact, where there is one beside rest. Of a structure that
    does not stand, one of those with which it begins to fall, by Coulomb's friction."""
    nodes: int | None = None
    """With `strong=True`: nodes of the search, the same in every run; see
    docs/theory/strong-stability.md."""
    settled: Settled | None = None
    """How the blocks follow the settlements of the scene's supports (`Scene.add_settlement`): which
    hinges open, and the forces after it. None if there are none, or if it does not stand."""

    @classmethod
    def _of(
        cls,
        core: _core.Verdict,
        scene: Scene,
        cone: str = CONES[0],
        forces: WhichForces = CANONICAL,
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

    def __bool__(self) -> bool:
        return self.stable

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
        """The forces at places where only borders meet: a corner and a corner, in space also two
        edges along one another, or a corner and an edge. Their normals are those of slightly
        rounded borders; perfectly sharp bodies could slip there, however small the push."""
        return self.forces.at_borders

    @property
    def unsupported(self) -> tuple[Unsupported, ...]:
        """The falling blocks that nothing carries from below, each with the nearest body that it
        does not touch. Empty if the structure stands; computed when read."""
        return self._explanation().unsupported

    @property
    def near_misses(self) -> tuple[NearMiss, ...]:
        """Pairs of bodies, one of them falling, that would touch if the contact tolerance were ten
        times larger. Empty if the structure stands; computed when read."""
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
            blocks = counted(len(self.names), "block")
            standing = f"{self._standing()}: {blocks}, {points}; {work}{self._searched()}."
            return standing if self.settled is None else f"{standing}\n{self.settled}"
        blocks = f"{len(self.falling)} of {counted(len(self.names), 'block')}"
        fall = f"Falls: {blocks} ({shorten(self.falling)}); {work}."
        return "\n".join([fall, *self._explanation().lines()])

    def _standing(self) -> str:
        if self.nodes is None:
            return "Stands"
        if self.must_stand is None:
            return "Can stand, undecided whether it must"
        if self.must_stand or self.escape is None:
            return "Must stand"
        moving = shorten(self.escape.falling)
        return f"Can stand, need not (it can begin to move with {moving})"

    def _searched(self) -> str:
        return "" if self.nodes is None else f", {counted(self.nodes, 'node')}"

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
            **self._strong_to_dict(),
            **({} if self.settled is None else {"settled": self.settled.to_dict()}),
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

    def _strong_to_dict(self) -> dict[str, Any]:
        """Nothing unless it was asked for."""
        if self.nodes is None:
            return {}
        escape = None if self.escape is None else self.escape.to_dict()
        return {"must_stand": self.must_stand, "nodes": self.nodes, "escape": escape}

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


def check(
    scene: Scene,
    blocks: Iterable[str] | None = None,
    method: Method = "equilibrium",
    *,
    facets: int = FACETS,
    cone: ConeOfCheck = ROUND,
    forces: WhichForces = CANONICAL,
    strong: bool = False,
    strong_budget: int | None = None,
    progress: Progress | None = None,
) -> Verdict:
    """Does `scene` stand? With which contact forces, or how does it begin to fall?

    `blocks` names the movable bodies that are there; fixed bodies always are. By default every
    body is.

    `method` says how the answer is found; all give the same verdict:

    - "equilibrium" looks for forces that balance the loads: by pivots, block by block from the
      supports, as long as that is easy, and otherwise by the interior-point method;
    - "interior" takes the interior-point method at once;
    - "lcp" solves the complementarity problem by Dantzig's method, as the paper does.

    `forces` says which of the many sets of forces that may hold a redundant structure are given:
    the unique one of least norm ("canonical"), or the one that the method happened to find ("any").
    See `Verdict.forces`.

    `cone` says which friction cones are taken in space:

    - "round": Coulomb's cones as they are ("lcp" cannot, and takes "inscribed");
    - "inscribed": pyramids of `facets` edges within them: what stands with these stands with round
      cones;
    - "circumscribed": pyramids around them: what falls with these falls with round cones;
    - "both": the inscribed ones and, if it falls with them, the circumscribed ones too.
      `Verdict.certain` is then False only if the two differ.

    The more facets, the smaller the difference; it shrinks as 1 - cos(pi / facets).

    Raises SceneError for an unknown name, or bodies that overlap.

    Where supports settle (`Scene.add_settlement`), `Verdict.settled` says how the blocks follow.

    "It stands" says that it *can*: forces exist that hold it. With `strong=True` it is decided as
    well whether it *must* (`Verdict.must_stand`): whether rest is the only motion that the laws of
    contact allow (strong stability: Pang and Trinkle 2000). A block that hangs between two walls
    can also fall, which `Verdict.escape` then is. A search through what parts, slides and rests
    decides it, or ends after some twenty seconds' work, counted in operations so that it is the
    same in every run; with `strong_budget` after so many nodes, however long they take. Ended so,
    `must_stand` is None. `progress` is called now and then meanwhile: see
    `drystone.equilibrium.strong.Progress`. In space nothing is searched: that it must stand is said
    of what stands without friction, that it need not where a step from rest finds another motion.

    >>> import drystone as ds
    >>> verdict = ds.check(ds.scenes.column(4), strong=True)
    >>> verdict.stable, verdict.must_stand
    (True, True)
    """
    if strong_budget is not None and whole(strong_budget, "strong_budget") < 1:
        raise ValueError(f"strong_budget is {strong_budget}: it must be one node or more")
    if progress is not None and not callable(progress):
        raise TypeError(f"progress must be a function, not {progress!r:.80}")
    names = names_of(blocks)
    scene = copy.copy(scene_of(scene))  # the one checked, whatever becomes of it
    facets, _ = core_cones(facets, cone, (ROUND, *CONES))
    round_cone = cone == ROUND and method != "lcp"
    inner = CONES[0] if cone in ("both", ROUND) else cone
    core = _core.check(scene._core, names, word(method, "method"), (facets, inner), round_cone)
    verdict = Verdict._of(core, scene, ROUND if round_cone else inner, which_forces(forces))
    if cone == "both" and verdict.status == "solved" and not verdict.certain:
        outer = _core.check(scene._core, names, method, (facets, CONES[1]))
        if outer.status == "solved" and not outer.stable:
            verdict = replace(verdict, certain=True)
    if verdict.stable and scene.settlements:
        core_settled = _core.settle(scene._core, names, (facets, inner), round_cone)
        verdict = replace(verdict, settled=Settled._of(core_settled, scene, forces))
    return _searched(verdict, names, strong_budget, progress) if strong else verdict


def _searched(
    verdict: Verdict, names: list[str] | None, nodes: int | None, progress: Progress | None
) -> Verdict:
    """The verdict with whether it must stand."""
    found = _core.strong(verdict.scene._core, names, nodes, progress)
    solved = verdict.status == "solved"
    must = (verdict.stable and found.must_stand) if solved else None
    escape = None if found.escape is None else Escape._of(found.escape, verdict.scene)
    return replace(verdict, must_stand=must, escape=escape, nodes=found.nodes)


def _certain(core: _core.Verdict, scene: Scene, cone: str) -> bool:
    if core.status != "solved":
        return False
    if scene.dimension == 2 or cone == ROUND:
        return True
    frictionless = scene._core.largest_friction() == 0.0
    return frictionless or core.stable == (cone == CONES[0])
