"""A mesh file: a body for each object in it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from drystone.imports.collected import Collected
from drystone.meshes.part import read_parts


def read(
    path: Path,
    collected: Collected,
    split: str | None = None,
    **options: Any,
) -> str:
    """Add the bodies of a file, and return the name of the format; lengths are in its unit. The
    `options` are those of `read_parts`."""
    parts, found = read_parts(path, split=split, tolerance=collected.mesh_tolerance, **options)
    collected.say(path.name, found.messages)
    for name in found.empty:
        collected.leave_out(f"object {name}", "it has no faces")
    for part in parts:
        collected.say(part.name, part.messages)
        factor, tolerance = part.density_factor, part.tolerance
        collected.add(
            part.name,
            part.pieces,
            density_factor=factor,
            tolerance=tolerance,
            triangles=part.triangles,
        )
    return "mesh" if len(parts) == 1 else "mesh of objects"
