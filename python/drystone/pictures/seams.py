"""Where an edge of a piece is none: along another piece of the body that goes on in its plane."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from drystone.pictures.axonometry import Piece, Points

NEAR = 1e-5
"""Shares of the body's size, and of a unit normal, by which planes and lines may differ."""


def edges_seen(piece: Piece, face: int, others: Sequence[Piece]) -> Iterator[Points]:
    """(2, 3): the parts of a face's sides that are edges of the body, not seams.

    `others` are the other pieces of the same body. A side between two faces of `piece` is a seam
    where either of them goes on in a face of another piece.
    """
    near = NEAR * float(np.max(np.ptp(piece.corners, axis=0)))
    loop = piece.faces[face]
    for a, b in zip(loop, (*loop[1:], loop[0]), strict=True):
        beside = [k for k, other in enumerate(piece.faces) if {a, b} <= set(other)]
        start, end = piece.corners[a], piece.corners[b]
        seams = [
            part
            for other in others
            for k in range(len(other.faces))
            if any(_in_one_plane(piece, one, other, k, near) for one in beside)
            if (part := _along(other, k, start, end, near)) is not None
        ]
        for t0, t1 in _without(seams):
            yield np.array([start + t0 * (end - start), start + t1 * (end - start)])


def _in_one_plane(a: Piece, i: int, b: Piece, k: int, near: float) -> bool:
    """Whether two faces look the same way in one plane."""
    if np.linalg.norm(a.normals[i] - b.normals[k]) > NEAR:
        return False
    apart = b.corners[b.faces[k][0]] - a.corners[a.faces[i][0]]
    return abs(float(a.normals[i] @ apart)) < near


def _along(
    piece: Piece, face: int, start: Points, end: Points, near: float
) -> tuple[float, float] | None:
    """The part of the way from start to end, in the face's plane, that lies on the face."""
    loop = piece.corners[list(piece.faces[face])]
    inward = np.cross(piece.normals[face], np.roll(loop, -1, axis=0) - loop)
    inward /= np.linalg.norm(inward, axis=1)[:, None]
    t0, t1 = 0.0, 1.0
    for way, corner in zip(inward, loop, strict=True):
        first, last = float(way @ (start - corner)) + near, float(way @ (end - corner)) + near
        if first < 0 and last < 0:
            return None
        if first < 0:
            t0 = max(t0, first / (first - last))
        elif last < 0:
            t1 = min(t1, first / (first - last))
    return (t0, t1) if (t1 - t0) * np.linalg.norm(end - start) > 4 * near else None


def _without(parts: Sequence[tuple[float, float]]) -> Iterator[tuple[float, float]]:
    """What is left of [0, 1] without some parts."""
    at = 0.0
    for t0, t1 in sorted(parts):
        if t0 > at:
            yield at, t0
        at = max(at, t1)
    if at < 1.0:
        yield at, 1.0
