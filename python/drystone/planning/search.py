"""In which order can it be taken apart so that it never collapses?"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from typing import Literal, TypeAlias, get_args

from drystone import _core
from drystone.common.cones import CONES, FACETS, INSCRIBED, Pyramid, core_cones
from drystone.common.numbers import (
    FloatRows,
    number,
    optional_number,
    optional_whole,
    vector,
    whole,
)
from drystone.planning.answer import Plan
from drystone.planning.robust import robust
from drystone.scene import Scene
from drystone.scene.scene import scene_of

StabilityTest: TypeAlias = Literal["reuse", "reuse-dantzig", "lcp", "lp", "lp-warm"]
TESTS = get_args(StabilityTest)
"""The stability tests `plan` knows: see there."""

OrderOfPlan: TypeAlias = Literal["any", "robust"]
ORDERS = get_args(OrderOfPlan)
"""The first order found, or the one whose smallest margin is largest."""

Progress = Callable[[int, int, int], None]
"""Called a few times a second with (tests done, blocks placed, blocks in all). Before the first
test the complete structure is checked, block by block, and "blocks placed" counts these."""


def plan(
    scene: Scene,
    test: StabilityTest = "reuse",
    node_limit: int | None = None,
    time_limit: float | None = None,
    progress: Progress | None = None,
    shortcuts: bool = True,
    threads: int | None = None,
    hold: int = 0,
    clear_path: bool = False,
    directions: FloatRows | None = None,
    *,
    margin: float = 0.0,
    order: OrderOfPlan = "any",
    strong: bool = False,
    moves: int = 1,
    together: int = 1,
    obstacles: Scene | None = None,
    facets: int = FACETS,
    cone: Pyramid = INSCRIBED,
) -> Plan:
    """Find an order in which blocks can be taken away so that what is left always stands.

    The search builds upward from the fixed bodies, one block at a time, and tests after each
    whether the structure stands. Where no block can be added, it takes the last one off and tries
    another. The order of removal is the order of building backwards.

    `test` says how it is decided whether a structure stands. All decide exactly, so the order is
    the same; they differ in what is kept from one test to the next:

    - "reuse" keeps a basis of the contact forces, with its factor, which grows and shrinks with the
      structure;
    - "reuse-dantzig" starts Dantzig's method from the solution of the structure before, as in the
      paper;
    - "lcp" is Dantzig's method from scratch;
    - "lp" is a linear program, solved from scratch by HiGHS;
    - "lp-warm" is the same program in one HiGHS model that is kept.

    `hold` is how many blocks may be held at a time (at most 8), as by a robot's hands or a
    scaffold, if there is no order without. A held block does not move, whatever acts on it. The
    hand that carries a block away is not counted. `Plan.holds` says what is held; a hand takes hold
    as few times as the order found allows.

    With `clear_path` every block has to leave along a straight line, past those that remain. It may
    slide along them. Directions are tried in this order: `directions`, if given (vectors of any
    length); against gravity, along the axes, along and across the block's contacts; and, if these
    give no order, at right angles to one or two faces of the block and of what is near. The first
    one that is free is in `Plan.directions`, and how far it is to freedom in `Plan.moves`.

    - With `moves=2` a block that is not free along one line may go along one until it is stopped,
      or comes past a face, and leave along another.
    - With `together=k` up to k blocks leave as one where blocks lock one another in: `Plan.groups`.
      A group stands with all of it there; how it comes apart afterwards is not planned.
    - `obstacles` is a scene whose bodies are in the way and bear nothing: a table, a fixture. Fixed
      bodies of `scene` are in the way as well.

    `node_limit` bounds the number of tests, `time_limit` the seconds of the whole call. A limit
    reached, or Ctrl-C, is a status of the plan, which then holds the best so far. `progress` is
    called now and then: see `Progress`.

    With `shortcuts` the search learns from each collapse. The motion in which a structure falls
    also proves that others fall, and tells which blocks wait for one another in vain, so that these
    are left out without a test. The order is the same. A search of more than 20,000 tests, or of
    more than 20 for each block, takes turns with a second one, which always tries the block that
    leaves the structure furthest from falling. Without `shortcuts` every structure is tested, as in
    the paper.

    `threads` is how many to use, by default one for each core. The plan is the same on any number.
    They help in two places: a structure of 200 blocks or more is checked as a whole beside the
    search, and "lcp" tests several structures ahead. Tests that reuse run one after the other.

    `facets` and `cone` ("inscribed" or "circumscribed") are the friction cones in space: see
    `check`.

    Raises SceneError for bodies that overlap, and ValueError for arguments that cannot be used.

    With `margin` every structure, the complete one too, has to stand under any horizontal
    acceleration up to so many g (in space up to 2 % more in some directions); permanent loads stay
    as they are. It goes with "reuse" and with nothing held. `order` "robust" looks for the order
    whose smallest margin is largest, to 0.1 % of it or 1e-4 g, by plans with growing margins; the
    limits are those of each. No order has more than the complete structure itself. `Plan.margins`
    are those of the structures on the way.

    With `strong` every structure, the complete one too, *must* stand, as `check(strong=True)` says
    it: forces that may hold it are not enough. It goes with "reuse", with nothing held and
    without a margin. A structure of which it is not decided counts as one that need not.

    >>> import drystone as ds
    >>> ds.plan(ds.scenes.column(4)).found
    True
    >>> ds.plan(ds.scenes.arch(7)).status, ds.plan(ds.scenes.arch(7), hold=1).status
    ('no_order', 'found')
    """
    hold, moves, together = (
        whole(count, what)
        for count, what in ((hold, "hold"), (moves, "moves"), (together, "together"))
    )
    node_limit = optional_whole(node_limit, "node_limit")
    threads = optional_whole(threads, "threads")
    time_limit = optional_number(time_limit, "time_limit")
    if time_limit == math.inf:
        time_limit = None
    if progress is not None and not callable(progress):
        raise TypeError(f"progress must be a function, not {progress!r:.80}")
    if hold < 0:
        raise ValueError(f"hold is {hold}: it must be zero or more")
    if order not in ORDERS:
        raise ValueError(f"unknown order {order!r}: choose one of {', '.join(ORDERS)}")
    least = number(margin, "margin")
    if not 0 <= least < math.inf:
        raise ValueError(f"margin is {margin}: it must be zero or more, in g")
    if (least > 0 or order == "robust") and (hold or test != "reuse"):
        raise ValueError('margins go with test="reuse" and hold=0')
    if strong and (hold or test != "reuse" or least > 0 or order == "robust"):
        raise ValueError('strong=True goes with test="reuse" and hold=0, and without a margin')
    _check_ways(scene, clear_path, directions, moves, together, obstacles)
    for limit, what in ((node_limit, "node_limit"), (time_limit, "time_limit")):
        if limit is not None and not limit >= 0:
            raise ValueError(f"{what} is {limit}: it must be zero or more")
    if threads is not None and threads < 1:
        raise ValueError(f"threads is {threads}: it must be one or more")
    cones = core_cones(facets, cone)
    scene = copy.copy(scene_of(scene))  # the one planned, whatever becomes of it

    def planned(with_margin: float) -> Plan:
        core = _core.plan(
            scene._core,
            _stability_test(scene, test, cones),
            node_limit,
            time_limit,
            progress,
            shortcuts,
            threads,
            cones,
            hold,
            (_ways(scene, directions), moves, together) if clear_path else None,
            None if obstacles is None else scene_of(obstacles)._core,
            with_margin,
            strong,
        )
        return Plan._of(core, test, scene, cones, with_margin, strong, hold)

    return robust(planned, least) if order == "robust" else planned(least)


def _check_ways(
    scene: Scene,
    clear_path: bool,
    directions: FloatRows | None,
    moves: int,
    together: int,
    obstacles: Scene | None,
) -> None:
    if moves not in (1, 2):
        raise ValueError(f"moves is {moves!r}: a block leaves by one straight move or by two")
    if together < 1:
        raise ValueError(f"together is {together!r}: it must be one or more")
    asked = {
        "directions are": directions is not None,
        "moves are": moves > 1,
        "together is": together > 1,
        "obstacles are": obstacles is not None,
    }
    for what, is_asked in asked.items():
        if is_asked and not clear_path:
            raise ValueError(
                f"{what} for straight ways out: give clear_path=True with "
                f"{'it' if what.endswith('is') else 'them'}"
            )
    if obstacles is not None and scene_of(obstacles).dimension != scene.dimension:
        raise ValueError(
            f"obstacles is a scene of dimension {obstacles.dimension}, not {scene.dimension}"
        )


def _ways(scene: Scene, directions: FloatRows | None) -> list[tuple[float, float, float]]:
    """Vectors of three numbers; in the plane z is zero."""
    try:
        ways = [] if directions is None else list(directions)
    except TypeError:
        raise TypeError(f"directions must be a list of vectors, not {directions!r:.80}") from None
    found = []
    for way in ways:
        x, y, *z = vector(way, scene.dimension, "directions: each", error=ValueError)
        found.append((x, y, z[0] if z else 0.0))
    return found


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
