"""What a page is given: a recording, as JSON. Version 2.

`viewer/src/contract.ts` is the same contract for the side that reads it, with a word on each field.
Units are SI: metres, kilograms, seconds, radians, newtons.
"""

from __future__ import annotations

import base64
import zlib
from typing import Any, Final, Literal, TypedDict

import numpy as np
from numpy.typing import NDArray

FORMAT: Final = "drystone-recording"
VERSION: Final = 2

ABSENT = 0
"""Not there: taken away, or not there yet."""
PRESENT = 1
"""Part of the structure; in a run, moving."""
MOTIONLESS = 2
"""In a run: motionless."""
NEXT = 3
"""In a plan: the block taken away in the step that follows."""
FALLING = 4
"""Falls, or would fall."""


class Packed(TypedDict):
    """A little-endian array in row-major order, deflated (zlib, RFC 1950), in base64."""

    dtype: Literal["u8", "u32", "f32", "f64"]
    shape: list[int]
    data: str


class PieceJson(TypedDict):
    """A convex polyhedron, unless it is a closed surface, in its body's frame; faces are
    counter-clockwise from outside."""

    vertices: list[list[float]]
    faces: list[list[int]]
    surface: bool


class BodyJson(TypedDict):
    """A body; everything else names bodies by their index."""

    name: str
    fixed: bool
    mass: float
    density: float
    friction: float
    vertices: list[list[float]] | None
    pieces: list[PieceJson] | None
    pose: list[float]


class FramesJson(TypedDict):
    """What is where: `states`, `held` u8 (count, bodies), `poses` f32 (count, bodies, 3 or 7)."""

    count: int
    steps: Packed | None
    times: Packed | None
    poses: Packed | None
    states: Packed
    held: Packed | None
    captions: list[tuple[int, str]]


class ForcesJson(TypedDict):
    """Contact forces, in columns: those of `frames[k]` are offsets[k] to offsets[k + 1]."""

    frames: Packed
    offsets: Packed
    bodies: Packed
    points: Packed
    vectors: Packed


class LoadJson(TypedDict):
    """A permanent load: `at` is where it acts while the body is at its own pose."""

    body: int
    at: list[float]
    force: list[float]


class SeriesJson(TypedDict):
    """One chart: `values` is f32 (count), NaN for none."""

    name: str
    unit: str
    values: Packed


class RecordingJson(TypedDict):
    """The whole."""

    format: str
    version: int
    kind: Literal["plan", "run", "motion"]
    dimension: Literal[2, 3]
    title: str
    notes: list[str]
    details: list[str]
    gravity: list[float]
    bodies: list[BodyJson]
    frames: FramesJson
    forces: ForcesJson | None
    loads: list[LoadJson]
    series: list[SeriesJson]


_CODES: dict[Any, Literal["u8", "u32", "f32", "f64"]] = {
    np.dtype("<u1"): "u8",
    np.dtype("<u4"): "u32",
    np.dtype("<f4"): "f32",
    np.dtype("<f8"): "f64",
}
LEVEL = 6
"""Of deflating: more is slower and saves a few hundredths."""


def packed(array: NDArray[Any]) -> Packed:
    """An array of one of the four types of the contract, as JSON knows it."""
    little = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<"))
    data = base64.b64encode(zlib.compress(little.tobytes(), LEVEL)).decode("ascii")
    return {"dtype": _CODES[little.dtype], "shape": list(array.shape), "data": data}


def unpacked(value: Packed) -> NDArray[Any]:
    """The array again."""
    kind = next(dtype for dtype, code in _CODES.items() if code == value["dtype"])
    data = zlib.decompress(base64.b64decode(value["data"]))
    return np.frombuffer(data, dtype=kind).reshape(value["shape"])
