"""A folder of part meshes.

With a `manifest.json` (docs/guide/import.md has its fields) the parts are those that it lists.
Without one every mesh file is a part, as LearningToAssemble keeps them (`0.obj`, `1.obj`, ...), and
the `config.json` of ASAP and Assemble-Them-All, if there is one, says where they go.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from drystone.common.text import like
from drystone.imports.collected import Collected, FormatError
from drystone.imports.fields import entries, finite, numbers, read_json
from drystone.imports.pose import Pose, from_euler, from_quaternion
from drystone.imports.wholes import whole_files
from drystone.meshes import Part, read_part
from drystone.meshes.reading import ENDINGS

MANIFEST = "manifest.json"
FIELDS = {"name", "file", "position", "orientation", "scale", "density", "friction", "fixed"}


def read(folder: Path, collected: Collected, **options: Any) -> None:
    """Add the parts in a folder; `options` are those of `read_part`, lengths in the parts' unit."""
    if (folder / MANIFEST).exists():
        read_manifest(folder / MANIFEST, collected, **options)
        return
    files = sorted((p for p in folder.iterdir() if p.suffix.lower() in ENDINGS), key=_natural)
    if not files:
        raise FormatError(f"{folder}: no mesh files in it ({', '.join(ENDINGS)}) and no {MANIFEST}")
    poses = _asap_poses(folder)
    wholes = whole_files(files)
    for file in files:
        if file in wholes:
            collected.leave_out(file.name, "the whole beside its parts, which have numbers")
            continue
        part = read_part(file, tolerance=collected.mesh_tolerance, **options)
        _add(collected, part, poses.get(file.stem, Pose.identity()))
    for name in sorted(poses.keys() - {file.stem for file in files}):
        collected.leave_out(f"part {name} of config.json", "there is no mesh of that name")


def read_manifest(path: Path, collected: Collected, **options: Any) -> None:
    """Add the parts that a manifest lists; their files are beside it. `options` as for `read`."""
    manifest = entries(read_json(path), f"{path}: a manifest is an object with a list of parts")
    parts = manifest.get("parts")
    if not isinstance(parts, list) or not parts:
        raise FormatError(f"{path}: it lists no parts")
    for key in sorted(manifest.keys() - {"parts"}):
        collected.leave_out(f"{key!r} in {path.name}", "no field of a manifest")
    for number, part in enumerate(parts):
        _add_listed(path, f"{path}: part {number}", part, collected, options)


def _add_listed(
    path: Path,
    what: str,
    part: Any,
    collected: Collected,
    options: dict[str, Any],
) -> None:
    fields = entries(part, f"{what} must be an object with a file")
    unknown = sorted(fields.keys() - FIELDS)
    if unknown:
        raise FormatError(
            f"{what}: unknown field {unknown[0]!r}{like(unknown[0], FIELDS)}: known are "
            f"{', '.join(sorted(FIELDS))}"
        )
    file, name = fields.get("file"), fields.get("name")
    if not isinstance(file, str) or not isinstance(name, (str, type(None))):
        raise FormatError(f"{what}: file and name must be strings, and file is needed")
    if not (path.parent / file).exists():
        beside = [p.name for p in path.parent.iterdir() if p.suffix.lower() in ENDINGS]
        raise FormatError(
            f"{what}: there is no file {file!r} beside the manifest{like(file, beside)}"
        )
    if not isinstance(fields.get("fixed", False), bool):
        raise FormatError(f"{what}: fixed must be true or false")
    if "scale" in fields:
        options = {**options, "scale": finite(fields["scale"], f"{what}: scale")}
    read = read_part(path.parent / file, name=name, tolerance=collected.mesh_tolerance, **options)
    position = numbers(fields.get("position", [0, 0, 0]), 3, f"{what}: position")
    turned = numbers(fields.get("orientation", [1, 0, 0, 0]), 4, f"{what}: orientation")
    if not any(turned):
        raise FormatError(f"{what}: orientation must be a quaternion (w, x, y, z), not zeros")
    own = {
        key: finite(fields[key], f"{what}: {key}")
        for key in ("density", "friction")
        if key in fields
    }
    pose = Pose(np.array(position), from_quaternion(turned))
    _add(collected, read, pose, fixed=fields.get("fixed", False), **own)


def _add(collected: Collected, part: Part, pose: Pose, **options: Any) -> None:
    collected.say(part.name, part.messages)
    pieces = [pose.apply(piece) for piece in part.pieces]
    factor, tolerance = part.density_factor, part.tolerance
    collected.add(
        part.name,
        pieces,
        density_factor=factor,
        tolerance=tolerance,
        triangles=part.triangles,
        **options,
    )


def _asap_poses(folder: Path) -> dict[str, Pose]:
    """Where ASAP's config.json puts each part when it is assembled: x, y, z and three angles about
    fixed axes, radians."""
    path = folder / "config.json"
    if not path.exists():
        return {}
    poses = {}
    for name, entry in entries(read_json(path), f"{path}: it names no parts").items():
        state = entry.get("final_state") if isinstance(entry, dict) else None
        if state is None:
            continue
        six = numbers(
            [*state, 0, 0, 0] if len(state) == 3 else state, 6, f"{path}: {name}: final_state"
        )
        poses[name] = Pose(np.array(six[:3]), from_euler("xyz", six[3:]))
    return poses


def _natural(path: Path) -> list[tuple[int, str]]:
    """Sorts 2.obj before 10.obj."""
    return [(int(x), "") if x.isdigit() else (-1, x) for x in re.split(r"(\d+)", path.stem)]
