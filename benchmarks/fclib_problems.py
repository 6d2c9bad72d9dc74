"""Contact problems in the files of Siconos and FCLIB.

A *local* problem is W (d k, d k) and q: u = W p + q. A *global* one is M, H, q and b, with
M v = H p + q and u = H' v + b. Text files are what Siconos' `NM_write_in_file` writes, HDF5 files
(h5py is needed) what FCLIB does.

Acary and others, FCLIB: a collection of discrete 3D frictional contact problems, 2014.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu, spsolve_triangular

Floats = NDArray[np.float64]

DENSE, SPARSE_BLOCK = 0, 1
"""Kinds of matrices; beyond these, CSparse's."""

SHIFT = 1e-13
"""Added to the diagonal of W, of its largest entry: many are semidefinite."""
HEAVY = 1e30
"""kg."""


@dataclass(frozen=True, slots=True)
class FrictionProblem:
    """What `drystone.contact.solve` takes; and W and q, what a Gauss-Seidel method does."""

    mass: sparse.csc_matrix
    jacobian: sparse.csr_matrix
    friction: Floats
    free: Floats
    dimension: int
    delassus: sparse.csc_matrix
    """W."""
    q: Floats
    """u without impulses."""
    contains_mass: bool
    """Whether it is a global problem."""


def read(path: Path) -> FrictionProblem:
    """Read one.

    Raises ValueError for what is no such problem, and ModuleNotFoundError for an HDF5 file without
    h5py.
    """
    with path.open("rb") as file:
        hdf5 = file.read(8) == b"\x89HDF\r\n\x1a\n"
    return _of_hdf5(path) if hdf5 else _of_text(path.read_text())


def _local(w: Any, q: Floats, friction: Floats, dimension: int) -> FrictionProblem:
    """With unit masses, and a sparse root of W for J."""
    w = sparse.csc_matrix(0.5 * (w + w.T))
    factor = _root(w)
    root = factor.L @ sparse.diags(np.sqrt(factor.U.diagonal()))
    jacobian = sparse.csr_matrix(root)[factor.perm_r]
    order = np.argsort(factor.perm_r)
    free = spsolve_triangular(sparse.csr_matrix(root), q[order])
    mass = sparse.identity(len(q), format="csc")
    return FrictionProblem(mass, jacobian, friction, free, dimension, w, q, contains_mass=False)


def _root(w: Any) -> Any:
    """L U of W and a multiple of the identity with which that is L D L', D above zero. Numbers of
    seven digits leave some W indefinite by as much."""
    shift = SHIFT * abs(w).max()
    while True:
        shifted = sparse.csc_matrix(w + shift * sparse.identity(w.shape[0]))
        options = {"SymmetricMode": True, "Equil": False}
        factor = splu(shifted, "MMD_AT_PLUS_A", diag_pivot_thresh=0, options=options)
        if (factor.perm_r == factor.perm_c).all() and factor.U.diagonal().min() > 0:
            return factor
        shift *= 10


def _global(
    mass: Any, h: Any, q: Floats, b: Floats, friction: Floats, dimension: int
) -> FrictionProblem:
    mass, jacobian = sparse.csc_matrix(mass), sparse.csr_matrix(h.T)
    factor = splu(mass)
    w, free = sparse.csc_matrix(jacobian @ factor.solve(h.toarray())), factor.solve(q)
    if b.any():
        # Bodies too heavy to be moved give J v the rest.
        mass = sparse.block_diag([mass, HEAVY * sparse.identity(len(b))], format="csc")
        jacobian = sparse.hstack([jacobian, sparse.identity(len(b))], format="csr")
        free = np.concatenate([free, b])
    return FrictionProblem(
        mass, jacobian, friction, free, dimension, w, jacobian @ free, contains_mass=True
    )


def _of_hdf5(path: Path) -> FrictionProblem:
    import h5py

    def matrix(group: Any) -> Any:
        rows, columns, kind = (int(np.ravel(group[name][()])[0]) for name in ("m", "n", "nz"))
        x, i, p, shape = group["x"][()], group["i"][()], group["p"][()], (rows, columns)
        if kind >= 0:  # Triplets.
            return sparse.coo_matrix((x[:kind], (i[:kind], p[:kind])), shape).tocsc()
        along = sparse.csc_matrix if kind == -1 else sparse.csr_matrix
        return along((x[: p[-1]], i[: p[-1]], p), shape)

    with h5py.File(path) as file:
        (name,) = (name for name in file if name.startswith("fclib_"))
        group = file[name]
        vectors, dimension = group["vectors"], int(np.ravel(group["spacedim"][()])[0])
        friction = vectors["mu"][()]
        if name == "fclib_local":
            return _local(matrix(group["W"]), vectors["q"][()], friction, dimension)
        m, h = matrix(group["M"]), matrix(group["H"])
        # FCLIB has M v = H p + f.
        return _global(m, h, vectors["f"][()], vectors["w"][()], friction, dimension)


def _of_text(text: str) -> FrictionProblem:
    words = _Words(text)
    dimension, contacts = words.whole(), words.whole()
    first = words.matrix()
    if not words.matrix_follows(first.shape[0]):
        q = words.numbers(dimension * contacts)
        return _local(first, q, words.numbers(contacts), dimension)
    h = words.matrix()
    q, b = words.numbers(first.shape[0]), words.numbers(h.shape[1])
    return _global(first, h, q, b, words.numbers(h.shape[1] // dimension), dimension)


class _Words:
    """A text file word by word."""

    def __init__(self, text: str) -> None:
        self.words = text.split()
        self.at = 0

    def matrix_follows(self, rows: int) -> bool:
        """Whether what follows is the kind and the size of a matrix, and no vector."""
        return self.words[self.at] in {"0", "1", "2"} and self.words[self.at + 1] == str(rows)

    def word(self) -> str:
        if self.at == len(self.words):
            raise ValueError("this ends in the middle of a problem")
        self.at += 1
        return self.words[self.at - 1]

    def whole(self) -> int:
        return int(self.word())

    def numbers(self, count: int) -> Floats:
        found = self.words[self.at : self.at + count]
        if len(found) < count:
            raise ValueError("this ends in the middle of a vector")
        self.at += count
        return np.array(found, dtype=float)

    def wholes(self, count: int) -> list[int]:
        return [self.whole() for _ in range(count)]

    def matrix(self) -> Any:
        kind, *shape = self.wholes(3)
        if kind == DENSE:
            rows, columns = self.wholes(2)
            dense = self.numbers(rows * columns).reshape((columns, rows)).T
            return sparse.csc_matrix(dense)
        return self._blocks(shape) if kind == SPARSE_BLOCK else self._csparse(shape)

    def _blocks(self, shape: list[int]) -> Any:
        _, high, wide = self.wholes(3)
        row_ends, column_ends = [0, *self.wholes(high)], [0, *self.wholes(wide)]
        starts, places = self.wholes(2)
        first, column_of = self.wholes(starts), self.wholes(places)
        found = np.zeros(shape)
        for row in range(starts - 1):
            for column in column_of[first[row] : first[row + 1]]:
                self.word()  # The number of the block.
                rows = slice(*row_ends[row : row + 2])
                columns = slice(*column_ends[column : column + 2])
                part = found[rows, columns]
                part[:] = self.numbers(part.size).reshape(part.shape, order="F")
        return sparse.csc_matrix(found)

    def _csparse(self, shape: list[int]) -> Any:
        """As CSparse's cs_print writes it: "i j : x", or "col j : locations a to b" and "i : x"."""
        while self.word() != "nnz:":
            pass
        count = int(self.word().rstrip(","))
        if self.words[self.at] == "1-norm:":
            self.at += 2
        rows, columns, values = [], [], []
        column = 0
        while len(values) < count:
            word = self.word()
            if word == "col":
                column = self.whole()
                self.at += 5  # : locations a to b
            else:
                rows.append(int(word))
                if self.words[self.at] != ":":
                    column = self.whole()
                self.at += 1
                columns.append(column)
                values.append(float(self.word()))
        return sparse.coo_matrix((values, (rows, columns)), shape).tocsc()
