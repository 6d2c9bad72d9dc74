"""A recording as NumPy arrays: what plans and runs are turned into, and pages made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from drystone.common.text import counted
from drystone.recording.contract import (
    FORMAT,
    VERSION,
    BodyJson,
    ForcesJson,
    LoadJson,
    PieceJson,
    RecordingJson,
    SeriesJson,
    packed,
)
from drystone.scene import Body, Load, Solid

POSE = {2: 3, 3: 7}
"""Numbers of a pose, by dimension."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class FrameForces:
    """Contact forces of all frames, one after another: frame k's are offsets[k]:offsets[k + 1].

    Raises ValueError if the arrays do not fit together.
    """

    offsets: ArrayLike
    """(frames + 1,) ascending, from 0 to the number of forces."""
    bodies: ArrayLike
    """(forces, 2): indices of the body that pushes and of the one that is pushed."""
    points: ArrayLike
    """(forces, dimension): where, m."""
    vectors: ArrayLike
    """(forces, dimension): the force on the second body, N."""
    kept: ArrayLike | None = None
    """(frames,) bool: whose forces are known. By default every frame's are."""

    def __post_init__(self) -> None:
        offsets = np.asarray(self.offsets)
        total = int(offsets[-1]) if offsets.ndim == 1 and len(offsets) > 0 else -1
        if total < 0 or offsets[0] != 0 or np.any(np.diff(offsets) < 0):
            raise ValueError("offsets must be (frames + 1,), ascending from 0")
        _shaped(self.bodies, (total, 2), "bodies")
        dimension = 3 if np.shape(self.vectors)[1:] == (3,) else 2
        for name in ("points", "vectors"):
            _shaped(getattr(self, name), (total, dimension), name)

    def __repr__(self) -> str:
        frames = np.size(self.offsets) - 1
        return f"<FrameForces: {len(np.asarray(self.points))} forces in {frames} frames>"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Series:
    """One chart under the picture."""

    name: str
    """What is plotted, such as "pivots per step"."""
    values: ArrayLike
    """(frames,), NaN where there is none."""
    unit: str = ""
    """"s", "g" (9.81 m/s^2), or nothing for a count."""
    together: Literal["sum", "least"] = "sum"
    """What is shown of steps that have no frame of their own: the sum of their values with that of
    the next frame, or the least of these."""

    def __repr__(self) -> str:
        return f"<Series: {self.name!r}, {np.size(self.values)} frames>"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Recording:
    """What the viewer plays. Raises ValueError, naming the array, if shapes do not fit together.

    Frames are the states shown, one after another. Every array's last axes are per body, in the
    order of `bodies`.
    """

    kind: Literal["plan", "run", "motion"]
    title: str
    bodies: Sequence[Body | Solid]
    """Fixed ones included; solids where gravity has three numbers."""
    states: NDArray[np.uint8]
    """(frames, bodies): `ABSENT`, `PRESENT`, `MOTIONLESS`, `NEXT` or `FALLING` of the contract."""
    gravity: tuple[float, ...] = (0.0, -9.81)
    """m/s^2: in the plane two numbers, in space three."""
    poses: NDArray[np.float64] | None = None
    """(frames, bodies, 3): x, y (m) and angle (rad, as `Body.angle`); in space (frames, bodies, 7):
    x, y, z (m) and a unit quaternion w, x, y, z. None: nothing moves."""
    times: NDArray[np.float64] | None = None
    """(frames,), s, ascending."""
    steps: NDArray[np.int64] | None = None
    """(frames,): the step that each frame shows. None: frame k shows step k."""
    held: NDArray[np.bool_] | None = None
    """(frames, bodies): what a hand or a scaffold holds. None: nothing is held."""
    forces: FrameForces | None = None
    loads: Sequence[Load] = ()
    """Permanent loads, as they act while bodies are where `bodies` has them. Those without a force
    are not shown."""
    series: Sequence[Series] = ()
    captions: Sequence[tuple[int, str]] = ()
    """(frame, text): what is said from that frame on."""
    notes: Sequence[str] = field(default=())
    """Lines under the picture: what the reader has to know."""
    details: Sequence[str] = field(default=())
    """Lines beside the charts, seen by those who open them: how much work it took."""

    def __repr__(self) -> str:
        frames, bodies = np.shape(self.states)
        of = f"{counted(frames, 'frame')} of {counted(bodies, 'body', 'bodies')}"
        return f"<Recording: {self.kind}, {of}>"

    @property
    def dimension(self) -> Literal[2, 3]:
        """Of the space that the bodies are in."""
        return 3 if len(self.gravity) == 3 else 2

    def __post_init__(self) -> None:
        frames, bodies = len(self.states), len(self.bodies)
        pose = POSE[self.dimension]
        _shaped(self.states, (frames, bodies), "states")
        if frames == 0:
            raise ValueError("a recording has at least one frame")
        for name, shape in (("poses", (frames, bodies, pose)), ("times", (frames,))):
            if getattr(self, name) is not None:
                _finite(_shaped(getattr(self, name), shape, name), name)
        if self.times is not None and np.any(np.diff(self.times) < 0):
            raise ValueError("times must ascend")
        if self.steps is not None:
            _shaped(self.steps, (frames,), "steps")
        if self.held is not None:
            _shaped(self.held, (frames, bodies), "held")
        if self.forces is not None:
            _shaped(self.forces.offsets, (frames + 1,), "offsets of the forces")
            total = len(np.asarray(self.forces.bodies))
            _shaped(self.forces.vectors, (total, self.dimension), "vectors of the forces")
            _finite(np.asarray(self.forces.vectors), "vectors of the forces")
        for one in self.series:
            _shaped(one.values, (frames,), one.name)

    def to_json(self) -> RecordingJson:
        """The recording as the page reads it."""
        return {
            "format": FORMAT,
            "version": VERSION,
            "kind": self.kind,
            "dimension": self.dimension,
            "title": self.title,
            "notes": list(self.notes),
            "details": list(self.details),
            "gravity": list(self.gravity),
            "bodies": [_body(body) for body in self.bodies],
            "frames": {
                "count": len(self.states),
                "steps": None if self.steps is None else packed(self.steps.astype(np.uint32)),
                "times": None if self.times is None else packed(self.times.astype(np.float64)),
                "poses": None if self.poses is None else packed(self.poses.astype(np.float32)),
                "states": packed(self.states.astype(np.uint8)),
                "held": None if self.held is None else packed(self.held.astype(np.uint8)),
                "captions": [(int(frame), text) for frame, text in self.captions],
            },
            "forces": None if self.forces is None else _forces(self.forces),
            "loads": self._loads(),
            "series": [_series(one) for one in self.series],
        }

    def _loads(self) -> list[LoadJson]:
        index = {body.name: place for place, body in enumerate(self.bodies)}
        return [
            {"body": index[load.body], "at": list(load.at), "force": list(load.force)}
            for load in self.loads
            if any(load.force)
        ]


def own_frame(body: Body) -> NDArray[np.float64]:
    """(n, 2): corners about the centre of mass, not turned, m."""
    cos, sin = np.cos(body.angle), np.sin(body.angle)
    arm: NDArray[np.float64] = body.vertices - np.asarray(body.center_of_mass)
    back: NDArray[np.float64] = arm @ np.array([[cos, -sin], [sin, cos]])
    return back


def rows_of(starts: NDArray[np.int64], counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """starts[0], starts[0] + 1, ... (counts[0] of them), starts[1], and so on."""
    before = np.cumsum(counts) - counts
    rows: NDArray[np.int64] = np.repeat(starts - before, counts) + np.arange(counts.sum())
    return rows


def _body(body: Body | Solid) -> BodyJson:
    pose = (
        (*body.center_of_mass, body.angle)
        if isinstance(body, Body)
        else (*body.center_of_mass, *body.orientation)
    )
    return {
        "name": body.name,
        "fixed": body.fixed,
        "mass": body.mass,
        "density": body.density,
        "friction": body.friction,
        "vertices": own_frame(body).tolist() if isinstance(body, Body) else None,
        "pieces": None if isinstance(body, Body) else _pieces(body),
        "pose": [float(value) for value in pose],
    }


def _pieces(body: Solid) -> list[PieceJson]:
    if body.surface is not None:
        vertices, faces = body.surface.vertices.tolist(), body.surface.triangles.tolist()
        return [{"vertices": vertices, "faces": faces, "surface": True}]
    return [
        {
            "vertices": piece.vertices.tolist(),
            "faces": [list(face) for face in piece.faces],
            "surface": False,
        }
        for piece in body.pieces
    ]


def _forces(forces: FrameForces) -> ForcesJson:
    """Columns, so that what stays equal from frame to frame deflates to almost nothing."""
    offsets = np.asarray(forces.offsets)
    frames = np.arange(len(offsets) - 1)
    if forces.kept is not None:
        frames = frames[np.asarray(forces.kept, dtype=bool)]
    counts = np.diff(offsets)[frames]
    rows = rows_of(offsets[frames], counts)

    def columns(values: ArrayLike, kind: type[np.generic]) -> NDArray[Any]:
        return np.ascontiguousarray(np.asarray(values)[rows].T, dtype=kind)

    return {
        "frames": packed(frames.astype(np.uint32)),
        "offsets": packed(np.concatenate([[0], np.cumsum(counts)]).astype(np.uint32)),
        "bodies": packed(columns(forces.bodies, np.uint32)),
        "points": packed(columns(forces.points, np.float32)),
        "vectors": packed(columns(forces.vectors, np.float32)),
    }


def _series(series: Series) -> SeriesJson:
    values = np.asarray(series.values, dtype=np.float32)
    return {"name": series.name, "unit": series.unit, "values": packed(values)}


def _shaped(array: ArrayLike, shape: tuple[int, ...], name: str) -> NDArray[Any]:
    found = np.asarray(array)
    if found.shape != shape:
        raise ValueError(f"{name} has the shape {found.shape}: it must be {shape}")
    return found


def _finite(array: NDArray[Any], name: str) -> None:
    if not np.all(np.isfinite(array)):
        raise ValueError(f"{name} holds a NaN or an infinity")
