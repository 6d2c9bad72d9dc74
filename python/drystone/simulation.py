"""How does it move? Exact contact in the plane and in space, step by step."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drystone import _core, tables
from drystone.cones import CONES, FACETS, core_cones
from drystone.files import write_whole
from drystone.scene import Scene
from drystone.verdict import counted, shorten

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from drystone.viewer import Page

REUSE = ("full", "motionless", "none")
"""What a step may take over from the one before it: see `simulate`."""

FORMULATIONS = ("velocity", "acceleration")
"""What the unknowns of a step may be: see `simulate`."""

MOST_STEPS = 10**9
"""Steps of one run: it holds all of them in memory."""

ENDINGS = {
    "finished": "Finished",
    "interrupted": "Interrupted",
    "unsolved": "Stopped: a step could not be solved",
    "too_fast": "Stopped: a block turns too fast for the step",
    "out_of_bounds": "Stopped: a block is further away or faster than can be computed",
}
"""What a run's status says."""

Progress = Callable[[int, int], None]
"""Called with (steps made, steps in all) a few times a second."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Run:
    """The record of `simulate`: k steps of n bodies, fixed ones included.

    Work and errors have one entry a step. `poses` and `velocities` have one more: the beginning.
    """

    status: str
    """"finished", "interrupted", or why a step could not be made: "unsolved", "too_fast",
    "out_of_bounds". The steps before it are here. Where some of them are not exact it goes on:
    "finished, 3 steps not exact"."""
    reason: str | None
    """For a step that could not be made: what happened, and what to do."""
    names: tuple[str, ...]
    """Names of the bodies, in the order of the arrays."""
    dt: float
    """Length of a step, seconds."""
    reuse: str
    restitution: float
    formulation: str
    """"velocity" or "acceleration"."""
    poses: NDArray[np.float64]
    """(k + 1, n, 3): the centre of mass's x and y in metres, and the angle in radians. In space
    (k + 1, n, 7): x, y, z and a unit quaternion (w, x, y, z)."""
    velocities: NDArray[np.float64]
    """(k + 1, n, 3): m/s, m/s, rad/s. In space (k + 1, n, 6): m/s along x, y and z, rad/s about
    them."""
    motionless: NDArray[np.bool_]
    """(k, n): which bodies kept their place in the step, to the bit; fixed ones do."""
    pivots: NDArray[np.int64]
    """(k,): major plus minor cycles of all solves of the step."""
    major_cycles: NDArray[np.int64]
    minor_cycles: NDArray[np.int64]
    solves: NDArray[np.int64]
    """(k,): the first one, and those that make Coulomb's law exact."""
    rows: NDArray[np.int64]
    """(k,): rows of the step's complementarity problem."""
    rows_reused: NDArray[np.int64]
    """(k,): active rows whose part of the factor came from the step before."""
    projections: NDArray[np.int64]
    """(k,): times that overlaps were taken back; their pivots are in `pivots`."""
    collisions: NDArray[np.int64]
    """(k,): contacts at which bodies collided; 0 on the velocity level, which does not ask."""
    inconsistent: NDArray[np.int64]
    """(k, 2): the two bodies (indices in `names`) at a contact for which no forces exist or were
    found, so that impulses took their place; -1 and -1 in all other steps."""
    solve_seconds: NDArray[np.float64]
    """(k,): wall time of the solves, the factor included."""
    step_seconds: NDArray[np.float64]
    """(k,): wall time of the whole step."""
    residual: NDArray[np.float64]
    """(k,): of the last solve, in its problem's scale."""
    friction_error: NDArray[np.float64]
    """(k,): m/s by which a contact departs from Coulomb's law."""
    exact: NDArray[np.bool_]
    """(k,): whether that is within what is asked for. In the plane 1e-9 m/s, relative above 1 m/s;
    in space 1e-8 of the fastest contact's speed and of what gravity gives in a step. Where it is
    not, the step was made with the best that was found."""
    penetration: NDArray[np.float64]
    """(k,): deepest overlap at the end of the step, metres."""
    force_starts: NDArray[np.int64]
    """With `forces=True` (k + 1,): step j's forces are the rows from entry j to entry j + 1 of the
    three arrays below. Else one zero."""
    force_bodies: NDArray[np.int64]
    """(m, 2): indices of the two bodies in `names`."""
    force_points: NDArray[np.float64]
    """(m, 2), in space (m, 3): where, metres."""
    forces: NDArray[np.float64]
    """As many: mean force of the first body on the second in the step, N."""
    scene: Scene = field(repr=False)
    """The scene at the beginning."""

    @classmethod
    def _of(cls, core: _core.Run, world: _core.World, scene: Scene) -> Run:
        own = {"names", "dt", "reuse", "restitution", "formulation", "scene"}
        recorded = {f.name: getattr(core, f.name) for f in fields(cls) if f.name not in own}
        missed = int((~core.exact).sum())
        if missed:
            recorded["status"] += f", {counted(missed, 'step')} not exact"
        return cls(
            names=tuple(world.names),
            dt=world.dt,
            reuse=world.reuse,
            restitution=world.restitution,
            formulation=world.formulation,
            scene=scene,
            **recorded,
        )

    def __copy__(self) -> Run:
        return replace(self, scene=copy.copy(self.scene))

    @property
    def steps(self) -> int:
        """Steps made."""
        return len(self.pivots)

    @property
    def finished(self) -> bool:
        """All steps asked for were made."""
        return self.ending == "finished"

    @property
    def ending(self) -> str:
        """The first word of `status`."""
        return self.status.partition(",")[0]

    @property
    def not_exact(self) -> int:
        """Steps further from Coulomb's law than is asked for: see `exact`, `friction_error`."""
        return int((~self.exact).sum())

    @property
    def by_impulses(self) -> int:
        """Steps on the acceleration level that had no forces and went by impulses."""
        return int((self.inconsistent[:, 0] >= 0).sum())

    @property
    def moving(self) -> tuple[str, ...]:
        """Names of the bodies that moved in the last step."""
        if self.steps == 0:
            return ()
        still = self.motionless[-1]
        return tuple(name for name, rests in zip(self.names, still, strict=True) if not rests)

    def __str__(self) -> str:
        text = (
            f"{ENDINGS.get(self.ending, self.ending)}: {counted(self.steps, 'step')} of "
            f"{self.dt:.4g} s, {counted(int(self.pivots.sum()), 'pivot')}, "
            f"{1e3 * float(self.solve_seconds.sum()):.3g} ms in solves of "
            f"{1e3 * float(self.step_seconds.sum()):.3g} ms."
        )
        if self.reason is not None:
            text += f"\n{self.reason}."
        if self.not_exact:
            text += (
                f"\n{counted(self.not_exact, 'step')} not exact: up to "
                f"{self.friction_error[~self.exact].max():.2g} m/s off Coulomb's law."
            )
        if self.by_impulses:
            text += f"\nImpulses in place of forces in {counted(self.by_impulses, 'step')}."
        if self.steps:
            text += (
                f"\nMoving at the end: {shorten(self.moving)}."
                if self.moving
                else ("\nNothing moves at the end.")
            )
        return text

    def __repr__(self) -> str:
        return f"<Run: {str(self).splitlines()[0]}>"

    def table(self, rows: int = tables.MOST_ROWS) -> str:
        """At most `rows` steps as text, evenly spread: what moved, the work, the errors."""
        return tables.text_of(tables.run_table(self, rows))

    def to_dict(self) -> dict[str, Any]:
        """Totals and the last state, in types that JSON knows; `save` keeps the arrays."""
        worst = {
            name: float(getattr(self, name).max(initial=0.0))
            for name in ("residual", "friction_error", "penetration")
        }
        totals = {
            name: int(getattr(self, name).sum())
            for name in ("pivots", "major_cycles", "minor_cycles", "solves", "rows_reused")
        }
        return {
            "status": self.status,
            "reason": self.reason,
            "dt": self.dt,
            "reuse": self.reuse,
            "restitution": self.restitution,
            "formulation": self.formulation,
            "steps": self.steps,
            "steps_by_impulses": self.by_impulses,
            "steps_not_exact": self.not_exact,
            **totals,
            "projections": int(self.projections.sum()),
            "solve_seconds": float(self.solve_seconds.sum()),
            "step_seconds": float(self.step_seconds.sum()),
            **{f"largest_{name}": value for name, value in worst.items()},
            "moving": list(self.moving),
            "poses": {
                name: [float(x) for x in pose]
                for name, pose in zip(self.names, self.poses[-1], strict=True)
            },
        }

    def view(self) -> Page:
        """A page that plays the run; with the contact forces if `forces=True` recorded them.

        >>> import drystone as ds
        >>> ds.simulate(ds.scenes.fall7(), steps=60, forces=True).view()
        <Page: run, 61 frames of 8 bodies>
        """
        import numpy as np

        from drystone.viewer import FrameForces, run_page

        forces = None
        if len(self.force_starts) == self.steps + 1 and self.steps > 0:
            # The beginning has no forces of its own: it shows those of the first step.
            first = self.force_starts[1]
            twice = [
                np.concatenate([values[:first], values])
                for values in (self.force_bodies, self.force_points, self.forces)
            ]
            forces = FrameForces(np.concatenate([[0], self.force_starts + first]), *twice)
        times = self.dt * np.arange(self.steps + 1)
        return run_page(
            self.scene,
            times,
            self.poses,
            self.motionless if self.steps else np.ones((1, len(self.names)), dtype=bool),
            self.pivots,
            self.solve_seconds,
            forces,
        )

    def save(self, path: str | PathLike[str]) -> None:
        """Write the run as a compressed NumPy archive (.npz), whole or not at all."""
        from drystone import run_file

        values = {f.name: getattr(self, f.name) for f in fields(self)}
        arrays = {name: value for name, value in values.items() if hasattr(value, "dtype")}
        about = {name: value for name, value in values.items() if name not in arrays}
        about = {**about, "names": list(self.names), "scene": self.scene.to_json()}
        write_whole(Path(path), run_file.pack(about, arrays))

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Run:
        """Read a run that `save` wrote; SimulationError for another or a damaged file."""
        from drystone import run_file

        return cls(**run_file.load(path))


def simulate(
    scene: Scene,
    dt: float = 1 / 240,
    steps: int = 1200,
    reuse: str = "full",
    *,
    restitution: float = 0.0,
    formulation: str = "velocity",
    velocities: Mapping[str, Sequence[float]] | None = None,
    facets: int = FACETS,
    cone: str = CONES[0],
    forces: bool = False,
    progress: Progress | None = None,
) -> Run:
    """Let the bodies of a scene move, from rest or with the `velocities` given by name.

    Every step of `dt` seconds is one complementarity problem of impulses and velocities over the
    contacts that may close in it: resting, sliding with Coulomb's friction, rolling over corners
    and impacts alike. What stands still keeps its place to the bit. `reuse` says what a step takes
    over from the one before; the motion is the same:

    - "full": everything that did not move: impulses, active set, factor rows, contact geometry;
    - "motionless": the solution of the motionless part, solved anew when that part changes, as in
      the paper;
    - "none": nothing.

    `formulation` says what the unknowns of a step are: on the "velocity" level impulses and
    velocities, in one problem that always has a solution; on the "acceleration" level forces and
    accelerations, after impulses where bodies collide, as in the paper. Where no forces exist (as
    at Painlevé's rod) impulses take their place, and `Run.inconsistent` names the bodies. In space
    there is the "velocity" level only.

    `restitution` is the share of the normal velocity with which colliding bodies part (0 to 1).
    `velocities` are (m/s, m/s, rad/s), in space six numbers: m/s along the axes, rad/s about them.
    In space, Coulomb's cones are round from the step on in which a quarter of the blocks move, with
    reuse="full". `facets` and `cone` ("inscribed" or "circumscribed") are the pyramids for what
    stands, for few that move amid many, for the other modes, and for steps in which nothing near
    Coulomb's law was found on round cones: see `check`. With `forces` the run holds the contact
    forces of every step.

    A step that cannot be made, and Ctrl-C, end the run; its status says so, and the steps before
    are kept.

    In motion a coefficient of friction above 100 counts as 100: no load that leans by less than
    89.4 degrees from a face's normal slides on it.

    Raises SimulationError for a `dt` outside 1e-12 to 1e12 s, a `restitution` outside 0 to 1 or
    velocities that are not finite or beyond 1e12, and SceneError for bodies that overlap, or facets
    that are not 3 to 1000.

    >>> import drystone as ds
    >>> run = ds.simulate(ds.scenes.fall7(), steps=240)
    >>> run.moving
    ('6', '7')
    >>> run.poses.shape
    (241, 8, 3)
    >>> boxes = ds.scenes.fall7().extruded(1.0)
    >>> run = ds.simulate(boxes, steps=240)
    >>> run.moving
    ('6', '7')
    >>> run.poses.shape
    (241, 8, 7)
    """
    if not 0 <= steps <= MOST_STEPS:
        raise _core.SimulationError(f"steps is {steps}: it must be from 0 to {MOST_STEPS}")
    if not isinstance(velocities or {}, Mapping):
        raise TypeError(
            f"velocities is {velocities!r}: give them by name, as in {{'1': (1, 0, 0)}}"
        )
    cones = core_cones(facets, cone)
    world = _core.World(scene._core, dt, reuse, restitution, formulation, cones)
    for name, velocity in (velocities or {}).items():
        world.set_velocity(name, velocity_of(world, name, velocity))
    start = Scene._of(world.scene)
    return Run._of(world.run(steps, forces, progress), world, start)


def velocity_of(world: _core.World, name: str, value: Sequence[float]) -> tuple[float, ...]:
    """The velocity of a body as floats: three in the plane, six in space."""
    units = "m/s, m/s, rad/s" if world.dimension == 2 else "m/s three times, rad/s three times"
    return numbers(value, 3 * world.dimension - 3, f'block "{name}": velocity', units)


def numbers(value: float | Sequence[float], count: int, what: str, units: str) -> tuple[float, ...]:
    """`value` as so many floats, one may stand alone; SimulationError naming `what` otherwise."""
    try:
        found = tuple(map(float, (value,) if isinstance(value, int | float) else value))
    except (TypeError, ValueError):
        found = ()
    if len(found) != count:
        spelled = {1: "one", 2: "two", 3: "three", 6: "six"}[count]
        noun = "number" if count == 1 else "numbers"
        message = f"{what} must be {spelled} {noun} ({units}), not {value!r}"
        raise _core.SimulationError(message)
    return found
