"""In which order can it be taken apart so that it never collapses?"""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence

from drystone import _core
from drystone.common.cones import CONES, FACETS, core_cones
from drystone.planning.answer import Plan
from drystone.scene import Scene

TESTS = ("reuse", "reuse-dantzig", "lcp", "lp", "lp-warm")
"""The stability tests `plan` knows: see there."""

Progress = Callable[[int, int, int], None]
"""Called with (tests done, blocks placed, blocks in all) a few times a second. Before the first
test the complete assembly is checked, block by block: blocks placed are that check's."""


def plan(
    scene: Scene,
    test: str = "reuse",
    node_limit: int | None = None,
    time_limit: float | None = None,
    progress: Progress | None = None,
    shortcuts: bool = True,
    threads: int | None = None,
    hold: int = 0,
    clear_path: bool = False,
    directions: Sequence[Sequence[float]] | None = None,
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

    `node_limit` bounds the tests, `time_limit` the seconds of all, set-up too. A limit reached or
    an interrupt (Ctrl-C) is a status of the plan, which then holds the best so far.

    A test of the core that finds a sub-assembly to fall also finds how. With `shortcuts` that
    motion answers later tests it still applies to, and tells which blocks wait for one another in
    vain and how many to take back then; the order found is the same. A search of more than 20,000
    tests, or 20 a block, takes turns with another that keeps the structure as far from falling as
    it can. Without shortcuts every sub-assembly visited is tested, as in the paper.

    `threads` is how many to use, by default as many as the machine has cores; the plan is the same
    on any number. They pay where a test is long: the complete assembly is checked beside the
    search if it has 200 blocks or more, and "lcp" tests ahead what comes next if all stands. The
    tests that reuse depend on the one before, and run one after the other.

    `facets` and `cone` ("inscribed" or "circumscribed") are the friction cones in space: see
    `check`.

    If there is no order, up to `hold` blocks (at most 8) may be held at a time, by a robot's hand
    or a scaffold: a held block bears whatever acts on it. Which, is in `Plan.holds`, and there are
    as few holds as the order found allows. The block that is put up or taken away is in one more
    hand, which may go on holding it; apart from that a new block is held before an old one is let
    go. Held structures are decided as by "reuse".

    With `clear_path` every block has to leave along a straight line without passing through those
    that remain, sliding along them allowed: in one of `directions` (any length), against gravity,
    along the axes, or along or across one of its contacts; where these give no order, also square
    to one or two faces of it and of what is near. The first that is free is in `Plan.directions`.

    >>> import drystone as ds
    >>> ds.plan(ds.scenes.column(4)).found
    True
    >>> ds.plan(ds.scenes.arch(7)).status, ds.plan(ds.scenes.arch(7), hold=1).status
    ('no_order', 'found')
    """
    if hold < 0:
        raise ValueError(f"hold is {hold}: it must be zero or more")
    if directions is not None and not clear_path:
        raise ValueError("directions are for straight ways out: give clear_path=True with them")
    for limit, what in ((node_limit, "node_limit"), (time_limit, "time_limit")):
        if limit is not None and not limit >= 0:
            raise ValueError(f"{what} is {limit}: it must be zero or more")
    if threads is not None and threads < 1:
        raise ValueError(f"threads is {threads}: it must be one or more")
    cones = core_cones(facets, cone)
    scene = copy.copy(scene)  # the one planned, whatever becomes of it
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
            hold,
            [_way(scene, way) for way in directions or ()] if clear_path else None,
        ),
        test,
        scene,
        cones,
    )


def _way(scene: Scene, way: Sequence[float]) -> tuple[float, float, float]:
    """In the plane z is zero."""
    if len(way) != scene.dimension:
        raise ValueError(f"directions: {tuple(way)} must have {scene.dimension} numbers")
    x, y, z = (*way, 0.0)[:3]
    return x, y, z


def _stability_test(
    scene: Scene, test: str, cones: tuple[int, str] = (FACETS, CONES[0])
) -> str | Callable[[list[int], int], tuple[bool, int]]:
    """What the core's `plan` takes for `test`."""
    if test in ("reuse", "reuse-dantzig", "lcp"):
        return test
    if test not in TESTS:
        raise ValueError(f"unknown test {test!r}: choose one of {', '.join(TESTS)}")
    from drystone import statics

    program = statics.WarmProgram if test == "lp-warm" else statics.ColdProgram
    return program(statics.Equilibrium.of(scene, cones))
