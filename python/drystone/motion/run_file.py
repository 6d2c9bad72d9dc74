"""Recorded runs on disk: a NumPy archive (.npz) with an array a field, and the rest as JSON.

Whoever reads one may meet any bytes. So every array is measured before memory is taken for it, and
type, shape and range of each are looked at: a run is taken whole, or a SimulationError says why.
"""

from __future__ import annotations

import io
import json
import math
import os
import zipfile
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone import _core
from drystone.motion.modes import ENDINGS, FORMULATIONS, REUSE
from drystone.scene import Scene

if TYPE_CHECKING:
    from numpy.typing import NDArray

FORMAT = "drystone-run"
VERSION = 1

MOST_SQUEEZED = 1100
"""Deflate makes at most 1032 bytes of one: a member that claims more is none of ours."""

LONGEST_HEADER = 10_000
"""Bytes that say type and shape of an array; ours take some hundred."""

ABOUT: dict[str, Any] = {
    "status": str,
    "reason": (str, type(None)),
    "names": list,
    "dt": float,
    "reuse": str,
    "restitution": (int, float),
    "formulation": str,
    "every": int,
    "scene": str,
}
"""What is said beside the arrays, and its types in JSON."""


def pack(about: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> bytes:
    """The content of a file."""
    out = io.BytesIO()
    whole = {"format": FORMAT, "version": VERSION, **about}
    np.savez_compressed(out, about=np.array(json.dumps(whole)), **arrays)  # type: ignore[arg-type]
    return out.getvalue()


def load(path: str | PathLike[str]) -> dict[str, Any]:
    """The fields of a run; SimulationError for a file that holds none, OSError for no file."""
    content = Path(path).read_bytes()
    try:
        return _unpacked(content)
    except Exception as error:  # a damaged archive is an error of zipfile, zlib, NumPy, json, ...
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise _core.SimulationError(
            f"{os.fspath(path)}: this is no run that drystone recorded ({reason})"
        ) from None


def _unpacked(content: bytes) -> dict[str, Any]:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        members = {info.filename.removesuffix(".npy"): info for info in archive.infolist()}
        if len(members) != len(archive.infolist()) or "about" not in members:
            raise ValueError("it is another archive")
        arrays = {name: _array(archive, info) for name, info in members.items()}
    about = json.loads(str(arrays.pop("about")))
    if not isinstance(about, dict) or (about.pop("format", None), about.pop("version", None)) != (
        FORMAT,
        VERSION,
    ):
        raise ValueError("it is of another format or version")
    if "formulation" not in about:  # written when there was one only
        steps = len(arrays["pivots"])
        about["formulation"] = "velocity"
        arrays["collisions"] = np.zeros(steps, dtype=np.int64)
        arrays["inconsistent"] = np.full((steps, 2), -1, dtype=np.int64)
    about.setdefault("every", 1)  # written when there was no other
    if "exact" not in arrays and "friction_error" in arrays:  # written before it was kept
        arrays["exact"] = arrays["friction_error"] <= 1e-8
    checked = _checked_about(about)
    return {**checked, **_checked_arrays(arrays, about["names"], about["every"])}


def _array(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> NDArray[Any]:
    """One array, read-only. Memory is taken for what is there, not for what a header claims."""
    if info.file_size > MOST_SQUEEZED * (info.compress_size + 1):
        raise ValueError(f"{info.filename} claims more than it holds")
    with archive.open(info) as file:
        data = file.read(info.file_size)
        if len(data) != info.file_size or file.read(1):
            raise ValueError(f"{info.filename} has another length than it says")
    head = io.BytesIO(data)
    version = np.lib.format.read_magic(head)
    if version not in ((1, 0), (2, 0)):
        raise ValueError(f"{info.filename} is an array of another version")
    read = (
        np.lib.format.read_array_header_1_0
        if version == (1, 0)
        else np.lib.format.read_array_header_2_0
    )
    shape, by_columns, dtype = read(head, max_header_size=LONGEST_HEADER)
    size = math.prod(shape) * dtype.itemsize
    if dtype.kind not in "fibU" or min(shape, default=0) < 0 or size != len(data) - head.tell():
        raise ValueError(f"{info.filename} holds something else than it says")
    if size == 0:
        return np.zeros(shape, dtype)
    order: Any = "F" if by_columns else "C"
    return np.frombuffer(data, dtype, offset=head.tell()).reshape(shape, order=order)


def _checked_about(about: dict[str, Any]) -> dict[str, Any]:
    if about.keys() != ABOUT.keys():
        raise ValueError(f"its fields are {', '.join(sorted(about))[:80]}")
    for field, kind in ABOUT.items():
        if not isinstance(about[field], kind) or isinstance(about[field], bool):
            raise ValueError(f"its {field} is {about[field]!r:.60}")
    scene = Scene.from_json(about["scene"])
    if about["names"] != scene.names:
        raise ValueError("its names are not those of its scene")
    words = {"status": ENDINGS, "reuse": REUSE, "formulation": FORMULATIONS}
    for field, known in words.items():
        if about[field].partition(",")[0] not in known:
            raise ValueError(f"its {field} is {about[field]!r:.60}")
    if not (0 < about["dt"] < math.inf and 0 <= about["restitution"] <= 1):
        raise ValueError("its dt or its restitution is out of range")
    if about["every"] < 1:
        raise ValueError("its every is not 1 or more")
    return {**about, "names": tuple(about["names"]), "scene": scene}


def _checked_arrays(
    arrays: dict[str, NDArray[Any]], names: list[str], every: int
) -> dict[str, NDArray[Any]]:
    """The arrays, of the types and shapes that `Run` says."""
    steps, bodies = len(arrays["pivots"]), len(names)
    moments = -(-steps // every) + 1
    axes = 2 if arrays["poses"].shape[-1:] == (3,) else 3
    forces, starts = len(arrays["forces"]), len(arrays["force_starts"])
    counts = [
        "pivots",
        "major_cycles",
        "minor_cycles",
        "solves",
        "rows",
        "rows_reused",
        "projections",
        "collisions",
    ]
    times = ["solve_seconds", "step_seconds", "residual", "friction_error", "penetration"]
    wanted: dict[str, tuple[type, tuple[int, ...]]] = {
        "poses": (np.float64, (moments, bodies, 3 if axes == 2 else 7)),
        "velocities": (np.float64, (moments, bodies, 3 if axes == 2 else 6)),
        "motionless": (np.bool_, (steps, bodies)),
        "exact": (np.bool_, (steps,)),
        "inconsistent": (np.int64, (steps, 2)),
        "force_starts": (np.int64, (starts,)),
        "force_bodies": (np.int64, (forces, 2)),
        "force_points": (np.float64, (forces, axes)),
        "forces": (np.float64, (forces, axes)),
        **dict.fromkeys(counts, (np.int64, (steps,))),
        **dict.fromkeys(times, (np.float64, (steps,))),
    }
    if arrays.keys() != wanted.keys():
        raise ValueError(f"its arrays are {', '.join(sorted(arrays))[:80]}")
    for name, (dtype, shape) in wanted.items():
        if arrays[name].dtype != dtype or arrays[name].shape != shape:
            raise ValueError(f"its {name} is of type {arrays[name].dtype}, {arrays[name].shape}")
        arrays[name].flags.writeable = False
    _require_places(arrays["force_bodies"], 0, bodies, "force_bodies")
    _require_places(arrays["inconsistent"], -1, bodies, "inconsistent")
    _require_places(arrays["force_starts"], 0, forces + 1, "force_starts")
    rises = bool(np.all(np.diff(arrays["force_starts"]) >= 0))
    if starts not in (1, moments) or not rises or arrays["force_starts"][-1] != forces:
        raise ValueError("its force_starts do not fit its forces")
    return arrays


def _require_places(array: NDArray[np.int64], low: int, high: int, name: str) -> None:
    if array.size and not (low <= array.min() and array.max() < high):
        raise ValueError(f"its {name} are out of range")
