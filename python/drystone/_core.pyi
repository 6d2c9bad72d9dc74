"""The compiled core: conversions only. Use the names of `drystone`, not these."""

from collections.abc import Callable, Sequence
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "Body",
    "BusyError",
    "Contact",
    "ContactError",
    "ContactForce",
    "ContactForces",
    "ContactSolution",
    "DrystoneError",
    "Escape",
    "Forces",
    "Generators",
    "LcpError",
    "LcpSnapshot",
    "LcpSolution",
    "LcpSolver",
    "Limit",
    "LimitEnd",
    "Margin",
    "Plan",
    "Recording",
    "Replay",
    "Run",
    "Scene",
    "SceneError",
    "Settled",
    "SimulationError",
    "Solid",
    "StartError",
    "StepError",
    "StepRecord",
    "Strong",
    "Structure",
    "StructureForces",
    "TestRecord",
    "Verdict",
    "World",
    "__version__",
    "add_load",
    "add_pressure",
    "add_settlement",
    "catalogue",
    "check",
    "contact_solve",
    "disassembly_graph",
    "forces_along",
    "generators",
    "lcp_solve",
    "least_friction",
    "limit",
    "load_cases",
    "loads",
    "margin",
    "pair_frictions",
    "plan",
    "set_friction",
    "settle",
    "settlements",
    "strong",
    "with_gravity",
    "without_settlements",
]

__version__: str

class DrystoneError(Exception): ...
class SceneError(DrystoneError, ValueError): ...
class LcpError(DrystoneError, ValueError): ...
class ContactError(DrystoneError, ValueError): ...
class StartError(LcpError): ...
class SimulationError(DrystoneError, ValueError): ...
class StepError(DrystoneError): ...
class BusyError(DrystoneError, RuntimeError): ...

@final
class Scene:
    def __new__(
        cls,
        gravity: Sequence[float],
        friction: float,
        contact_tolerance: float | None = None,
    ) -> Scene: ...
    @property
    def dimension(self) -> int: ...
    @property
    def gravity(self) -> tuple[float, ...]: ...
    @property
    def friction(self) -> float: ...
    def largest_friction(self) -> float: ...
    @property
    def contact_tolerance(self) -> float | None: ...
    def add_box(
        self,
        center: tuple[float, float],
        size: tuple[float, float],
        angle: float,
        name: str | None,
        density: float,
        friction: float | None,
        fixed: bool,
        own: tuple[float | None, tuple[float, float] | None, float | None],
    ) -> str: ...
    def add_polygon(
        self,
        vertices: Sequence[tuple[float, float]],
        name: str | None,
        density: float,
        friction: float | None,
        fixed: bool,
        own: tuple[float | None, tuple[float, float] | None, float | None],
    ) -> str: ...
    def add_cuboid(
        self,
        center: tuple[float, float, float],
        size: tuple[float, float, float],
        orientation: tuple[float, float, float, float],
        name: str | None,
        density: float,
        friction: float | None,
        fixed: bool,
        own: tuple[
            float | None,
            tuple[float, float, float] | None,
            Sequence[tuple[float, float, float]] | None,
        ],
    ) -> str: ...
    def add_solid(
        self,
        pieces: Sequence[Sequence[tuple[float, float, float]]],
        position: tuple[float, float, float],
        orientation: tuple[float, float, float, float],
        name: str | None,
        density: float,
        friction: float | None,
        fixed: bool,
        own: tuple[
            float | None,
            tuple[float, float, float] | None,
            Sequence[tuple[float, float, float]] | None,
        ],
    ) -> str: ...
    def add_surface(
        self,
        vertices: NDArray[np.float64],
        triangles: NDArray[np.uint32],
        position: tuple[float, float, float],
        orientation: tuple[float, float, float, float],
        name: str | None,
        density: float,
        friction: float | None,
        fixed: bool,
        own: tuple[
            float | None,
            tuple[float, float, float] | None,
            Sequence[tuple[float, float, float]] | None,
        ],
    ) -> str: ...
    def extruded(self, depth: float) -> Scene: ...
    def parted(self) -> Scene: ...
    def copy(self) -> Scene: ...
    def __len__(self) -> int: ...
    def names(self) -> list[str]: ...
    def body(self, name: str) -> Body | Solid: ...
    def bodies(self) -> list[Body | Solid]: ...
    def contacts(self) -> list[Contact]: ...
    def corner_touches(self) -> list[tuple[str, str]]: ...
    def overlaps(self) -> list[tuple[str, str, float, float]]:
        """Pairs of bodies that overlap: (a, b, depth, contact tolerance), metres."""

    def near_misses(self) -> list[tuple[str, str, float, float]]:
        """Pairs that do not touch, but would with ten times the contact tolerance, as (a, b, gap,
        that tolerance), metres."""

    def explain_fall(
        self, checked: list[str], falling: list[str]
    ) -> tuple[
        list[tuple[str, list[str], tuple[str, float] | None]],
        list[tuple[str, str, float, float]],
    ]:
        """Falling blocks that nothing bears from below, as (name, what it touches, (nearest of the
        others, metres)), and pairs that a ten times larger contact tolerance would make touch, as
        (a, b, gap, that tolerance), metres."""

    def to_json(self) -> str: ...
    def save(self, path: str) -> None: ...
    @staticmethod
    def from_json(text: str, source: str = "scene") -> Scene: ...
    @staticmethod
    def load(path: str) -> Scene: ...
    @staticmethod
    def built_in(name: str, parameters: dict[str, Any]) -> Scene: ...

@final
class Body:
    """A snapshot of one body. `vertices` is (n, 2): world coordinates, counter-clockwise. `offset`
    is where the centroid is in the body's frame, whose origin is `center_of_mass`.
    """

    name: str
    fixed: bool
    density: float
    friction: float
    mass: float
    inertia: float
    center_of_mass: tuple[float, float]
    offset: tuple[float, float]
    angle: float
    vertices: NDArray[np.float64]

@final
class Solid:
    """A snapshot of one body in space. `vertices` is (n, 3), every corner of every piece in world
    coordinates; `pieces` has for each convex piece its corners in the body's frame, (k, 3), and its
    faces as lists of them, counter-clockwise from outside. `inertia` is (3, 3), about
    `center_of_mass`, the frame's origin, along the world's axes; `orientation` a unit quaternion
    (w, x, y, z); `offset` is where the centroid is in the frame.
    """

    name: str
    fixed: bool
    density: float
    friction: float
    mass: float
    inertia: NDArray[np.float64]
    center_of_mass: tuple[float, float, float]
    offset: tuple[float, float, float]
    orientation: tuple[float, float, float, float]
    box_size: tuple[float, float, float] | None
    pieces: list[tuple[NDArray[np.float64], list[list[int]]]]
    surface: tuple[NDArray[np.float64], NDArray[np.uint32]] | None
    vertices: NDArray[np.float64]

@final
class Contact:
    """One contact point. `normal` is a unit vector from body `a` into body `b`."""

    a: str
    b: str
    feature: str
    at_borders: bool
    point: tuple[float, ...]
    normal: tuple[float, ...]
    gap: float
    friction: float

@final
class ContactForce:
    """The force that body `a` exerts on body `b` at one contact point, in newtons."""

    a: str
    b: str
    feature: str
    at_borders: bool
    point: tuple[float, ...]
    normal: tuple[float, ...]
    normal_force: float
    tangential_force: float
    force: tuple[float, ...]

@final
class ContactForces:
    """All of a verdict, one row a contact point."""

    def __len__(self) -> int: ...
    def at(self, index: int) -> ContactForce:
        """IndexError from the number of points on."""
    def bodies(self) -> NDArray[np.int64]:
        """(points, 2): places in the scene."""
    def points(self) -> NDArray[np.float64]: ...
    def normals(self) -> NDArray[np.float64]: ...
    def vectors(self) -> NDArray[np.float64]:
        """(points, dimension), N."""
    def normal_forces(self) -> NDArray[np.float64]: ...
    def tangential_forces(self) -> NDArray[np.float64]: ...
    def borders(self) -> list[int]:
        """The points that bear where only borders meet."""
    def json(self, first: int, end: int) -> str:
        """Objects, one a line, with commas in between."""
    def to_bytes(self) -> bytes: ...
    @staticmethod
    def from_bytes(state: bytes) -> ContactForces:
        """DrystoneError if the bytes are none."""

@final
class Forces:
    """The contact forces of a verdict, computed when asked for."""

    def canonical(self) -> ContactForces | None:
        """None if they are not found to the accuracy that a verdict needs."""
    def any(self) -> ContactForces:
        """Those that the verdict was found with."""
    def at_borders(self) -> bool:
        """Whether some of the contacts are where only borders meet."""
    def __len__(self) -> int: ...

@final
class Verdict:
    status: str
    stable: bool
    forces: Forces
    names: list[str]
    accelerations: NDArray[np.float64]
    falling: list[str]
    pivots: int
    major_cycles: int
    minor_cycles: int
    iterations: int
    residual: float
    virtual_motion: bool
    doubt: tuple[float, float] | None
    seconds: float

@final
class Escape:
    """`accelerations` (blocks, 3 or 6) of the bodies `names`; `error` of the fastest of them."""

    names: list[str]
    accelerations: NDArray[np.float64]
    forces: ContactForces
    error: float

@final
class Settled:
    """`displacements` (blocks, 3 or 6) of the bodies `names`, m and rad. `joints`: two bodies, what
    their joint does ("hinge", "slides", "parts"), where, and how far it opens and slides, m."""

    status: str
    names: list[str]
    displacements: NDArray[np.float64]
    joints: list[tuple[str, str, str, tuple[float, ...], float, float]]
    forces: Forces | None
    work: float
    bound: float
    imbalance: float
    closing: float
    resolution: float
    squeezed: list[str]
    iterations: int
    seconds: float

@final
class Strong:
    """`must_stand` None where it was not decided."""

    must_stand: bool | None
    nodes: int
    programs: int
    escape: Escape | None
    seconds: float

@final
class LimitEnd:
    """`velocities` (moving bodies, 3 or 6) of the bodies `names`."""

    factor: float
    names: list[str]
    velocities: NDArray[np.float64]
    forces: ContactForces | None
    imbalance: float
    closing: float
    bound: float

@final
class Limit:
    status: str
    lower: LimitEnd
    upper: LimitEnd
    pivots: int
    iterations: int
    seconds: float

@final
class Margin:
    """`boundary` (n, 2) along `axes`; `tilt` None where it is not known."""

    status: str
    acceleration: float
    direction: tuple[float, ...]
    tilt: float | None
    end: LimitEnd
    axes: tuple[tuple[float, ...], tuple[float, ...]]
    boundary: NDArray[np.float64]
    questions: int

@final
class TestRecord:
    size: int
    pivots: int
    seconds: float
    stable: bool

@final
class Plan:
    status: str
    found: bool
    order: list[str]
    reached: list[str]
    falls_next: list[str]
    held: list[list[str]]
    """For each structure on the way to `reached`, of one block, of two and so on."""
    moves: list[list[tuple[tuple[float, float, float], float]]]
    groups: list[list[str]]
    """For each block of `reached`; empty if straight lines were not asked for."""
    blocked: list[tuple[str, list[tuple[tuple[float, float, float], list[str]]]]]
    """(body, [(direction, bodies in the way)])."""
    tests: int
    pivots: int
    test_seconds: float
    seconds: float
    records: list[TestRecord]
    shortcuts: int
    whole: Verdict | None

@final
class Generators:
    """Equilibrium of the complete assembly: G f = -F with f >= 0 (statics as a linear program).

    G is (3 movable bodies, n generators) in compressed columns, in space (6 movable bodies, n
    generators); row 3 i + k is body `names[i]`'s x force, y force and moment about its centroid
    (k = 0, 1, 2), row 6 i + k its force and its moments about its principal axes. `bodies[j]` holds
    the two movable bodies that generator j acts on (-1 for a fixed one).
    """

    names: list[str]
    indptr: NDArray[np.int64]
    indices: NDArray[np.int64]
    data: NDArray[np.float64]
    applied: NDArray[np.float64]
    inverse_mass: NDArray[np.float64]
    bodies: NDArray[np.int64]
    contact: NDArray[np.int64]

@final
class Structure:
    """Blocks are indices in `names()`: the movable bodies, in the order of the scene."""

    set_up_seconds: float
    """Of the analysis of the complete assembly, once its contacts are known."""
    def __new__(cls, scene: Scene, cones: tuple[int, str] | None = None) -> Structure: ...
    def names(self) -> list[str]: ...
    def blocks(self) -> list[int]: ...
    def change(self, removed: list[int], added: list[int]) -> None: ...
    def step(self, removed: list[int], added: list[int]) -> tuple[bool | None, float, int]:
        """Whether the rest stands (None: borderline), seconds of all this, pivots."""

    def check(self) -> Verdict: ...
    def limit(
        self,
        scene: Scene,
        forces: Sequence[tuple[str, Sequence[float], Sequence[float]]],
        gravity: Sequence[float] | None = None,
    ) -> Limit: ...
    def pivots(self) -> int: ...
    def entries(self) -> int: ...
    def copy(self) -> Structure: ...
    def to_bytes(self) -> bytes: ...
    @staticmethod
    def from_bytes(scene: Scene, cones: tuple[int, str] | None, state: bytes) -> Structure:
        """The structure that `to_bytes` was asked of, on the same scene with the same cones."""

@final
class Recording:
    """The stability tests of one search without shortcuts, in order, with the verdicts of `test`.

    `test` is a callable as `plan` takes it.
    """

    def __new__(
        cls, scene: Scene, test: Callable[[list[int], int], tuple[bool, int]]
    ) -> Recording: ...
    def replay(self, test: str | Callable[[list[int], int], tuple[bool, int]]) -> Replay:
        """The same tests by a callable or by name: "lcp", "reuse-dantzig", "reuse", "block",
        "reuse-block", "lemke" or "reuse-lemke".
        """

@final
class Replay:
    """`wrong` verdicts are unlike those recorded. `seconds` has the analysis before the first test
    in it.
    """

    tests: int
    pivots: int
    wrong: int
    unanswered: int
    seconds: float

@final
class StructureForces:
    """Forces of some structures of an order: those of the k-th are entries offsets[k]:offsets[k+1].

    `blocks[k]` is its number of movable bodies, `stands[k]` whether forces hold it up. `contact` is
    an index into `Scene.contacts()`; `force` (n, 2 or 3) acts on the contact's second body, N.
    `hands[k]` are held blocks with what the hand does to each: force, N, and moment, N m.
    """

    blocks: NDArray[np.int64]
    stands: NDArray[np.bool_]
    offsets: NDArray[np.int64]
    contact: NDArray[np.int64]
    force: NDArray[np.float64]
    hands: list[list[tuple[str, list[float]]]]

@final
class World:
    def __new__(
        cls,
        scene: Scene,
        dt: float,
        reuse: str,
        restitution: float,
        formulation: str,
        coulomb_tolerance: float,
        friction_cones: tuple[int, str] | None = None,
    ) -> World: ...
    def step(self) -> StepRecord: ...
    def run(
        self,
        steps: int,
        forces: bool = False,
        progress: Callable[[int, int], None] | None = None,
        every: int = 1,
    ) -> Run:
        """`progress` is called with (steps made, steps in all) a few times a second."""
    @property
    def scene(self) -> Scene: ...
    @property
    def dimension(self) -> int: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def dt(self) -> float: ...
    @property
    def reuse(self) -> str: ...
    @property
    def restitution(self) -> float: ...
    @property
    def coulomb_tolerance(self) -> float: ...
    @property
    def formulation(self) -> str: ...
    @property
    def steps(self) -> int: ...
    @property
    def energy(self) -> float: ...
    @property
    def poses(self) -> NDArray[np.float64]: ...
    @property
    def velocities(self) -> NDArray[np.float64]: ...
    @property
    def motionless(self) -> NDArray[np.bool_]: ...
    def forces(self) -> list[ContactForce]: ...
    def set_velocity(self, name: str, velocity: Sequence[float]) -> None: ...
    def apply_force(
        self, name: str, wrench: Sequence[float], at: Sequence[float] | None = None
    ) -> None: ...
    def apply_impulse(
        self, name: str, wrench: Sequence[float], at: Sequence[float] | None = None
    ) -> None: ...
    def extend(self, scene: Scene) -> None: ...
    def remove(self, name: str) -> None: ...
    def snapshot(self) -> bytes: ...
    @staticmethod
    def restore(snapshot: bytes) -> World: ...
    def state_hash(self) -> int: ...

@final
class StepRecord:
    motionless: NDArray[np.bool_]
    pivots: int
    major_cycles: int
    minor_cycles: int
    solves: int
    rows: int
    rows_reused: int
    solve_seconds: float
    seconds: float
    residual: float
    friction_error: float
    exact: bool
    penetration: float
    projections: int
    collisions: int
    fallback: str | None
    inconsistent: tuple[str, str, str] | None

@final
class Run:
    """One entry a step; `poses` and `velocities` have one more, the beginning. With forces, those
    of step k are the rows `force_starts[k]` to `force_starts[k + 1]` of the last three arrays."""

    status: str
    reason: str | None
    poses: NDArray[np.float64]
    velocities: NDArray[np.float64]
    motionless: NDArray[np.bool_]
    pivots: NDArray[np.int64]
    major_cycles: NDArray[np.int64]
    minor_cycles: NDArray[np.int64]
    solves: NDArray[np.int64]
    rows: NDArray[np.int64]
    rows_reused: NDArray[np.int64]
    projections: NDArray[np.int64]
    collisions: NDArray[np.int64]
    inconsistent: NDArray[np.int64]
    solve_seconds: NDArray[np.float64]
    step_seconds: NDArray[np.float64]
    residual: NDArray[np.float64]
    friction_error: NDArray[np.float64]
    exact: NDArray[np.bool_]
    penetration: NDArray[np.float64]
    force_starts: NDArray[np.int64]
    force_bodies: NDArray[np.int64]
    force_points: NDArray[np.float64]
    forces: NDArray[np.float64]

@final
class LcpSolution:
    z: NDArray[np.float64]
    w: NDArray[np.float64]
    status: str
    pivots: int
    major_cycles: int
    minor_cycles: int
    residual: float
    ray: NDArray[np.float64] | None
    refactorisations: int

@final
class ContactSolution:
    impulses: NDArray[np.float64]
    velocities: NDArray[np.float64]
    error: float
    tolerance: float
    status: str
    islands: int
    sweeps: int
    newton_steps: int

@final
class LcpSnapshot: ...

@final
class LcpSolver:
    """M in compressed columns. `solve` returns complete vectors, z = 0 on rows not present."""

    def __new__(
        cls,
        indptr: NDArray[np.int64],
        indices: NDArray[np.int64],
        data: NDArray[np.float64],
        q: NDArray[np.float64],
        pivot_limit: int | None = None,
    ) -> LcpSolver: ...
    @staticmethod
    def from_generators(
        indptr: NDArray[np.int64],
        indices: NDArray[np.int64],
        data: NDArray[np.float64],
        inverse_mass: NDArray[np.float64],
        h: NDArray[np.float64],
        pivot_limit: int | None = None,
    ) -> LcpSolver: ...
    def add_rows(self, rows: NDArray[np.int64]) -> None: ...
    def remove_rows(self, rows: NDArray[np.int64]) -> None: ...
    def set_q(self, q: NDArray[np.float64]) -> None: ...
    def set_q_at(self, rows: NDArray[np.int64], q: NDArray[np.float64]) -> None: ...
    def solve(self) -> LcpSolution: ...
    def snapshot(self) -> LcpSnapshot: ...
    def restore(self, snapshot: LcpSnapshot) -> None: ...
    def rows(self) -> list[int]: ...
    def q(self) -> list[float]: ...
    def counts(self) -> tuple[int, int, int, int, int, int]:
        """Major cycles, minor cycles, pivots, refactorisations, factor rows, entries solved."""

    def copy(self) -> LcpSolver: ...
    def to_bytes(self) -> bytes: ...
    @staticmethod
    def from_bytes(state: bytes) -> LcpSolver: ...

def catalogue() -> list[tuple[str, str, list[tuple[str, str, bool, float]]]]:
    """Built-in scenes: (name, summary, [(parameter, summary, whole number or not, default)])."""

def limit(
    scene: Scene,
    forces: Sequence[tuple[str, Sequence[float], Sequence[float]]],
    gravity: Sequence[float] | None = None,
    blocks: Sequence[str] | None = None,
    cones: tuple[int, str] | None = None,
    round_cones: bool = False,
) -> Limit:
    """`forces`: body, force on its centroid, moment (three numbers, of which the plane uses the
    last)."""

def load_cases(
    scene: Scene,
    loads: Sequence[
        tuple[
            Sequence[tuple[str, Sequence[float], Sequence[float]]],
            Sequence[float] | None,
        ]
    ],
    factors: Sequence[Sequence[float]],
    blocks: Sequence[str] | None = None,
    cones: tuple[int, str] | None = None,
    round_cones: bool = False,
) -> tuple[NDArray[np.int8], int, float]:
    """`loads`: forces and gravity, as in `limit`. Of each row of factors 1 (stands), 0 (falls) or
    -1 (neither is proved); how many took a computation of their own; seconds."""

def margin(
    scene: Scene,
    blocks: Sequence[str] | None,
    turn: bool,
    tolerance: float,
    cones: tuple[int, str] | None,
    round_cones: bool,
) -> Margin: ...
def least_friction(
    scene: Scene,
    blocks: Sequence[str] | None,
    cones: tuple[int, str] | None,
    round_cones: bool,
) -> float: ...
def add_load(
    scene: Scene,
    body: str,
    force: Sequence[float],
    at: Sequence[float] | None,
    moment: Sequence[float],
    name: str | None,
) -> str:
    """`moment` has three numbers, of which the plane uses the last."""

def add_pressure(
    scene: Scene, body: str, direction: Sequence[float], pressure: float, name: str | None
) -> str: ...
def set_friction(scene: Scene, a: str, b: str, friction: float) -> None: ...
def with_gravity(scene: Scene, gravity: Sequence[float]) -> Scene: ...
def loads(
    scene: Scene,
) -> list[tuple[str, str, tuple[float, ...], tuple[float, ...], list[float]]]:
    """(name, body, force, where it acts in the world, moment) of every permanent load."""

def add_settlement(
    scene: Scene,
    body: str,
    displacement: Sequence[float],
    rotation: Sequence[float],
    at: Sequence[float] | None,
) -> None:
    """`rotation` has three numbers, of which the plane uses the last."""

def settlements(
    scene: Scene,
) -> list[tuple[str, tuple[float, ...], list[float], tuple[float, ...]]]:
    """(body, displacement, rotation, about which point of the world) of every settlement."""

def without_settlements(scene: Scene) -> Scene: ...
def settle(
    scene: Scene,
    blocks: Sequence[str] | None = None,
    cones: tuple[int, str] | None = None,
    round_cones: bool = False,
) -> Settled:
    """How the blocks of a structure that stands follow the settlements."""

def pair_frictions(scene: Scene) -> list[tuple[str, str, float]]: ...
def generators(scene: Scene, cones: tuple[int, str] | None = None) -> Generators:
    """`cones`: edges of a friction cone in space, and "inscribed" or "circumscribed"."""

def check(
    scene: Scene,
    blocks: Sequence[str] | None = None,
    method: str = "equilibrium",
    cones: tuple[int, str] | None = None,
    round_cones: bool = False,
) -> Verdict: ...
def strong(
    scene: Scene,
    blocks: Sequence[str] | None = None,
    nodes: int | None = None,
    progress: Callable[[int, float], None] | None = None,
) -> Strong:
    """`nodes`: most of them; by default as many as a set effort allows. `progress` is called with
    (nodes begun, share of the budget used)."""

def plan(
    scene: Scene,
    test: str | Callable[[list[int], int], tuple[bool, int]],
    node_limit: int | None = None,
    time_limit: float | None = None,
    progress: Callable[[int, int, int], None] | None = None,
    shortcuts: bool = True,
    threads: int | None = None,
    cones: tuple[int, str] | None = None,
    hold: int = 0,
    ways: tuple[Sequence[tuple[float, float, float]], int, int] | None = None,
    obstacles: Scene | None = None,
    margin: float = 0.0,
    strong: bool = False,
) -> Plan:
    """`test` is "lcp", "reuse", or a callable given (sorted indices of the sub-assembly's movable
    bodies in `Generators.names`, index of the body added last) that returns (stands, pivots).
    `progress` is called with (tests done, blocks placed, blocks in all) a few times a second.
    Blocks leave along straight lines if there are `ways`: directions, be they none, how many moves
    one after the other, and how many blocks together. With a `margin`, in g, "reuse" tests every
    structure under accelerations to all sides; with `strong` whether it must stand.
    """

def forces_along(
    scene: Scene,
    order: Sequence[str],
    every: int = 1,
    progress: Callable[[int, int], None] | None = None,
    cones: tuple[int, str] | None = None,
    held: Sequence[Sequence[str]] | None = None,
    any_forces: bool = False,
) -> StructureForces:
    """Contact forces while movable bodies are put up in an order, the first put up first.

    Of structures whose number of blocks is that of all less a multiple of `every`. `progress` is
    called with (blocks placed, blocks in all) a few times a second. `held[k]` are the blocks that
    hands hold in the structure of k + 1 blocks.
    """

def disassembly_graph(scene: Scene) -> list[tuple[list[str], bool]]:
    """Every sub-assembly of a small scene with the verdict on it (stands or not)."""

def lcp_solve(
    indptr: NDArray[np.int64],
    indices: NDArray[np.int64],
    data: NDArray[np.float64],
    q: NDArray[np.float64],
    method: str,
    start: tuple[NDArray[np.int64], NDArray[np.float64]] | None = None,
    pivot_limit: int | None = None,
) -> LcpSolution:
    """M in compressed columns. `start`: (indices of the sub-problem, its solution z)."""

def contact_solve(
    dimension: int,
    mass: tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]],
    jacobian: tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]],
    friction: NDArray[np.float64],
    free: NDArray[np.float64],
    offset: NDArray[np.float64],
    start: NDArray[np.float64] | None = None,
    tolerance: float | None = None,
    scale: float = 0.0,
) -> ContactSolution:
    """M in compressed columns, J in compressed rows."""
