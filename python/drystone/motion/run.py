"""The answer of `simulate`: what moved, where to, and the work it took."""

from __future__ import annotations

import copy
from dataclasses import dataclass, field, fields, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drystone import _core
from drystone.common import later
from drystone.common.drawn import DPI, Paged
from drystone.common.files import FILMS, PAGE, PICTURES, RUN, ending_of, write_whole
from drystone.common.text import MOST_ROWS, counted, shorten
from drystone.common.units import quantity
from drystone.motion.modes import ENDINGS
from drystone.scene import Scene

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from drystone.common.later import Page


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Run(Paged):
    """The answer of `simulate`: k steps of n bodies, fixed ones included.

    Most arrays have one entry for each step. `poses` and `velocities` have one more, the beginning.
    With `every` of 2 or more these, and the forces, are kept after every so many steps and after
    the last one only: m moments, at `times`. All other arrays are of every step still.
    """

    status: str
    """How the run ended: "finished"; "interrupted" (Ctrl-C); or why the next step could not be
    made, "unsolved", "too_fast" or "out_of_bounds". The steps before are here. If some of them are
    not exact (see `exact`) it says how many, as in "finished, 3 steps not exact"."""
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
    every: int
    """After how many steps each the bodies are kept."""
    poses: NDArray[np.float64]
    """(k + 1, n, 3): the centre of mass's x and y in metres, and the angle in radians. In space
    (k + 1, n, 7): x, y, z and a unit quaternion (w, x, y, z)."""
    velocities: NDArray[np.float64]
    """(k + 1, n, 3): m/s, m/s, rad/s. In space (k + 1, n, 6): m/s along x, y and z, rad/s about
    them."""
    motionless: NDArray[np.bool_]
    """(k, n): which bodies did not move in the step, not by a bit. Fixed ones never do."""
    pivots: NDArray[np.int64]
    """(k,): major plus minor cycles of all solves of the step."""
    major_cycles: NDArray[np.int64]
    minor_cycles: NDArray[np.int64]
    solves: NDArray[np.int64]
    """(k,): how many problems were solved: a first one, and more until Coulomb's law holds."""
    rows: NDArray[np.int64]
    """(k,): rows of the step's complementarity problem."""
    rows_reused: NDArray[np.int64]
    """(k,): active rows whose part of the factored matrix was taken over from the step before."""
    projections: NDArray[np.int64]
    """(k,): how many times overlaps were removed; the pivots for it are counted in `pivots`."""
    collisions: NDArray[np.int64]
    """(k,): contacts at which bodies collided. Always 0 with the "velocity" formulation, in which a
    collision is a contact like others."""
    inconsistent: NDArray[np.int64]
    """(k, 2): where no forces exist or were found, so that the step was made with impulses, the two
    bodies (indices in `names`) at the contact to blame. -1 and -1 in all other steps."""
    solve_seconds: NDArray[np.float64]
    """(k,): wall time of the solves, the factor included."""
    step_seconds: NDArray[np.float64]
    """(k,): wall time of the whole step."""
    residual: NDArray[np.float64]
    """(k,): of the last solve, in its problem's scale."""
    friction_error: NDArray[np.float64]
    """(k,): how far the worst contact is from Coulomb's law, m/s."""
    exact: NDArray[np.bool_]
    """(k,): whether `friction_error` is small enough: `coulomb_tolerance` times the speed of the
    fastest contact, or the speed that gravity gives in a step if that is more. Steps that pivots
    solve, all in the plane, are exact within 1e-9 m/s, or 1e-9 of the speed above 1 m/s, too.
    Otherwise the step was made with the best solution that was found."""
    penetration: NDArray[np.float64]
    """(k,): deepest overlap at the end of the step, metres."""
    force_starts: NDArray[np.int64]
    """With `forces=True` (k + 1,): the forces of step j are the rows `force_starts[j]` to
    `force_starts[j + 1]` of the three arrays below, with `every` those of the j-th step that is
    kept. Otherwise one zero."""
    force_bodies: NDArray[np.int64]
    """(m, 2): indices of the two bodies in `names`."""
    force_points: NDArray[np.float64]
    """(m, 2), in space (m, 3): where, metres."""
    forces: NDArray[np.float64]
    """As many rows: the mean force of the first body on the second in the step, N."""
    scene: Scene = field(repr=False)
    """The scene at the beginning."""

    @classmethod
    def _of(cls, core: _core.Run, world: _core.World, scene: Scene, every: int) -> Run:
        own = {"names", "dt", "reuse", "restitution", "formulation", "every", "scene"}
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
            every=every,
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
    def step_numbers(self) -> NDArray[np.int64]:
        """(k + 1,), with `every` (m,): after how many steps the bodies are where `poses` says."""
        import numpy as np

        return np.minimum(np.arange(len(self.poses), dtype=np.int64) * self.every, self.steps)

    @property
    def times(self) -> NDArray[np.float64]:
        """The same in seconds, the beginning at 0."""
        return self.step_numbers.astype(float) * self.dt

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
        """How many steps are not `exact`."""
        return int((~self.exact).sum())

    @property
    def by_impulses(self) -> int:
        """How many steps of the "acceleration" formulation were made with impulses, since no forces
        exist or were found."""
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
            f"{quantity(self.dt, 's', 4)}, {counted(int(self.pivots.sum()), 'pivot')}, "
            f"{quantity(float(self.solve_seconds.sum()), 's')} in solves of "
            f"{quantity(float(self.step_seconds.sum()), 's')}."
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

    def table(self, rows: int = MOST_ROWS) -> str:
        """At most `rows` steps as text, evenly spread: what moved, the work, the errors."""
        return later.table(self, rows)

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
            "every": self.every,
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
        return later.page(self)

    def save(self, path: str | PathLike[str], *, dpi: float = DPI) -> None:
        """Write the run as a compressed NumPy archive (.npz), or show it: a page that plays it
        (.html), a film (.gif, .mp4), or a picture of its end (.svg, .pdf, .png).

        The archive is what `load` reads. A film plays at the speed of the run; an .mp4 needs
        ffmpeg. A file is replaced whole or not at all.
        """
        ending = ending_of(path, (RUN, PAGE, *FILMS, *PICTURES))
        if ending == RUN:
            write_whole(Path(path), self._packed())
        elif ending in FILMS:
            later.film(self, path, dpi)
        else:
            self.draw(path, dpi=dpi)

    def _packed(self) -> bytes:
        from drystone.motion import run_file

        values = {f.name: getattr(self, f.name) for f in fields(self)}
        arrays = {name: value for name, value in values.items() if hasattr(value, "dtype")}
        about = {name: value for name, value in values.items() if name not in arrays}
        about = {**about, "names": list(self.names), "scene": self.scene.to_json()}
        return run_file.pack(about, arrays)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Run:
        """Read a run that `save` wrote; SimulationError for another or a damaged file."""
        from drystone.motion import run_file

        return cls(**run_file.load(path))
