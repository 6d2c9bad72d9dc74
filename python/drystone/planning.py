"""In which order can it be taken apart so that it never collapses?"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

from drystone import _core
from drystone.cones import CONES, FACETS, core_cones
from drystone.scene import Scene
from drystone.verdict import Verdict, counted, shorten

if TYPE_CHECKING:
    from drystone.viewer import Page

TESTS = ("reuse", "reuse-dantzig", "lcp", "lp", "lp-warm")
"""The stability tests `plan` knows: see there."""

ENDINGS = {
    "no_order": "No stable order exists",
    "whole_falls": "No order: the complete assembly does not stand",
    "test_limit": "No order yet: the limit of tests was reached",
    "time_limit": "No order yet: the time was up",
    "interrupted": "No order yet: interrupted",
}
"""What a plan's status says when there is no order."""

Progress = Callable[[int, int, int], None]
"""Called with (tests done, blocks placed, blocks in all) a few times a second. Before the first
test the complete assembly is checked, block by block: blocks placed are that check's."""


@dataclass(frozen=True, slots=True)
class TestRecord:
    """One stability test of a plan."""

    __test__ = False  # pytest: no test class, whatever its name

    size: int
    """Movable bodies in the sub-assembly tested."""
    pivots: int
    seconds: float
    stable: bool


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """The answer of `plan`."""

    found: bool
    status: str
    """"found", "no_order" (none exists), "whole_falls" (the complete assembly does not stand),
    "test_limit", "time_limit" or "interrupted"."""
    order: tuple[str, ...]
    """Names of the blocks, first removed first; empty if no order was found."""
    reached: tuple[str, ...]
    """The largest sub-assembly that was built up and stands."""
    falls_next: tuple[str, ...]
    """Without an order: the blocks any of which, added to `reached`, makes something fall."""
    tests: int
    """Stability tests of proper sub-assemblies."""
    pivots: int
    """Pivots of all these tests together."""
    test_seconds: float
    """Wall time of all these tests together."""
    seconds: float
    """Wall time of the whole search."""
    records: tuple[TestRecord, ...]
    """One entry a test, in order."""
    shortcuts: int
    """Sub-assemblies known to fall or to lead nowhere without a test, by collapses found before."""
    whole: Verdict | None
    """The verdict on the complete assembly, which is checked first and counted apart; None if a
    limit or an interrupt came before there was one."""
    test: str
    """The stability test used."""
    scene: Scene = field(repr=False)
    """The scene planned."""
    cones: tuple[int, str] = (FACETS, CONES[0])
    """In space: edges of a friction cone, and on which side of the round cone they lie."""

    @classmethod
    def _of(cls, core: _core.Plan, test: str, scene: Scene, cones: tuple[int, str]) -> Plan:
        return cls(
            core.found,
            core.status,
            tuple(core.order),
            tuple(core.reached),
            tuple(core.falls_next),
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
        )

    def __str__(self) -> str:
        work = (
            f"{counted(self.tests, 'test')}, {counted(self.pivots, 'pivot')}, "
            f"{1e3 * self.test_seconds:.3g} ms in tests of {1e3 * self.seconds:.3g} ms"
        )
        if self.found:
            return (
                f"Order found for {counted(len(self.order), 'block')}; {work}.\n"
                f"Remove first: {shorten(self.order)}."
            )
        text = f"{ENDINGS.get(self.status, self.status)}; {work}."
        text += f"\nLargest sub-assembly reached: {counted(len(self.reached), 'block')}"
        if self.falls_next:
            text += f"; it falls if any of these is added: {shorten(self.falls_next)}"
        return text + "."

    def to_dict(self) -> dict[str, Any]:
        """Everything but the scene, in types that JSON knows."""
        return {
            "found": self.found,
            "status": self.status,
            "order": list(self.order),
            "reached": list(self.reached),
            "falls_next": list(self.falls_next),
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
            "whole": None if self.whole is None else self.whole.to_dict(),
        }

    def draw(self, path: str | PathLike[str]) -> None:
        """Write a picture of the order (.svg or .png), or a page to step through it (.html)."""
        if fspath(path).lower().endswith(".html"):
            self.view().save(path)
            return
        from drystone import pictures

        pictures.save(pictures.plan_figure(self), path)

    def view(self, progress: Callable[[int, int], None] | None = None) -> Page:
        """A page that steps through the order, with the contact forces of every structure.

        Save it, or let a notebook show it. The forces are computed here; `progress` is called with
        (blocks placed, blocks in all) a few times a second.
        """
        from drystone import viewer

        return viewer.plan_page(self, progress)

    def _repr_svg_(self) -> str:
        from drystone import pictures

        return pictures.svg(pictures.plan_figure(self))


def plan(
    scene: Scene,
    test: str = "reuse",
    node_limit: int | None = None,
    time_limit: float | None = None,
    progress: Progress | None = None,
    shortcuts: bool = True,
    threads: int | None = None,
    *,
    facets: int = FACETS,
    cone: str = CONES[0],
) -> Plan:
    """Search an order of removal in which no intermediate structure collapses.

    Sub-assemblies grow from the fixed bodies upward, one block at a time and depth first; the
    order returned is the reverse. `test` decides on each sub-assembly:

    - "reuse": forces that balance the loads, on a basis of the contact forces that follows the
      search: grown by the block that is added, rolled back where the search backs up;
    - "reuse-dantzig": the contact problem by Dantzig's method, started from the solution of the
      sub-assembly it grew from, as in the paper;
    - "lcp": the same from scratch;
    - "lp": static equilibrium as a linear program, a fresh HiGHS model for every test;
    - "lp-warm": the same program in one live HiGHS model, warm-started.

    `node_limit` bounds the tests, `time_limit` the seconds. A limit reached or an interrupt
    (Ctrl-C) is a status of the plan, which then holds the best so far.

    A test of the core that finds a sub-assembly to fall also finds how. With `shortcuts` that
    motion answers later tests it still applies to, and tells which blocks wait for one another in
    vain and how many to take back then; the order found is the same. Without, every sub-assembly
    visited is tested, as in the paper.

    `threads` is how many to use, by default as many as the machine has cores; the plan is the same
    on any number. They pay where a test is long: the complete assembly is checked beside the
    search if it has 200 blocks or more, and "lcp" tests ahead what comes next if all stands. The
    tests that reuse depend on the one before, and run one after the other.

    `facets` and `cone` ("inscribed" or "circumscribed") are the friction cones in space: see
    `check`.

    >>> import drystone as ds
    >>> ds.plan(ds.scenes.column(4)).found
    True
    """
    for limit, what in ((node_limit, "node_limit"), (time_limit, "time_limit")):
        if limit is not None and not limit >= 0:
            raise ValueError(f"{what} is {limit}: it must be zero or more")
    if threads is not None and threads < 1:
        raise ValueError(f"threads is {threads}: it must be one or more")
    cones = core_cones(facets, cone)
    return Plan._of(
        _core.plan(
            scene._core,
            _stability_test(scene, test, cones),
            node_limit,
            time_limit,
            progress,
            shortcuts,
            threads,
            cones,
        ),
        test,
        scene,
        cones,
    )


def _stability_test(
    scene: Scene, test: str, cones: tuple[int, str] = (FACETS, CONES[0])
) -> str | Callable[[list[int], int], tuple[bool, int]]:
    """What the core's `plan` takes for `test`."""
    if test in ("reuse", "reuse-dantzig", "lcp"):
        return test
    from drystone import statics

    if test == "lp":
        return statics.ColdProgram(statics.Equilibrium.of(scene, cones))
    if test == "lp-warm":
        return statics.WarmProgram(statics.Equilibrium.of(scene, cones))
    raise ValueError(f"unknown test {test!r}: choose one of {', '.join(TESTS)}")
