"""Assemblies that other tools wrote: COMPAS, folders of part meshes, MJCF, URDF."""

from drystone.imports.collected import FormatError, ImportedBody, LeftOut
from drystone.imports.imported import Imported, load

__all__ = ["FormatError", "Imported", "ImportedBody", "LeftOut", "load"]
