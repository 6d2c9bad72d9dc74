"""Solids as a draughtsman sees them: parallel rays, so that a picture keeps one scale of metres.

A solid becomes the visible faces of its pieces, projected and shaded, in an order in which nearer
ones can be painted over farther ones. Two convex pieces that do not overlap have a plane between
them, and the one on the eye's side of it is the nearer. A surface is drawn in patches, of which
most have such a plane between them too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from drystone.pictures.outline import outline
from drystone.pictures.patches import patches
from drystone.scene import Solid

Points = NDArray[np.float64]

ASIDE, TILT = 0.55, 0.38
"""Radians: how far the eye is turned from the broad side, and raised."""
LIGHT = (-0.45, 0.75, 0.48)
"""Where the light comes from, in the picture's right, up and towards the eye."""
TOUCHING = 1e-6
"""Pieces that overlap less than this share of their size have a plane between them."""
FIXED_REACH = 0.12
"""How far beyond the movable bodies a fixed one is drawn, in their own size."""


@dataclass(frozen=True, slots=True)
class View:
    """The picture's right, up and the way back to the eye, as the rows of a rotation."""

    axes: Points

    @classmethod
    def of(cls, bodies: Sequence[Solid], gravity: Sequence[float]) -> View:
        """From beside the broad side, a little from above; up is against gravity."""
        length = float(np.linalg.norm(gravity))
        up = -np.asarray(gravity) / length if length > 0 else np.array([0.0, 0.0, 1.0])
        level = np.eye(3)[0 if abs(up[0]) < 0.9 else 1]
        east = level - (level @ up) * up
        east /= np.linalg.norm(east)
        north = np.cross(up, east)
        corners = np.concatenate(
            [body.vertices for body in movable_of(bodies)] or [np.zeros((1, 3))]
        )
        wide, deep = np.ptp(corners @ east), np.ptp(corners @ north)
        turn = ASIDE - np.pi / 2 if wide >= deep else -ASIDE
        back = np.cos(TILT) * (np.cos(turn) * east + np.sin(turn) * north) + np.sin(TILT) * up
        right = np.cross(up, back) / np.linalg.norm(np.cross(up, back))
        return cls(np.array([right, np.cross(back, right), back]))

    def flat(self, vectors: Points) -> Points:
        """(n, 2): points or vectors (n, 3) on the picture."""
        seen: Points = np.asarray(vectors, dtype=np.float64).reshape(-1, 3) @ self.axes[:2].T
        return seen

    def shaded(self, colour: str, normal: Points) -> tuple[float, ...]:
        """The colour of a face with this outward normal: 0.7 of it where no light falls."""
        light = np.asarray(LIGHT) / np.linalg.norm(LIGHT)
        share = 0.7 + 0.36 * max(float(self.axes @ normal @ light), 0.0)
        return tuple(min(share * part, 1.0) for part in to_rgb(colour))


@dataclass(frozen=True, slots=True)
class Shadow:
    """A solid's outline on the picture, which canvas and labels treat as a body of the plane."""

    name: str
    fixed: bool
    centroid: tuple[float, float]
    vertices: Points


@dataclass(frozen=True, slots=True)
class Piece:
    """A convex piece in the world, or a patch of a surface."""

    body: int
    corners: Points
    faces: Sequence[Sequence[int]]
    normals: Points
    """(faces, 3), outward, of length 1."""
    sharp: NDArray[np.bool_] | None = None
    """(faces, 3) of a patch: which sides of each triangle are edges of the body."""

    def visible(self, view: View) -> list[int]:
        """The faces that are turned to the eye."""
        return [int(k) for k in np.flatnonzero(self.normals @ view.axes[2] > 1e-9)]

    def flat_face(self, face: int, view: View) -> Points:
        """(k, 2): corners of a face on the picture."""
        return view.flat(self.corners[list(self.faces[face])])

    def offsets(self) -> Points:
        """(faces,): normal · x of each face."""
        firsts = self.corners[[face[0] for face in self.faces]]
        out: Points = np.sum(self.normals * firsts, axis=1)
        return out


def rotation(orientation: Sequence[float]) -> Points:
    """(3, 3) of a unit quaternion w, x, y, z."""
    w, x, y, z = orientation
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turned: Points = np.eye(3) + 2 * w * cross + 2 * cross @ cross
    return turned


def placed(body: Solid, position: Sequence[float], orientation: Sequence[float]) -> Solid:
    """The body elsewhere."""
    shapes = body.pieces if body.surface is None else [body.surface]
    own = np.concatenate([shape.vertices for shape in shapes])
    x, y, z = position
    w, i, j, k = orientation
    return replace(
        body,
        center_of_mass=(x, y, z),
        orientation=(w, i, j, k),
        vertices=own @ rotation(orientation).T + np.asarray(position),
    )


def movable_of(bodies: Sequence[Solid]) -> Sequence[Solid]:
    """The movable bodies, or all if none is."""
    return [body for body in bodies if not body.fixed] or bodies


def box_of(bodies: Sequence[Solid]) -> tuple[Points, Points]:
    """The corners of the box around the movable bodies."""
    corners = np.concatenate([body.vertices for body in movable_of(bodies)] or [np.zeros((1, 3))])
    return corners.min(axis=0), corners.max(axis=0)


def pieces_of(bodies: Sequence[Solid], box: tuple[Points, Points]) -> list[Piece]:
    """The pieces of all bodies; of fixed ones only what is in the box or a little beside it."""
    low, high = box
    reach = FIXED_REACH * float(np.max(high - low))
    low, high = low - reach, high + reach
    found = []
    for index, body in enumerate(bodies):
        turned = rotation(body.orientation)
        if body.surface is not None:
            corners = body.surface.vertices @ turned.T + np.asarray(body.center_of_mass)
            if body.fixed:
                corners = np.clip(corners, low, high)
            found += [Piece(index, *patch) for patch in patches(corners, body.surface.triangles)]
            continue
        for piece in body.pieces:
            corners = piece.vertices @ turned.T + np.asarray(body.center_of_mass)
            if body.fixed:
                corners = np.clip(corners, low, high)
            found.append(Piece(index, corners, piece.faces, _normals(corners, piece.faces)))
    return found


def shadows(bodies: Sequence[Solid], pieces: Sequence[Piece], view: View) -> list[Shadow]:
    """The outlines of the bodies on the picture, in their order."""
    found = []
    for index, body in enumerate(bodies):
        points = view.flat(np.concatenate([p.corners for p in pieces if p.body == index]))
        middle = points.mean(axis=0)
        hull = outline(points)
        found.append(Shadow(body.name, body.fixed, (float(middle[0]), float(middle[1])), hull))
    return found


def far_to_near(pieces: Sequence[Piece], view: View) -> list[Piece]:
    """An order in which every piece comes after those it hides; by depth where there is none."""
    nearer = _nearer(pieces, view)
    depth = [float(piece.corners.mean(axis=0) @ view.axes[2]) for piece in pieces]
    waiting = [0] * len(pieces)
    for ahead in nearer:
        for piece in ahead:
            waiting[piece] += 1
    left = sorted(range(len(pieces)), key=depth.__getitem__)
    order = []
    while left:
        # Three bodies can hide each other in a ring: then the farthest goes first.
        chosen = next((piece for piece in left if waiting[piece] == 0), left[0])
        left.remove(chosen)
        order.append(pieces[chosen])
        for piece in nearer[chosen]:
            waiting[piece] -= 1
    return order


def _nearer(pieces: Sequence[Piece], view: View) -> list[list[int]]:
    """For each piece those that are in front of it and overlap it on the picture."""
    nearer: list[list[int]] = [[] for _ in pieces]
    flat = [view.flat(piece.corners) for piece in pieces]
    depth = [float(piece.corners.mean(axis=0) @ view.axes[2]) for piece in pieces]
    low = np.array([points.min(axis=0) for points in flat]).reshape(-1, 2)
    high = np.array([points.max(axis=0) for points in flat]).reshape(-1, 2)
    for a in range(len(pieces)):
        meet = np.all((low[a] < high[a + 1 :]) & (low[a + 1 :] < high[a]), axis=1)
        for b in (np.flatnonzero(meet) + a + 1).tolist():
            side = _side(pieces[a], pieces[b], view) or -_side(pieces[b], pieces[a], view)
            if side == 0:
                side = 1 if depth[b] > depth[a] else -1
            nearer[a if side > 0 else b].append(b if side > 0 else a)
    return nearer


def _side(a: Piece, b: Piece, view: View) -> int:
    """1 if a face of `a` has `b` before it and towards the eye, -1 if away, 0 if there is none."""
    size = float(np.max(np.ptp(a.corners, axis=0)) + np.max(np.ptp(b.corners, axis=0)))
    gaps = np.min(b.corners @ a.normals.T, axis=0) - a.offsets()
    # Of a convex piece all is behind each face, of a patch perhaps not.
    behind = np.max(a.corners @ a.normals.T, axis=0) - a.offsets() <= TOUCHING * size
    apart = (gaps >= -TOUCHING * size) & behind
    if not np.any(apart):
        return 0
    towards = a.normals @ view.axes[2]
    # Of several such planes the one with the widest gap: rounding cannot turn it round.
    face = int(np.argmax(np.where(apart & (np.abs(towards) > 1e-9), gaps, -np.inf)))
    return int(np.sign(towards[face])) if apart[face] else 0


def _normals(corners: Points, faces: Sequence[Sequence[int]]) -> Points:
    """Newell's normals; zero for a face that has lost its area."""
    found = np.zeros((len(faces), 3))
    for k, face in enumerate(faces):
        loop = corners[list(face)] - corners[face[0]]
        normal = np.sum(np.cross(loop, np.roll(loop, -1, axis=0)), axis=0)
        length = float(np.linalg.norm(normal))
        found[k] = normal / length if length > 0 else normal
    return found
