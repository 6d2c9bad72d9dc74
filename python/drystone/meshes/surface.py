"""Closed surfaces of triangles: what is wrong with one, and what can be put right without guessing.

Every repair says what it did. What would need a guess, such as closing a hole, is a MeshError.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from drystone.meshes.convex import winding_number
from drystone.meshes.errors import MeshError

if TYPE_CHECKING:
    from numpy.typing import NDArray

MOST_SHELLS = 256
"""More closed shells than this in one mesh are no single block."""


@dataclass(slots=True, eq=False)
class Surface:
    """Triangles (n, 3) over vertices (k, 3) in metres, and what was done to them."""

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    messages: list[str] = field(default_factory=list)

    @property
    def corners(self) -> NDArray[np.float64]:
        """The corners of the triangles, (n, 3, 3)."""
        return self.vertices[self.triangles]

    @property
    def volume(self) -> float:
        """Signed volume, cubic metres: negative if the triangles face inwards."""
        return float(signed_volumes(self.corners).sum())

    @property
    def area(self) -> float:
        """Square metres."""
        a, b, c = np.moveaxis(self.corners, 1, 0)
        return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)

    @property
    def diagonal(self) -> float:
        """Length of the bounding box's diagonal, metres."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))

    def hollows(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Of each edge at which the surface is hollow: the angle (radians) by which its faces turn,
        and how far (metres) either reaches above the other's plane."""
        count = len(self.triangles)
        halves = np.concatenate([self.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
        order = np.lexsort((halves.max(axis=1), halves.min(axis=1)))
        ends = np.sort(halves[order], axis=1)
        same = (ends[1:] == ends[:-1]).all(axis=1)
        one, two = order[:-1][same] % count, order[1:][same] % count
        a, b, c = np.moveaxis(self.corners, 1, 0)
        crosses = np.cross(b - a, c - a)
        lengths = np.linalg.norm(crosses, axis=1)
        usable = (lengths[one] > 0) & (lengths[two] > 0)
        one, two = one[usable], two[usable]
        normals = crosses / np.where(lengths > 0, lengths, 1.0)[:, None]

        def above(face: NDArray[np.int64], other: NDArray[np.int64]) -> NDArray[np.float64]:
            arms = self.corners[other] - self.corners[face][:, :1]
            heights: NDArray[np.float64] = np.einsum("nik,nk->ni", arms, normals[face]).max(axis=1)
            return heights

        heights = np.minimum(above(one, two), above(two, one))
        cosines = np.einsum("ij,ij->i", normals[one], normals[two])
        hollow = heights > 0
        return np.arccos(np.clip(cosines, -1, 1))[hollow], heights[hollow]


def repaired(vertices: NDArray[np.float64], triangles: NDArray[np.int64], quietly: bool) -> Surface:
    """A closed surface, its triangles counter-clockwise from outside; MeshError if there is none.

    `quietly` merges vertices without a message: formats like STL repeat every vertex.
    """
    if not len(triangles):
        raise MeshError("it has no faces: export it as a closed surface")
    if not np.isfinite(vertices).all():
        raise MeshError("some of its vertices are not finite numbers: export it again")
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        raise MeshError("some of its faces use vertices that are not there: export it again")
    surface = Surface(vertices, triangles)
    _merge_vertices(surface, quietly)
    _drop_useless_faces(surface)
    _check_closed(surface)
    _turn_faces_one_way(surface)
    _turn_shells_outwards(surface)
    return surface


def signed_volumes(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Volume under each triangle (n, 3, 3), seen from the middle of all of them."""
    a, b, c = np.moveaxis(corners - corners.mean(axis=(0, 1)), 1, 0)
    volumes: NDArray[np.float64] = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
    return volumes


def _merge_vertices(surface: Surface, quietly: bool) -> None:
    used, places = np.unique(surface.triangles, return_inverse=True)
    merged, where = np.unique(surface.vertices[used] + 0.0, axis=0, return_inverse=True)
    surface.vertices = merged
    surface.triangles = where.reshape(-1)[places.reshape(-1, 3)]
    if len(merged) < len(used) and not quietly:
        surface.messages.append(f"merged {len(used) - len(merged)} duplicate vertices")


def _drop_useless_faces(surface: Surface) -> None:
    a, b, c = surface.triangles.T
    proper = (a != b) & (b != c) & (c != a)
    if not proper.all():
        surface.messages.append(f"left out {(~proper).sum()} faces without area")
        surface.triangles = surface.triangles[proper]
    # Two faces with the same corners in the same direction are one face.
    first = surface.triangles.argmin(axis=1)
    turned = np.take_along_axis(surface.triangles, (first[:, None] + np.arange(3)) % 3, axis=1)
    _, kept = np.unique(turned, axis=0, return_index=True)
    if len(kept) < len(turned):
        surface.messages.append(f"left out {len(turned) - len(kept)} duplicate faces")
        surface.triangles = surface.triangles[np.sort(kept)]
    if not len(surface.triangles):
        raise MeshError("none of its faces has an area: export it as a closed surface")


@dataclass(frozen=True, slots=True, eq=False)
class _Edges:
    """The edges of a surface: for each, its ends (k, 2), faces, and excess of one direction."""

    ends: NDArray[np.int64]
    faces: NDArray[np.int64]
    excess: NDArray[np.int64]
    of_half_edge: NDArray[np.int64]
    forwards: NDArray[np.bool_]

    @classmethod
    def of(cls, triangles: NDArray[np.int64]) -> _Edges:
        halves = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        forwards = halves[:, 0] < halves[:, 1]
        keys = np.where(forwards[:, None], halves, halves[:, ::-1])
        size = triangles.max() + 1
        numbers, inverse = np.unique(keys[:, 0] * size + keys[:, 1], return_inverse=True)
        return cls(
            np.stack([numbers // size, numbers % size], axis=1),
            np.bincount(inverse),
            np.bincount(inverse, weights=np.where(forwards, 1, -1)).astype(np.int64),
            inverse,
            forwards,
        )


def _check_closed(surface: Surface) -> None:
    edges = _Edges.of(surface.triangles)
    odd = (edges.faces > 2) & (edges.excess != 0)
    if odd.any():
        where = _place(surface.vertices[edges.ends[odd][0]].mean(axis=0))
        raise MeshError(
            f"it is not manifold: {odd.sum()} of its edges belong to three or more faces that "
            f"enclose no solid, the first at {where}: remove inner walls and loose faces"
        )
    open_ends = edges.ends[edges.faces == 1]
    if len(open_ends):
        raise MeshError(_hole(surface.vertices, open_ends))


def _hole(vertices: NDArray[np.float64], ends: NDArray[np.int64]) -> str:
    """Where the longest of the holes along open edges is."""
    size = len(vertices)
    graph = coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(size, size))
    _, labels = connected_components(graph, directed=False)
    rims = labels[ends[:, 0]]
    lengths = np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1)
    numbers, inverse = np.unique(rims, return_inverse=True)
    rim_lengths = np.bincount(inverse, weights=lengths)
    longest = int(rim_lengths.argmax())
    middle = vertices[ends[inverse == longest]].reshape(-1, 3).mean(axis=0)
    count = f"{len(numbers)} holes, the largest" if len(numbers) > 1 else "a hole"
    return (
        f"it is not closed: {count} around {_place(middle)} with a rim of "
        f"{(inverse == longest).sum()} edges, {rim_lengths[longest]:.4g} long: close it and export "
        "it again"
    )


def _turn_faces_one_way(surface: Surface) -> None:
    """Turn faces so that neighbours run through their common edge in opposite directions."""
    edges = _Edges.of(surface.triangles)
    if not edges.excess.any():
        return
    paired = edges.faces == 2
    order = np.argsort(edges.of_half_edge, kind="stable")
    order = order[paired[edges.of_half_edge[order]]]
    count = len(surface.triangles)
    one, two = order[0::2] % count, order[1::2] % count
    # A face as it is and turned are two nodes: an edge joins the nodes that agree along it.
    clash = edges.forwards[order[0::2]] == edges.forwards[order[1::2]]
    links = np.concatenate(
        [np.stack([one, two + clash * count]), np.stack([one + count, two + ~clash * count])],
        axis=1,
    )
    graph = coo_array((np.ones(links.shape[1]), links), shape=(2 * count, 2 * count))
    _, labels = connected_components(graph, directed=False)
    as_is, turned = labels[:count], labels[count:]
    if (as_is == turned).any():
        raise MeshError("its faces cannot be given an outer side, like those of a Moebius strip")
    # Of the two ways to agree, each shell keeps the one that more of its faces have.
    votes = np.bincount(as_is, minlength=labels.max() + 1)
    flip = (votes[as_is] < votes[turned]) | ((votes[as_is] == votes[turned]) & (as_is > turned))
    surface.triangles[flip] = surface.triangles[flip][:, ::-1]
    surface.messages.append(
        f"turned {flip.sum()} faces that faced the other way than their neighbours"
    )


def _turn_shells_outwards(surface: Surface) -> None:
    """Turn shells that enclose a solid but face inwards; a hollow's shell faces inwards rightly."""
    labels, shells = _shells(surface)
    if shells > MOST_SHELLS:
        raise MeshError(f"it has {shells} separate shells: give each block a mesh of its own")
    corners = surface.corners
    weights = signed_volumes(corners)
    volumes = np.bincount(labels, weights=weights, minlength=shells).astype(np.float64)
    turned = 0
    if volumes.sum() < 0:
        surface.triangles = surface.triangles[:, ::-1]
        volumes = -volumes
        turned = shells
    for shell in range(shells):
        hollow = shells > 1 and _depth(corners, labels, volumes, shell) % 2 == 1
        if hollow and volumes[shell] > 0:
            raise MeshError(
                "one of its parts lies inside another or overlaps it: give each block a mesh of "
                "its own, or turn the inner part's faces inwards if it is a hollow"
            )
        if not hollow and volumes[shell] < 0:
            surface.triangles[labels == shell] = surface.triangles[labels == shell][:, ::-1]
            volumes[shell] *= -1
            turned += 1
    if turned:
        surface.messages.append("was inside out: turned its faces outwards")
    solid = int((volumes > 0).sum())
    if solid > 1:
        surface.messages.append(f"its {solid} separate parts are one rigid body")


def _shells(surface: Surface) -> tuple[NDArray[np.int64], int]:
    """The number of the connected shell that each triangle belongs to."""
    size = len(surface.vertices)
    a, b, c = surface.triangles.T
    graph = coo_array(
        (np.ones(2 * len(a)), (np.concatenate([a, a]), np.concatenate([b, c]))), shape=(size, size)
    )
    count, labels = connected_components(graph, directed=False)
    return labels[a], count


def _depth(
    corners: NDArray[np.float64],
    labels: NDArray[np.int64],
    volumes: NDArray[np.float64],
    shell: int,
) -> int:
    """How many other shells a shell is inside of."""
    a, b, c = np.moveaxis(corners[labels == shell], 1, 0)
    normals = np.cross(b - a, c - a) * np.sign(volumes[shell])
    areas = np.linalg.norm(normals, axis=1)
    largest = areas.argmax()
    # A point just inside of it, so that shells which it only touches do not count.
    middle = (a[largest] + b[largest] + c[largest]) / 3
    point = middle - 1e-3 * normals[largest] / np.sqrt(areas[largest])
    others = np.flatnonzero((volumes != 0) & (np.arange(len(volumes)) != shell))
    inside = [abs(winding_number(corners[labels == other], point)) > 0.5 for other in others]
    return sum(inside)


def _place(point: NDArray[np.float64]) -> str:
    return "(" + ", ".join(f"{value:.4g}" for value in point) + ")"
