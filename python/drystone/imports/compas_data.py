"""Data of COMPAS objects, from a file or from the objects themselves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.imports.collected import FormatError
from drystone.imports.fields import finite

if TYPE_CHECKING:
    from numpy.typing import NDArray

DEEPEST = 50
"""Objects inside objects."""


PLAIN = frozenset({float, int, str, bool, type(None)})
"""What is written as it is."""


EDGES = "edge"
"""Where a graph keeps them. Interfaces lie on them, many points and frames, which are not read."""


def is_live(value: Any) -> bool:
    """Whether a value is a COMPAS object: compas itself need not be there."""
    return hasattr(value, "__data__") and hasattr(value, "__dtype__")


def data_of(value: Any, depth: int = 0) -> Any:
    """A COMPAS object as `compas.json_dump` writes it, without writing it."""
    if type(value) in PLAIN:  # most are
        return value
    if depth > DEEPEST:
        raise FormatError(f"its data are more than {DEEPEST} objects deep")
    if is_live(value):
        return {"dtype": value.__dtype__, "data": data_of(value.__data__, depth + 1)}
    if isinstance(value, dict):
        return {
            str(key): _ends_of(item) if key == EDGES else data_of(item, depth + 1)
            for key, item in value.items()
        }
    if isinstance(value, (list, tuple, set)):
        return [data_of(item, depth + 1) for item in value]
    if isinstance(value, np.ndarray):
        return value.tolist()
    return value.item() if isinstance(value, np.generic) else value


def _ends_of(edges: Any) -> Any:
    """Which edges there are, without the interfaces on them."""
    if not isinstance(edges, dict):
        return data_of(edges)
    return {
        str(one): dict.fromkeys(map(str, others)) if isinstance(others, dict) else data_of(others)
        for one, others in edges.items()
    }


def inner(value: Any) -> dict[str, Any]:
    """The data of a COMPAS object, with or without its wrapping."""
    if not isinstance(value, dict):
        raise FormatError("not a COMPAS assembly: an object is missing in it")
    for key in ("data", "value"):
        if key in value and ("dtype" in value or "datatype" in value):
            return inner(value[key])
    return value


def matrix_of(transformation: Any) -> NDArray[np.float64]:
    """The 4 x 4 matrix of a transformation; that of none at all is the identity."""
    if transformation is None:
        return np.eye(4)
    rows = inner(transformation).get("matrix")
    try:
        matrix = np.array(
            [[finite(x, "a transformation") for x in row] for row in rows or ()], dtype=float
        )
    except TypeError:
        matrix = np.zeros(0)
    if matrix.shape != (4, 4) or not np.allclose(matrix[3], [0, 0, 0, 1]):
        raise FormatError("a transformation must be a matrix of 4 x 4 numbers of a rigid placement")
    return matrix
