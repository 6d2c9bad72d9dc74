"""Meshes: from a file to the convex pieces of a rigid body, or to an error with the fix."""

from drystone.meshes.errors import MeshError, MeshWarning
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
