"""Sparse matrices on their way to the core. SciPy is needed only where its own are given."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from drystone.common.arrays import floats

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray
    from scipy import sparse

    from drystone._core import DrystoneError

    Matrix: TypeAlias = ArrayLike | sparse.sparray | sparse.spmatrix
    """What a matrix may be given as: rows of numbers, or one of SciPy's sparse ones."""

Arrays = tuple["NDArray[np.int64]", "NDArray[np.int64]", "NDArray[np.float64]"]


@dataclass(frozen=True, slots=True, eq=False)
class Compressed:
    """A matrix by its columns, or by its rows: the entries of line k are those from `starts[k]`
    to `starts[k + 1]`, in order and without repetition."""

    shape: tuple[int, int]
    """Rows and columns."""
    starts: NDArray[np.int64]
    places: NDArray[np.int64]
    """Of each entry the row within its column, or the column within its row."""
    values: NDArray[np.float64]

    @property
    def arrays(self) -> Arrays:
        """What the core takes."""
        return self.starts, self.places, self.values

    @property
    def lines(self) -> NDArray[np.int64]:
        """The line of each entry."""
        return np.repeat(np.arange(len(self.starts) - 1), np.diff(self.starts))


def is_sparse(matrix: Any) -> bool:
    """Whether it is one of SciPy's, which is loaded then."""
    sparse = sys.modules.get("scipy.sparse")
    return sparse is not None and bool(sparse.issparse(matrix))


def by_columns(
    matrix: Any, what: str, error: type[DrystoneError], square: bool = False
) -> Compressed:
    """A matrix, dense or of SciPy, column by column; an `error` that names `what` if it is none,
    or if it is to be `square` and is not."""
    made = _by_columns(matrix, what, error)
    if square and made.shape[0] != made.shape[1]:
        raise error(f"{what} must be a square matrix, not of shape {made.shape}")
    return made


def _by_columns(matrix: Any, what: str, error: type[DrystoneError]) -> Compressed:
    if not is_sparse(matrix):
        dense = _dense(matrix, what, error)
        columns, rows = np.nonzero(dense.T)
        return _counted(dense.shape, dense.shape[1], columns, rows, dense[rows, columns])
    return _of_scipy(_real(matrix, what, error).tocsc(copy=True))


def by_rows(matrix: Any, what: str, error: type[DrystoneError]) -> Compressed:
    """The same row by row."""
    if not is_sparse(matrix):
        dense = _dense(matrix, what, error)
        rows, columns = np.nonzero(dense)
        return _counted(dense.shape, dense.shape[0], rows, columns, dense[rows, columns])
    return _of_scipy(_real(matrix, what, error).tocsr(copy=True))


def of_diagonal_blocks(blocks: NDArray[np.float64]) -> Compressed:
    """The matrix with square blocks (m, b, b) on its diagonal, column by column."""
    m, b, _ = blocks.shape
    block, column, row = np.nonzero(blocks.transpose(0, 2, 1))
    values = blocks[block, row, column]
    return _counted((m * b, m * b), m * b, block * b + column, block * b + row, values)


def times(matrix: Compressed, vector: NDArray[np.float64]) -> NDArray[np.float64]:
    """The product of a matrix by rows with a vector."""
    terms = matrix.values * vector[matrix.places]
    product: NDArray[np.float64] = np.zeros(matrix.shape[0])
    np.add.at(product, matrix.lines, terms)
    return product


def _dense(matrix: Any, what: str, error: type[DrystoneError]) -> NDArray[np.float64]:
    dense = floats(matrix, what, error)
    if dense.ndim != 2:
        raise error(f"{what} must be a matrix of rows and columns, not of shape {dense.shape}")
    return dense


def _real(matrix: Any, what: str, error: type[DrystoneError]) -> Any:
    if matrix.ndim != 2:
        raise error(f"{what} must be a matrix, not of shape {matrix.shape}")
    if matrix.dtype.kind not in "fiub":
        raise error(f"{what} must hold real numbers, not {matrix.dtype}")
    return matrix.astype(np.float64)


def _of_scipy(matrix: Any) -> Compressed:
    matrix.sum_duplicates()
    starts, places = matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64)
    return Compressed(matrix.shape, starts, places, matrix.data)


def _counted(
    shape: tuple[int, ...],
    count: int,
    lines: NDArray[np.int64],
    places: NDArray[np.int64],
    values: NDArray[np.float64],
) -> Compressed:
    """From entries in the order of their `count` lines."""
    starts = np.concatenate(([0], np.cumsum(np.bincount(lines, minlength=count))))
    rows, columns = shape
    return Compressed((rows, columns), starts.astype(np.int64), places.astype(np.int64), values)
