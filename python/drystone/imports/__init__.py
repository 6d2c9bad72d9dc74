"""Assemblies that other tools wrote: COMPAS, folders of part meshes, MJCF, URDF.

A name below is loaded when it is first used: it needs the extra "meshes".
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from drystone.common.extras import extra

if TYPE_CHECKING:
    from drystone.imports.collected import FormatError, ImportedBody, LeftOut
    from drystone.imports.imported import Imported, load

__all__ = ["FormatError", "Imported", "ImportedBody", "LeftOut", "load"]

_HOMES = {
    "FormatError": "drystone.imports.collected",
    "Imported": "drystone.imports.imported",
    "ImportedBody": "drystone.imports.collected",
    "LeftOut": "drystone.imports.collected",
    "load": "drystone.imports.imported",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'drystone.imports' has no attribute {name!r}")
    with extra("meshes", "files of other tools"):
        value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value
