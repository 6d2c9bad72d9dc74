"""Meshes: from a file to the convex pieces of a rigid body, or to an error with the fix.

A name below is loaded when it is first used: it needs the extra "meshes".
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from drystone.common.extras import extra
from drystone.meshes.errors import MeshError, MeshWarning

if TYPE_CHECKING:
    from drystone.meshes.part import MOST_PIECES, Part, part_of, read_part
    from drystone.meshes.simplify import Simplification

__all__ = [
    "MOST_PIECES",
    "MeshError",
    "MeshWarning",
    "Part",
    "Simplification",
    "part_of",
    "read_part",
]

_HOMES = {
    "MOST_PIECES": "drystone.meshes.part",
    "Part": "drystone.meshes.part",
    "Simplification": "drystone.meshes.simplify",
    "part_of": "drystone.meshes.part",
    "read_part": "drystone.meshes.part",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'drystone.meshes' has no attribute {name!r}")
    with extra("meshes", "meshes"):
        value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value
