"""How does it move? Exact contact in the plane and in space, step by step."""

from __future__ import annotations

from collections.abc import Mapping

from drystone import _core
from drystone.common.cones import FACETS, INSCRIBED, Pyramid, core_cones
from drystone.common.numbers import Floats, name_of, number, vector, whole, word
from drystone.motion.memory import warn_of_much_memory
from drystone.motion.modes import COULOMB_TOLERANCE, MOST_STEPS, Formulation, Progress, Reuse
from drystone.motion.run import Run
from drystone.scene import Scene
from drystone.scene.scene import scene_of


def simulate(
    scene: Scene,
    dt: float = 1 / 240,
    steps: int = 1200,
    reuse: Reuse = "full",
    *,
    restitution: float = 0.0,
    formulation: Formulation = "velocity",
    coulomb_tolerance: float = COULOMB_TOLERANCE,
    velocities: Mapping[str, Floats] | None = None,
    facets: int = FACETS,
    cone: Pyramid = INSCRIBED,
    forces: bool = False,
    every: int = 1,
    progress: Progress | None = None,
) -> Run:
    """How do the bodies of a scene move? Makes `steps` steps of `dt` seconds, and records them.

    In each step one problem is solved for all contacts together, whether they rest, slide by
    Coulomb's law, roll over a corner or collide. What stands still keeps its place, to the bit.

    `velocities` are those at the beginning, by name: (m/s, m/s, rad/s); in space six numbers, m/s
    along the axes and rad/s about them. Bodies that are not named begin at rest. `restitution`,
    from 0 to 1, is the share of the speed with which colliding bodies part; it is less in a step in
    which it would give energy. With `forces` the run holds the contact forces of every step.

    A run is kept in memory, some 50 bytes for each body and step in the plane and 100 in space; a
    UserWarning says so where that is more than 1 GB. With `every` the bodies, and the forces, are
    kept of every so many steps and the last (`Run.times`).

    `reuse` says what a step takes over from the step before. The motion is the same:

    - "full": everything about bodies that did not move: impulses, active set, rows of the factor,
      contacts;
    - "motionless": the solution of the part that does not move, solved again when that part
      changes, as in the paper;
    - "none": nothing.

    `formulation` says what is solved for:

    - "velocity": impulses and the velocities at the end of the step. There is always a solution;
    - "acceleration": forces and accelerations, as in the paper; collisions are solved before that,
      with impulses. In the plane only. Sometimes no forces exist (Painlevé's rod): the step is then
      made with impulses, and `Run.inconsistent` names the bodies.

    In space friction cones are round as soon as a quarter of the blocks move, with reuse="full".
    Otherwise, and in steps for which no answer was found on round cones, they are pyramids:
    `facets` and `cone` ("inscribed" or "circumscribed") are as in `check`.

    A step counts as exact (`Run.exact`) if it is off Coulomb's law by at most `coulomb_tolerance`
    times the speed of the fastest contact, or the speed that gravity gives in a step if that is
    more. Where a body turns by more than a radian in a step near another, the step is made in
    several shorter ones.

    If a step cannot be made, or after Ctrl-C, the run ends; its status says why, and the steps
    before are kept. A coefficient of friction above 100 counts as 100: nothing slides unless it is
    pushed within 0.6 degrees of the face.

    Raises SimulationError for a `dt` outside 1e-12 to 1e12 s, a `restitution` outside 0 to 1, a
    `coulomb_tolerance` that is not above 0 or is above 1, or velocities that are not finite or
    beyond 1e12, and SceneError for bodies that overlap, or facets that are not 3 to 1000.

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
    whole(steps, "steps", _core.SimulationError)
    if not 0 <= steps <= MOST_STEPS:
        raise _core.SimulationError(f"steps is {steps}: it must be from 0 to {MOST_STEPS}")
    if not isinstance(velocities or {}, Mapping):
        raise TypeError(
            f"velocities is {velocities!r}: give them by name, as in {{'1': (1, 0, 0)}}"
        )
    whole_every(every)
    cones = core_cones(facets, cone)
    world = core_world(scene, dt, reuse, restitution, formulation, coulomb_tolerance, cones)
    for name, velocity in (velocities or {}).items():
        world.set_velocity(name_of(name), velocity_of(world, name, velocity))
    begun = Scene._of(world.scene)
    warn_of_much_memory(steps, every, len(begun), begun.dimension, forces)
    return Run._of(world.run(steps, forces, progress, every), world, begun, every)


def whole_every(every: int) -> None:
    """SimulationError unless it is one or more."""
    if not 1 <= whole(every, "every", _core.SimulationError) <= MOST_STEPS:
        raise _core.SimulationError(f"every is {every}: it must be from 1 to {MOST_STEPS}")


def core_world(
    scene: Scene,
    dt: float,
    reuse: str,
    restitution: float,
    formulation: str,
    coulomb_tolerance: float,
    cones: tuple[int, str],
) -> _core.World:
    """A scene at rest, about to move; TypeError for arguments of another type."""
    return _core.World(
        scene_of(scene)._core,
        number(dt, "dt"),
        word(reuse, "reuse"),
        number(restitution, "restitution"),
        word(formulation, "formulation"),
        number(coulomb_tolerance, "coulomb_tolerance"),
        cones,
    )


def velocity_of(world: _core.World, name: str, value: Floats) -> tuple[float, ...]:
    """The velocity of a body as floats: three in the plane, six in space."""
    units = "m/s, m/s, rad/s" if world.dimension == 2 else "m/s three times, rad/s three times"
    return numbers(value, 3 * world.dimension - 3, f'block "{name}": velocity', units)


def numbers(value: float | Floats, count: int, what: str, units: str) -> tuple[float, ...]:
    """`value` as so many floats, one may stand alone; errors name `what` and its units."""
    given = (value,) if isinstance(value, int | float) else value
    spelled = {1: "one number", 2: "two numbers", 3: "three numbers", 6: "six numbers"}[count]
    return vector(given, count, what, f"{spelled} ({units})", _core.SimulationError)
