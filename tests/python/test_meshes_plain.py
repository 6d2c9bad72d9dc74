"""Meshes that are convex as they stand are taken as they are, and no others."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from drystone.imports.compas_data import data_of
from drystone.meshes import part
from drystone.meshes.part import part_from, part_of
from drystone.meshes.plain import plain_volume
from drystone.meshes.reading import Triangles

Mesh = tuple[NDArray[np.float64], NDArray[np.int64]]


def hull(points: NDArray[np.float64]) -> Mesh:
    mesh = trimesh.convex.convex_hull(points)
    return np.array(mesh.vertices), np.array(mesh.faces)


def brick(skew: float = 0.0) -> Mesh:
    """Faces of four corners, as voussoirs have them."""
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 0.4) for z in (0, 0.3)], dtype=float)
    corners[:, 0] += skew * corners[:, 2]
    return hull(corners)


def turned(mesh: Mesh, seed: int) -> Mesh:
    rng = np.random.default_rng(seed)
    turn = trimesh.transformations.random_rotation_matrix(rng.random(3))[:3, :3]
    return mesh[0] @ turn.T + rng.uniform(-3, 3, size=3), mesh[1]


def prism(corners: int) -> Mesh:
    angles = 2 * np.pi * np.arange(corners) / corners
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return hull(np.concatenate([np.c_[ring, np.zeros(corners)], np.c_[ring, np.ones(corners)]]))


PLAIN = [brick(), brick(0.3), prism(3), prism(5), prism(8), hull(np.eye(4)[:, :3])]


@pytest.mark.parametrize("number", range(len(PLAIN)))
def test_what_is_convex_is_what_all_the_steps_leave_it(number: int) -> None:
    for seed in range(5):
        vertices, triangles = turned(PLAIN[number], seed)
        volume = plain_volume(vertices, triangles)
        assert volume == pytest.approx(ConvexHull(vertices).volume, rel=1e-13)
        found = part_of("it", vertices, triangles)
        assert not found.messages
        assert found.volume == pytest.approx(volume, rel=1e-13)
        (piece,) = found.pieces
        apart = np.linalg.norm(piece[:, None] - vertices, axis=2).min(axis=0)
        assert len(piece) == len(vertices)
        assert apart.max() < 1e-12


def test_nothing_else_is_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: Any, **__: Any) -> None:
        raise AssertionError("all the steps, for a mesh that needs none")

    monkeypatch.setattr(part, "part_of", fail)
    monkeypatch.setattr(part, "assumed", fail)
    vertices, triangles = turned(brick(0.2), 0)
    read = Triangles("brick", vertices, triangles, repeats=False)
    found = part_from(read, scale=2.0)
    assert (found.pieces[0] == 2 * vertices).all()
    with pytest.raises(AssertionError, match="all the steps"):
        part_from(read, surface=True)
    with pytest.raises(part.MeshError, match="tolerance"):
        part_from(read, tolerance=-1.0)


def spoilt() -> dict[str, Mesh]:
    vertices, triangles = brick()
    bent, far = vertices.copy(), vertices.copy()
    bent[0] -= 1e-9
    far[0] += (0.5, 0.2, 0.15)  # beyond the middle
    return {
        "inside out": (vertices, triangles[:, ::-1]),
        "one face turned": (vertices, np.concatenate([triangles[:1, ::-1], triangles[1:]])),
        "open": (vertices, triangles[1:]),
        "a face twice": (vertices, np.concatenate([triangles[:1], triangles[:-1]])),
        "a vertex that no face has": (np.concatenate([vertices, [[9, 9, 9]]]), triangles),
        "faces not plane": (bent, triangles),
        "hollow": (far, triangles),
        "flat": (vertices * (1, 1, 0), triangles),
        "no number": (np.where(vertices == 1, np.nan, vertices), triangles),
        "a vertex that is not there": (vertices, triangles + 1),
        "thin": (vertices * (1, 1, 1e-3), triangles),
        "a vertex on an edge": on_an_edge(),
        "two of them": (
            np.concatenate([vertices, vertices + 5]),
            np.concatenate([triangles, triangles + 8]),
        ),
    }


def on_an_edge() -> Mesh:
    """A tetrahedron with a vertex in the middle of an edge."""
    vertices = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0.5, 0, 0)], dtype=float)
    faces = [(0, 2, 4), (4, 2, 1), (0, 4, 3), (4, 1, 3), (0, 3, 2), (1, 2, 3)]
    return vertices, np.array(faces)


@pytest.mark.parametrize("fault", spoilt())
def test_what_has_a_fault_is_left_to_the_steps(fault: str) -> None:
    assert plain_volume(*spoilt()[fault]) is None


def test_interfaces_on_edges_are_not_read() -> None:
    """They are most of what a COMPAS model with contacts holds."""

    class Live:
        __dtype__ = "contact"

        @property
        def __data__(self) -> None:
            raise AssertionError("read for nothing")

    data = data_of({"edge": {1: {2: {"contacts": [Live()]}, 3: {}}}, "node": {1: [True, 2.5]}})
    assert data == {"edge": {"1": {"2": None, "3": None}}, "node": {"1": [True, 2.5]}}
