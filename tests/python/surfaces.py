"""Surfaces with known answers, made by hand: no library cuts or joins them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

import drystone as ds

Points = NDArray[np.float64]
Mesh = tuple[Points, NDArray[np.int64]]
"""Vertices (k, 3) and triangles (n, 3), counter-clockwise from outside."""

BOX_FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def box(size: Sequence[float], at: Sequence[float] = (0, 0, 0)) -> Mesh:
    """A cuboid about a point."""
    signs = np.array([[k & 1, k >> 1 & 1, k >> 2] for k in range(8)]) - 0.5
    triangles = [t for a, b, c, d in BOX_FACES for t in ((a, b, c), (a, c, d))]
    return signs * np.asarray(size) + np.asarray(at), np.array(triangles)


def prism(outline: Sequence[Sequence[float]], low: float, high: float) -> Mesh:
    """Upright between two heights, over a polygon (counter-clockwise) that all of its corners are
    seen in from the origin."""
    flat = np.asarray(outline, dtype=float)
    n = len(flat)
    bottom, top = np.c_[flat, np.full(n, low)], np.c_[flat, np.full(n, high)]
    middles = np.array([[0, 0, low], [0, 0, high]])
    triangles = []
    for k in range(n):
        j = (k + 1) % n
        triangles += [(k, j, n + j), (k, n + j, n + k), (j, k, 2 * n), (n + k, n + j, 2 * n + 1)]
    return np.concatenate([bottom, top, middles]), np.array(triangles)


def tube(outer: Sequence[Sequence[float]], inner: Sequence[Sequence[float]], h: float) -> Mesh:
    """What is between two outlines of as many corners, from the height 0 to h."""
    return lathe(
        [
            np.c_[outer, np.zeros(len(outer))],
            np.c_[outer, np.full(len(outer), h)],
            np.c_[inner, np.full(len(inner), h)],
            np.c_[inner, np.zeros(len(inner))],
        ]
    )


def lathe(rings: Sequence[Points]) -> Mesh:
    """A ring of the section whose corners go around in rings of as many points each."""
    n = len(rings[0])
    triangles = []
    for i in range(len(rings)):
        j = (i + 1) % len(rings)
        for k in range(n):
            m = (k + 1) % n
            a, b, c, d = i * n + k, i * n + m, j * n + m, j * n + k
            triangles += [(a, b, c), (a, c, d)]
    return np.concatenate(rings), np.array(triangles)


def circle(radius: float, sections: int = 48, turn: float = 0.0) -> Points:
    """Corners on a circle, counter-clockwise."""
    angles = turn + 2 * np.pi * np.arange(sections) / sections
    return radius * np.c_[np.cos(angles), np.sin(angles)]


def ring(radius: float, z: float, sections: int = 48) -> Points:
    """The same at a height."""
    return np.c_[circle(radius, sections), np.full(sections, z)]


def revolved(profile: Sequence[tuple[float, float]], sections: int = 48) -> Mesh:
    """A solid of revolution about z: a profile (radius, height) from the bottom of the axis up to
    its top, both ends with the radius 0."""
    rings = [ring(r, z, sections) for r, z in profile[1:-1]]
    poles = np.array([[0, 0, profile[0][1]], [0, 0, profile[-1][1]]])
    triangles = []
    for i in range(len(rings) - 1):
        for k in range(sections):
            m = (k + 1) % sections
            a, b = i * sections + k, i * sections + m
            triangles += [(a, b, b + sections), (a, b + sections, a + sections)]
    low, high, last = len(rings) * sections, len(rings) * sections + 1, (len(rings) - 1) * sections
    for k in range(sections):
        m = (k + 1) % sections
        triangles += [(m, k, low), (last + k, last + m, high)]
    return np.concatenate([*rings, poles]), np.array(triangles)


def ball(
    radius: float, at: Sequence[float] = (0, 0, 0), rows: int = 12, sections: int = 24
) -> Mesh:
    """A sphere of latitudes and longitudes."""
    angles = np.pi * (np.arange(rows + 1) / rows - 0.5)
    profile = [(radius * np.cos(a), radius * np.sin(a)) for a in angles]
    vertices, triangles = revolved(profile, sections)
    return vertices + np.asarray(at), triangles


def turned_out(mesh: Mesh) -> Mesh:
    """The same surface facing the other way: the wall of a hollow."""
    return mesh[0], mesh[1][:, ::-1]


def together(*meshes: Mesh) -> Mesh:
    """Several shells as one surface."""
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    return (
        np.concatenate([vertices for vertices, _ in meshes]),
        np.concatenate([t + start for (_, t), start in zip(meshes, starts, strict=False)]),
    )


def moved(mesh: Mesh, by: Sequence[float]) -> Mesh:
    """The same elsewhere."""
    return mesh[0] + np.asarray(by), mesh[1]


def cells(places: Sequence[tuple[int, int, int]]) -> Mesh:
    """Unit cubes at whole places as one surface, without the walls between them."""
    filled = set(places)
    points: dict[tuple[int, int, int], int] = {}
    triangles = []
    corners = [(k & 1, k >> 1 & 1, k >> 2) for k in range(8)]
    beyond = [(0, 0, -1), (0, 0, 1), (0, -1, 0), (0, 1, 0), (-1, 0, 0), (1, 0, 0)]
    for x, y, z in places:
        for face, (i, j, k) in zip(BOX_FACES, beyond, strict=True):
            if (x + i, y + j, z + k) in filled:
                continue
            at = [(x + corners[c][0], y + corners[c][1], z + corners[c][2]) for c in face]
            a, b, c, d = (points.setdefault(p, len(points)) for p in at)
            triangles += [(a, b, c), (a, c, d)]
    return np.array(list(points), dtype=float), np.array(triangles)


def add(scene: ds.Scene, mesh: Mesh, name: str, **options: object) -> str:
    """A body within a surface."""
    return scene.add_surface(*mesh, name, **options)  # type: ignore[arg-type]


def wrenches(scene: ds.Scene, pair: tuple[str, str]) -> Points:
    """Columns (6, k): unit forces along edges of the friction cones of a pair's contacts, and their
    moments about the middle of the contacts, in the size of these."""
    contacts = [c for c in scene.contacts if (c.a, c.b) == pair]
    points = np.array([c.point for c in contacts])
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    size = float(np.linalg.norm(np.ptp(points, axis=0))) or 1.0
    columns = []
    for contact, point in zip(contacts, points, strict=True):
        n = np.array(contact.normal)
        u = np.cross(n, np.eye(3)[np.argmin(abs(n))])
        u /= np.linalg.norm(u)
        v = np.cross(n, u)
        for angle in 2 * np.pi * np.arange(8) / 8:
            force = n + contact.friction * (np.cos(angle) * u + np.sin(angle) * v)
            force /= np.linalg.norm(force)
            columns.append(np.concatenate([force, np.cross(point - middle, force) / size]))
    return np.array(columns).T
