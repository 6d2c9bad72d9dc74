"""Which data are those of COMPAS: told without loading what reads them."""

from __future__ import annotations

from typing import Any


def kind_of(value: Any) -> str:
    """The class of an object by its data, as in "Mesh"; empty for other data."""
    if not isinstance(value, dict):
        return ""
    return str(value.get("dtype", value.get("datatype", ""))).rsplit("/", 1)[-1]


def is_assembly(data: Any) -> bool:
    """Whether JSON data is an assembly (of COMPAS 2, or of COMPAS 1 with its other keys), a model
    of compas_model or compas_dem, or one mesh."""
    kind = kind_of(data)
    if kind.endswith(("Assembly", "Model")) or kind == "Mesh":
        return True
    found = data.get("data", data.get("value")) if kind else None
    return isinstance(found, dict) and {"elements", "graph"} <= found.keys()
