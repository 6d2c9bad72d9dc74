"""Bodies in motion, one step at a time, and what may be done to them between two steps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from drystone import _core
from drystone.common.cones import FACETS, INSCRIBED, Pyramid, core_cones
from drystone.common.drawn import Drawn
from drystone.common.numbers import Floats, name_of, whole
from drystone.common.text import counted
from drystone.common.units import quantity
from drystone.equilibrium.contact_force import ContactForce
from drystone.motion.memory import warn_of_much_memory
from drystone.motion.modes import COULOMB_TOLERANCE, Formulation, Progress, Reuse
from drystone.motion.run import Run
from drystone.motion.simulation import core_world, numbers, velocity_of, whole_every
from drystone.scene import Point, Scene
from drystone.scene.adding import Adding

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from typing_extensions import Self


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class StepRecord:
    """What one step did; the fields are those of `Run`, for one step."""

    motionless: NDArray[np.bool_]
    """(bodies,): which kept their place, to the bit."""
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
    """Whether `friction_error` is within what is asked for: see `Run.exact`."""
    penetration: float
    projections: int
    collisions: int
    fallback: str | None
    """Acceleration level: how the search for forces ended where it found none, so that impulses
    took their place. "no_solution" is proved; after another word there may be some."""
    inconsistent: tuple[str, str, str] | None
    """The contact to blame for it: names of the two bodies, and what meets."""

    def __repr__(self) -> str:
        moved = int((~self.motionless).sum())
        told = f"{moved} of {counted(len(self.motionless), 'body', 'bodies')} moved"
        told += f"; {counted(self.pivots, 'pivot')}, {counted(self.solves, 'solve')}"
        told += "" if self.exact else f", not exact (off by {self.friction_error:.1e} m/s)"
        told += "" if self.inconsistent is None else ", by impulses"
        return f"<StepRecord: {told}, {quantity(self.seconds, 's')}>"


class World(Adding, Drawn):
    """A scene in motion, one step at a time; between steps bodies may be pushed, added and removed.

    >>> import drystone as ds
    >>> world = ds.World(ds.scenes.column(4, friction=0.5))
    >>> world.step().pivots
    0
    >>> world.apply_force("3", (30, 0))
    >>> bool(world.step().motionless[3])
    False

    `copy.copy`, `copy.deepcopy` and `pickle` make independent worlds that go on in the same way,
    bit for bit. One thread at a time may use a world; a second one gets a BusyError, and nothing
    has changed.
    """

    __slots__ = ("_core",)

    def __init__(
        self,
        scene: Scene,
        dt: float = 1 / 240,
        reuse: Reuse = "full",
        *,
        restitution: float = 0.0,
        formulation: Formulation = "velocity",
        coulomb_tolerance: float = COULOMB_TOLERANCE,
        facets: int = FACETS,
        cone: Pyramid = INSCRIBED,
    ) -> None:
        """Begin with a scene at rest; the arguments and errors are those of `simulate`."""
        cones = core_cones(facets, cone)
        self._core = core_world(
            scene, dt, reuse, restitution, formulation, coulomb_tolerance, cones
        )

    def step(self) -> StepRecord:
        """Make one step. StepError if it cannot be made; the world is then as it was."""
        record = self._core.step()
        return StepRecord(*(getattr(record, name) for name in StepRecord.__slots__))

    def run(
        self,
        steps: int,
        *,
        forces: bool = False,
        every: int = 1,
        progress: Progress | None = None,
    ) -> Run:
        """Make steps and record them, as `simulate` does."""
        if whole(steps, "steps", _core.SimulationError) < 0:
            raise _core.SimulationError(f"steps is {steps}: it must be zero or more")
        whole_every(every)
        start = self.scene
        warn_of_much_memory(steps, every, len(start), start.dimension, forces)
        return Run._of(self._core.run(steps, forces, progress, every), self._core, start, every)

    @property
    def scene(self) -> Scene:
        """The bodies where they are now."""
        return Scene._of(self._core.scene)

    @property
    def names(self) -> list[str]:
        """Names of all bodies, in the order of the arrays."""
        return self._core.names

    @property
    def dt(self) -> float:
        """Length of a step, seconds."""
        return self._core.dt

    @property
    def formulation(self) -> str:
        """What the unknowns of a step are: "velocity" or "acceleration"."""
        return self._core.formulation

    @property
    def steps(self) -> int:
        """Steps made."""
        return self._core.steps

    @property
    def poses(self) -> NDArray[np.float64]:
        """(bodies, 3): the centre of mass's x and y in metres, and the angle in radians.

        In space (bodies, 7): x, y, z and a unit quaternion (w, x, y, z).
        """
        return self._core.poses

    @property
    def velocities(self) -> NDArray[np.float64]:
        """(bodies, 3): m/s, m/s, rad/s. In space (bodies, 6): along the axes, then about them."""
        return self._core.velocities

    @property
    def motionless(self) -> NDArray[np.bool_]:
        """(bodies,): which kept their place in the last step."""
        return self._core.motionless

    @property
    def energy(self) -> float:
        """Kinetic energy and the potential energy of gravity (zero at the origin), joules."""
        return self._core.energy

    @property
    def forces(self) -> tuple[ContactForce, ...]:
        """The mean force of the last step at every contact point that bears.

        If nothing moved in that step these are the forces of least norm, as `check` gives them,
        computed when read. They do not change how the world goes on."""
        return tuple(ContactForce._of(force) for force in self._core.forces())

    @property
    def dimension(self) -> int:
        """2 in the plane, 3 in space."""
        return self._core.dimension

    def set_velocity(self, name: str, velocity: Floats) -> None:
        """Set a body's velocity: (m/s, m/s, rad/s), in space three and three numbers."""
        self._core.set_velocity(name_of(name), velocity_of(self._core, name, velocity))

    def apply_force(
        self, name: str, force: Point, at: Point | None = None, moment: float | Point | None = None
    ) -> None:
        """Push a body during the next step.

        `force` (N) acts at the point `at` (world coordinates, metres), at the centre of mass
        without one; `moment` is in N m, in space three numbers. Pushes add up, and end with the
        step.
        """
        self._core.apply_force(name_of(name), *self._wrench(force, at, moment, "force", "N"))

    def apply_impulse(
        self,
        name: str,
        impulse: Point,
        at: Point | None = None,
        moment: float | Point | None = None,
    ) -> None:
        """Change a body's velocity at once by an impulse (N s) and an impulsive moment (N m s)."""
        self._core.apply_impulse(
            name_of(name), *self._wrench(impulse, at, moment, "impulse", "N s")
        )

    def _wrench(
        self,
        force: Point,
        at: Point | None,
        moment: float | Point | None,
        what: str,
        unit: str,
    ) -> tuple[tuple[float, ...], tuple[float, ...] | None]:
        """Force and moment in one, and where it acts."""
        axes = self.dimension
        count = 1 if axes == 2 else 3
        given = (0.0,) * count if moment is None else moment
        turning = numbers(given, count, "moment", f"{unit} m")
        place = None if at is None else numbers(at, axes, "at", "m")
        return numbers(force, axes, what, unit) + turning, place

    def add(self, place: Callable[[Scene], str]) -> str:
        """Add bodies at rest by whatever adds them to a scene, and return what that returns.

        `add_box` and the others add one, as they do to a `Scene`.

        Raises SceneError as the scene does, and for bodies that overlap; nothing has changed then.

        >>> import drystone as ds
        >>> world = ds.World(ds.scenes.square_pyramid(2))
        >>> world.add(lambda scene: scene.add_box((0, 0, 5), (1, 1, 1), name="from above"))
        'from above'
        >>> len(world.names)
        7
        """
        scene = self.scene
        name = place(scene)
        self._core.extend(scene._core)
        return name

    def _put(self, put: Callable[[_core.Scene], str]) -> str:
        return self.add(lambda scene: put(scene._core))

    def remove(self, name: str) -> None:
        """Take a body out. The next step starts from scratch."""
        self._core.remove(name_of(name))

    def snapshot(self) -> bytes:
        """The whole state as bytes. A world restored from it goes on as this one does, bit for bit.

        The bytes end with a checksum. Only the version of drystone that wrote them reads them.
        """
        return self._core.snapshot()

    @classmethod
    def restore(cls, snapshot: bytes) -> Self:
        """The world that a snapshot was taken of.

        Raises SimulationError for anything else: other, changed, missing or more bytes.
        """
        world = cls.__new__(cls)
        world._core = _core.World.restore(_bytes(snapshot))
        return world

    def state_hash(self) -> int:
        """One number made of all that decides how the world moves on; the same on every machine.

        That is the bodies (names, shapes, masses, friction) and where they are, velocities, pending
        pushes, gravity, the contact tolerance, the arguments of `World` and the count of steps.
        Two worlds share it when these are the same to the bit.
        """
        return self._core.state_hash()

    def __reduce__(self) -> tuple[Any, ...]:
        """Copies and pickles are taken up from a snapshot."""
        return type(self).restore, (self.snapshot(),)

    def __repr__(self) -> str:
        bodies = counted(len(self.names), "body", "bodies")
        return f"<World: {bodies} after {counted(self.steps, 'step')} of {self.dt:.4g} s>"


def _bytes(snapshot: bytes) -> bytes:
    """What `snapshot` gave; SimulationError for what is not bytes at all."""
    if isinstance(snapshot, bytes | bytearray | memoryview):
        return bytes(snapshot)
    raise _core.SimulationError(f"a snapshot is bytes, not {snapshot!r:.60}")
