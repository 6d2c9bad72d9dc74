"""The answer of `plan`: an order, what is held and whereto blocks leave, and the work it took."""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from os import PathLike
from typing import TYPE_CHECKING, Any, TextIO, cast

from drystone import _core
from drystone.common import later
from drystone.common.cones import CONES, FACETS, Cone
from drystone.common.drawn import DPI, Paged
from drystone.common.files import FILMS, JSON, PAGE, PICTURES, ending_of
from drystone.common.json_text import save_json, write_json
from drystone.common.text import MOST_ROWS, counted, shorten
from drystone.common.units import quantity
from drystone.equilibrium.contact_force import CANONICAL, WhichForces
from drystone.equilibrium.limits import finite
from drystone.equilibrium.margins import margin
from drystone.equilibrium.verdict import Verdict
from drystone.scene import Scene

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from drystone.common.later import Page

ENDINGS = {
    "no_order": "No stable order exists",
    "undecided": "No order found, though not every way to hold was tried",
    "locked": "No order: blocks lock one another in",
    "whole_falls": "No order: the complete assembly does not stand",
    "test_limit": "No order yet: the limit of tests was reached",
    "time_limit": "No order yet: the time was up",
    "interrupted": "No order yet: interrupted",
}
"""What a plan's status says when there is no order."""

STRONG_ENDINGS = {
    "no_order": "No order of structures that must stand exists",
    "undecided": "No order found; of some structures it is not decided whether they must stand",
    "whole_falls": "No order: the complete assembly need not stand",
}
"""The same where every structure must stand."""


MOST_HELD = 8
"""Blocks that may be held at a time."""


@dataclass(frozen=True, slots=True)
class TestRecord:
    """One stability test of a plan."""

    __test__ = False  # pytest: no test class, whatever its name

    size: int
    """Movable bodies in the sub-assembly tested."""
    pivots: int
    seconds: float
    stable: bool


@dataclass(frozen=True, slots=True, repr=False)
class Blocked:
    """A block that cannot leave along a straight line."""

    name: str
    ways: tuple[tuple[tuple[float, ...], tuple[str, ...]], ...]
    """For each direction looked at, a unit vector, the bodies that are in the way."""

    @property
    def by(self) -> tuple[str, ...]:
        """Every body that is in the way in some direction."""
        return tuple(dict.fromkeys(name for _, names in self.ways for name in names))

    def __repr__(self) -> str:
        ways = counted(len(self.ways), "direction")
        return f"<Blocked: {self.name!r} in {ways}, by {shorten(self.by)}>"


@dataclass(frozen=True, slots=True)
class Move:
    """A straight move of a block on its way out."""

    direction: tuple[float, ...]
    """A unit vector."""
    length: float
    """Metres. The last move of a block goes on as far as one likes: its length is how far it is
    to freedom, when the box around the block (along the axes of the world) is out of the boxes
    around all that remain."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Plan(Paged):
    """The answer of `plan`. It is true where an order was `found`."""

    found: bool
    status: str
    """How the search ended:

    - "found": there is an order;
    - "no_order": none exists, which is proved;
    - "whole_falls": the complete structure does not stand;
    - "locked", with `clear_path`: some blocks lock one another in;
    - "undecided", with `hold`: no order was found, but not every way to hold was tried, so there
      may be one;
    - "test_limit", "time_limit", "interrupted": the search was stopped. A search for the most
      robust order may have an order then: it is `found`, and another one may bear more."""
    order: tuple[str, ...]
    """Names of the blocks, first removed first; empty if no order was found."""
    reached: tuple[str, ...]
    """The blocks of the largest structure that could be built, in the order in which they were."""
    falls_next: tuple[str, ...]
    """Without an order: whichever of these blocks is added to `reached`, something falls."""
    holds: tuple[tuple[str, ...], ...]
    """`holds[k]` names the blocks that are held when the first k blocks of `order` are gone.
    Without an order the same for `reached`, taken apart backwards."""
    directions: tuple[tuple[float, ...], ...]
    """With `clear_path`: for each block of `order` the unit vector along which it leaves. Without
    an order the same for `reached`, taken apart backwards. Of two moves it is the first."""
    moves: tuple[tuple[Move, ...], ...]
    """The same with lengths, and with all moves of a block."""
    groups: tuple[tuple[str, ...], ...]
    """With `together`: the blocks that leave as one, first removed first; those of a group come one
    after the other in `order`."""
    blocked: tuple[Blocked, ...]
    """With `clear_path` and no order: the blocks that lock one another in; or, if none do, those
    that cannot be added to `reached` because something is in the way."""
    tests: int
    """How many structures were tested, the complete one not among them."""
    pivots: int
    """Pivots of all these tests together."""
    test_seconds: float
    """Wall time of all these tests together."""
    seconds: float
    """Wall time of the whole search."""
    records: tuple[TestRecord, ...]
    """One entry a test, in order."""
    shortcuts: int
    """How many structures were left out without a test, since an earlier collapse proved that they
    fall or lead nowhere."""
    whole: Verdict | None
    """The verdict on the complete structure, which is checked before the search; None if the search
    was stopped before there was one."""
    test: str
    """The stability test used."""
    scene: Scene = field(repr=False)
    """The scene planned."""
    cones: tuple[int, str] = (FACETS, CONES[0])
    """In space: the number of edges of the pyramids taken as friction cones, and whether they are
    "inscribed" or "circumscribed"."""
    margin: float = 0.0
    """The horizontal acceleration, in g, that every structure had to bear."""
    strong: bool = False
    """Whether every structure had to be one that must stand."""
    hold: int = 0
    """How many blocks might be held at a time."""
    _margins: list[float] = field(default_factory=list, repr=False)

    @classmethod
    def _of(
        cls,
        core: _core.Plan,
        test: str,
        scene: Scene,
        cones: tuple[int, str],
        margin: float = 0.0,
        strong: bool = False,
        hold: int = 0,
    ) -> Plan:
        way_out = tuple(
            tuple(Move(way[: scene.dimension], length) for way, length in moves)
            for moves in reversed(core.moves)
        )
        return cls(
            core.found,
            core.status,
            tuple(core.order),
            tuple(core.reached),
            tuple(core.falls_next),
            tuple(tuple(held) for held in reversed(core.held)),
            tuple(moves[0].direction for moves in way_out),
            way_out,
            tuple(tuple(reversed(group)) for group in reversed(core.groups)),
            tuple(
                Blocked(name, tuple((way[: scene.dimension], tuple(by)) for way, by in ways))
                for name, ways in core.blocked
            ),
            core.tests,
            core.pivots,
            core.test_seconds,
            core.seconds,
            tuple(TestRecord(r.size, r.pivots, r.seconds, r.stable) for r in core.records),
            core.shortcuts,
            None if core.whole is None else Verdict._of(core.whole, scene, cones[1]),
            test,
            scene,
            cones,
            margin,
            strong,
            hold,
        )

    def __bool__(self) -> bool:
        return self.found

    def __copy__(self) -> Plan:
        return replace(self, scene=copy.copy(self.scene), whole=copy.copy(self.whole))

    @property
    def margins(self) -> tuple[float, ...]:
        """Of every structure on the way the least horizontal acceleration that brings it down, in
        g: `margins[k]` while all but the first k blocks of `order` stand, with nothing held. As
        `drystone.margin` finds it, with the plan's cones; computed when first read. Without an
        order those of `reached`, the last put up taken away first.

        The page of a plan (`view`, `save`) shows them at each step if the plan was asked for a
        margin, or if they have been read before."""
        if not self._margins:
            blocks = self.order or self.reached[::-1]
            facets, cone = self.cones[0], cast(Cone, self.cones[1])
            every = (blocks[k:] for k in range(len(blocks)))
            found = [margin(self.scene, some, facets=facets, cone=cone) for some in every]
            self._margins.extend(one.acceleration for one in found)  # all, or none after Ctrl-C
        return tuple(self._margins)

    @property
    def margins_are_known(self) -> bool:
        """Whether `margins` have been computed."""
        return bool(self._margins)

    @property
    def next_hold(self) -> int | None:
        """The `hold` with which there may be an order where none exists: one more than was allowed.
        None if there is an order, if it is not known that there is none, or if holding is no help:
        with a margin, with `strong`, and at most 8 blocks are held."""
        alone = self.margin == 0 and not self.strong
        helps = self.status == "no_order" and alone and self.hold < MOST_HELD
        return self.hold + 1 if helps else None

    @property
    def hold_steps(self) -> list[tuple[str, str, int]]:
        """("hold" or "release", name, k): what hands do before block k of `order` is taken away.

        A new block is held before an old one is released. If the block released is the one that is
        taken away, the hand that held it carries it off. Without an order the steps are those of
        taking `reached` apart.
        """
        steps = [("hold", name, 0) for name in self.holds[0]] if self.holds else []
        for k, (held, then) in enumerate(zip(self.holds, (*self.holds, ())[1:], strict=True)):
            steps += [("hold", name, k) for name in then if name not in held]
            steps += [("release", name, k) for name in held if name not in then]
        return steps

    @property
    def assembly_order(self) -> tuple[str, ...]:
        """The order read backwards: names of the blocks, first put up first."""
        return self.order[::-1]

    def hand_forces(self) -> tuple[dict[str, NDArray[np.float64]], ...]:
        """What hands bear, for each structure of `holds`: the wrench of the hand on a held block.

        A wrench is (3,): the force, N, and the moment about the block's centre of mass, N m; in
        space (6,). Of all forces that hold the structure those of least norm (see
        `Verdict.forces`). They are computed at every call, for all structures on the way.
        """
        import numpy as np

        if not any(self.holds):
            return tuple({} for _ in self.holds)
        order = self.order or self.reached[::-1]
        held = [list(names) for names in reversed(self.holds)][-len(order) :]
        found = _core.forces_along(self.scene._core, order[::-1], 1, None, self.cones, held)
        made: list[dict[str, NDArray[np.float64]]] = [{} for _ in self.holds]
        for blocks, hands in zip(found.blocks, found.hands, strict=True):
            made[len(order) - int(blocks)] = {name: np.array(wrench) for name, wrench in hands}
        return tuple(made)

    def __str__(self) -> str:
        work = (
            f"{counted(self.tests, 'test')}, {counted(self.pivots, 'pivot')}, "
            f"{quantity(self.test_seconds, 's')} in tests of {quantity(self.seconds, 's')}"
        )
        if self.found:
            bearing = f", each bearing {self.margin:.3g} g sideways" if self.margin else ""
            bearing += ", each must stand" if self.strong else ""
            bearing += " (interrupted: another may bear more)" if self.status != "found" else ""
            return (
                f"Order found for {counted(len(self.order), 'block')}{bearing}; {work}.\n"
                f"Remove first: {shorten(self.order)}."
                f"{self._said_of_groups()}{self._said_of_holds()}"
            )
        ending = STRONG_ENDINGS.get(self.status) if self.strong else None
        if self.margin and self.status == "whole_falls":
            ending = "No order: the complete assembly does not bear it"
        text = f"{ending or ENDINGS.get(self.status, self.status)}; {work}."
        if self.margin:
            text = f"With a margin of {self.margin:.3g} g: {text[0].lower()}{text[1:]}"
        if self.status == "whole_falls" and self.whole is not None and not self.whole.stable:
            # What its blocks do not bear on; its own first line says no more than this one.
            text += "".join(f"\n{line}" for line in str(self.whole).splitlines()[1:])
        text += f"\nLargest sub-assembly reached: {counted(len(self.reached), 'block')}"
        if self.falls_next:
            text += f"; it falls if any of these is added: {shorten(self.falls_next)}"
        if self.blocked:
            stuck = (f"{one.name} (blocked by {shorten(one.by)})" for one in self.blocked)
            text += f"; cannot leave: {shorten(stuck)}"
        text += "." + self._said_of_holds()
        if self.next_hold is not None:
            text += f"\nIf blocks may be held there may be an order: hold={self.next_hold}."
        return text

    def __repr__(self) -> str:
        return f"<Plan: {str(self).splitlines()[0]}>"

    def table(self, rows: int = MOST_ROWS) -> str:
        """The first `rows` steps of the order as text: what is removed, held, and whereto."""
        return later.table(self, rows)

    def _said_of_groups(self) -> str:
        groups = " and ".join(shorten(group) for group in self.groups)
        return f"\nTogether leave {groups}." if groups else ""

    def _said_of_holds(self) -> str:
        steps = [name for action, name, _ in self.hold_steps if action == "hold"]
        if not steps:
            return ""
        at_once = max(len(held) for held in self.holds)
        return f"\nTakes {counted(len(steps), 'hold')}, at most {at_once} at a time."

    def to_dict(self) -> dict[str, Any]:
        """Everything but the scene, in types that JSON knows."""
        return self._told(None if self.whole is None else self.whole.to_dict())

    def write_json(self, file: TextIO) -> None:
        """Write `to_dict` as JSON to an open text file, piece by piece."""
        write_json(self._told(None if self.whole is None else self.whole._streamed()), file)

    def _told(self, whole: object) -> dict[str, Any]:
        return {
            "found": self.found,
            "status": self.status,
            "order": list(self.order),
            "assembly_order": list(self.assembly_order),
            "reached": list(self.reached),
            "falls_next": list(self.falls_next),
            "holds": [list(held) for held in self.holds] if any(self.holds) else [],
            **(
                {"margin": self.margin, "margins": [finite(m) for m in self.margins]}
                if self.margin
                else {}
            ),
            **({"strong": True} if self.strong else {}),
            "hold": self.hold,
            "hold_steps": [list(step) for step in self.hold_steps],
            "directions": [list(direction) for direction in self.directions],
            "moves": [
                [{"direction": list(move.direction), "length": move.length} for move in moves]
                for moves in self.moves
            ],
            "groups": [list(group) for group in self.groups],
            "blocked": [
                {
                    "name": one.name,
                    "ways": [{"direction": list(way), "by": list(by)} for way, by in one.ways],
                }
                for one in self.blocked
            ],
            "test": self.test,
            "tests": self.tests,
            "shortcuts": self.shortcuts,
            "pivots": self.pivots,
            "test_seconds": self.test_seconds,
            "seconds": self.seconds,
            "records": [
                {"size": r.size, "pivots": r.pivots, "seconds": r.seconds, "stable": r.stable}
                for r in self.records
            ],
            "whole": whole,
        }

    def save(self, path: str | PathLike[str], *, dpi: float = DPI) -> None:
        """Write everything but the scene (.json), a page to step through (.html), a film (.gif,
        .mp4) or a picture (.svg, .pdf, .png)."""
        ending = ending_of(path, (JSON, *PICTURES, PAGE, *FILMS))
        if ending == JSON:
            save_json(self, path)
        elif ending in FILMS:
            later.film(self, path, dpi)
        else:
            self.draw(path, dpi=dpi)

    def view(
        self, progress: Callable[[int, int], None] | None = None, *, forces: WhichForces = CANONICAL
    ) -> Page:
        """A page that steps through the order, with the contact forces of every structure.

        Save it, or let a notebook show it. The forces are computed now: those of least norm (see
        `Verdict.forces`), of long plans only for every second, third, ... structure. With
        `forces="any"` they are those found first, which takes less time. `progress` is called a few
        times a second with (blocks placed, blocks in all).
        """
        return later.page(self, progress, forces)
