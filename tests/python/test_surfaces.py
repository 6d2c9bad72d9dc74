"""Bodies within closed surfaces: measures, contacts and verdicts with known answers."""

from __future__ import annotations

import itertools
import pickle
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import nnls

import drystone as ds
from surfaces import (
    Mesh,
    add,
    ball,
    box,
    cells,
    circle,
    lathe,
    moved,
    prism,
    revolved,
    ring,
    together,
    tube,
    turned_out,
    wrenches,
)

DOWN = (0.0, 0.0, -9.81)


def scene_of(
    *bodies: tuple[str, Mesh],
    friction: float = 0.5,
    gravity: Sequence[float] = DOWN,
    tolerance: float | None = None,
) -> ds.Scene:
    """The first body is fixed."""
    scene = ds.Scene(3, gravity, friction, contact_tolerance=tolerance)
    for number, (name, mesh) in enumerate(bodies):
        add(scene, mesh, name, fixed=number == 0)
    return scene


def stands(*bodies: tuple[str, Mesh], **options: object) -> bool:
    return ds.check(scene_of(*bodies, **options)).stable  # type: ignore[arg-type]


# Measures


def test_a_hollow_box_weighs_without_its_hollow() -> None:
    """A cube of 4 without one of 2 inside of it: volume, centroid and inertia by subtraction."""
    mesh = together(box((4, 4, 4)), turned_out(box((2, 2, 2), (0.5, 0, -0.5))))
    scene = ds.Scene(dimension=3)
    add(scene, mesh, "a", density=2.0)
    body = scene.body("a")
    assert body.mass == pytest.approx(2 * (64 - 8))
    off = -8 * np.array([0.5, 0, -0.5]) / 56
    assert body.center_of_mass == pytest.approx(off)

    def about(mass: float, side: float, arm: np.ndarray) -> np.ndarray:
        own = mass * side**2 / 6 * np.eye(3)
        return own + mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))

    inertia = about(2 * 64, 4, -off) - about(2 * 8, 2, np.array([0.5, 0, -0.5]) - off)
    assert body.inertia == pytest.approx(inertia)
    assert body.surface is not None
    assert body.pieces == ()


def test_a_frame_and_a_weight_of_its_own() -> None:
    scene = ds.Scene(dimension=3)
    half = np.sqrt(0.5)
    add(
        scene,
        cells([(0, 0, 0), (1, 0, 0), (0, 1, 0)]),
        "L",
        position=(10, 0, 0),
        orientation=(half, 0, 0, half),
        mass=6.0,
        center_of_mass=(0.5, 0.5, 0.5),
    )
    body = scene.body("L")
    assert body.center_of_mass == pytest.approx((9.5, 0.5, 0.5))
    assert body.centroid == pytest.approx((10 - 5 / 6, 5 / 6, 0.5))
    assert body.mass == 6.0


# Contacts, beside those of convex pieces


def test_boxes_have_the_contacts_that_convex_ones_have() -> None:
    boxes = [("ground", box((4, 4, 1), (0, 0, -0.5))), ("a", box((1, 2, 1), (0.3, 0.1, 0.5))),
             ("b", box((0.5, 3, 0.4), (0, 0, 1.2)))]  # fmt: skip
    convex = ds.Scene(3, friction=0.5)
    for name, (vertices, _) in boxes:
        convex.add_polyhedron(vertices, name, fixed=name == "ground")

    def places(scene: ds.Scene) -> set[tuple[float, ...]]:
        return {tuple(np.round((*c.point, *c.normal), 9) + 0.0) for c in scene.contacts}

    for surfaces in itertools.product([True, False], repeat=3):
        scene = ds.Scene(3, friction=0.5)
        for is_surface, (name, mesh) in zip(surfaces, boxes, strict=True):
            if is_surface:
                add(scene, mesh, name, fixed=name == "ground")
            else:
                scene.add_polyhedron(mesh[0], name, fixed=name == "ground")
        assert places(scene) == places(convex)
        assert len(scene.contacts) == len(convex.contacts)


def polycubes(seed: int) -> list[list[tuple[int, int, int]]]:
    """Two or three random ones that fill different places, each grown from the one below."""
    random = np.random.default_rng(seed)
    taken: set[tuple[int, int, int]] = {(x, y, 0) for x in range(-1, 4) for y in range(-1, 4)}
    found = [sorted(taken)]
    for level in range(1, 4):
        start = (int(random.integers(0, 3)), int(random.integers(0, 3)), level)
        if start in taken:
            continue
        mine = [start]
        for _ in range(int(random.integers(1, 6))):
            x, y, z = mine[int(random.integers(len(mine)))]
            i, j, k = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)][
                int(random.integers(5))
            ]
            place = (x + i, y + j, z + k)
            if place not in taken and place not in mine:
                mine.append(place)
        taken.update(mine)
        found.append(mine)
    return found


@pytest.mark.parametrize("seed", range(12))
def test_concave_bodies_stand_as_their_pieces_do(seed: int) -> None:
    """Cells as one surface, and as convex pieces: the same verdict, the same cones of wrenches."""
    shapes = polycubes(seed)
    surfaces, pieces = ds.Scene(3, friction=0.4), ds.Scene(3, friction=0.4)
    cube = np.array([[k & 1, k >> 1 & 1, k >> 2] for k in range(8)])
    for number, shape in enumerate(shapes):
        options = {"name": str(number), "fixed": number == 0}
        add(surfaces, cells(shape), **options)  # type: ignore[arg-type]
        pieces.add_solid([cube + place for place in shape], **options)  # type: ignore[arg-type]
    assert [b.mass for b in surfaces.bodies] == pytest.approx([b.mass for b in pieces.bodies])
    assert ds.check(surfaces).stable == ds.check(pieces).stable
    pairs = {(c.a, c.b) for c in pieces.contacts if not c.at_borders}
    assert {(c.a, c.b) for c in surfaces.contacts if not c.at_borders} == pairs
    for pair in pairs:
        one, other = wrenches(surfaces, pair), wrenches(pieces, pair)
        assert max(nnls(one, column)[1] for column in other.T) < 1e-9
        assert max(nnls(other, column)[1] for column in one.T) < 1e-9


def test_islands_and_holes_on_one_plane_are_one_region() -> None:
    """A table on four feet bears like its feet's hull, a tube on a slab like a disc."""
    feet = [(x, y, 0) for x in (0, 4) for y in (0, 4)]
    table = cells([*feet, *((x, y, 1) for x in range(5) for y in range(5))])
    scene = scene_of(("ground", box((20, 20, 2), (0, 0, -1))), ("table", table))
    assert sorted(c.point[:2] for c in scene.contacts) == [(0, 0), (0, 5), (5, 0), (5, 5)]
    pipe = tube(circle(2, 8), circle(1, 8), 1)
    scene = scene_of(("ground", box((20, 20, 2), (0, 0, -1))), ("pipe", pipe))
    assert len(scene.contacts) == 8
    assert all(np.hypot(*c.point[:2]) == pytest.approx(2) for c in scene.contacts)


@pytest.mark.parametrize("turn", [(1, 0, 0, 0), (0.9, 0.1, -0.3, 0.2), (0, 1, 1, 0)])
def test_verdicts_do_not_turn_with_the_world(turn: tuple[float, float, float, float]) -> None:
    w, *v = np.array(turn) / np.linalg.norm(turn)
    k = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    rotation = np.eye(3) + 2 * w * k + 2 * k @ k
    beams = [[(x, 0, 0) for x in range(3)], [(1, 0, 1), (2, 0, 1), (3, 0, 1)]]
    shapes = [*beams, [(3, 0, 2), (4, 0, 2), (5, 0, 2)]]
    for light, expected in ((False, False), (True, True)):
        scene = ds.Scene(3, rotation @ DOWN, 0.5)
        for number, shape in enumerate(shapes[: 2 if light else 3]):
            add(scene, cells(shape), str(number), fixed=number == 0, orientation=turn)
        assert ds.check(scene).stable == expected


# Edges and vertices


def test_a_ridge_lies_on_a_face() -> None:
    """A roof on its ridge, which ends where the slab ends: two points, and it falls over."""
    ridge = (np.array([[0, -1, 0], [0, 1, 0], [1, -1, 1], [1, 1, 1], [-1, -1, 1], [-1, 1, 1.0]]),
             np.array([(0, 2, 4), (1, 5, 3), (0, 1, 3), (0, 3, 2), (0, 4, 5), (0, 5, 1),
                       (2, 3, 5), (2, 5, 4)]))  # fmt: skip
    scene = scene_of(("slab", box((4, 2, 1), (0, 0, -0.5))), ("roof", ridge))
    assert sorted(c.point for c in scene.contacts) == [(0, -1, 0), (0, 1, 0)]
    assert all(c.normal == pytest.approx((0, 0, 1)) for c in scene.contacts)
    assert ds.check(scene).stable  # exactly above its ridge
    assert not stands(("slab", box((4, 2, 1), (0, 0, -0.5))), ("roof", ridge), gravity=(1, 0, -9))


def test_a_tip_stands_on_a_face_and_edges_cross() -> None:
    tip = (np.array([[0, 0, 0], [1, 0, 1], [-1, 1, 1], [-1, -1, 1.0]]),
           np.array([(0, 2, 1), (0, 3, 2), (0, 1, 3), (1, 2, 3)]))  # fmt: skip
    scene = scene_of(("slab", box((4, 4, 1), (0, 0, -0.5))), ("tip", tip))
    (contact,) = scene.contacts
    assert contact.point == pytest.approx((0, 0, 0))
    # Two square bars on their edges, across one another.
    bar = prism([(1, 0), (0, 1), (-1, 0), (0, -1)], -3, 3)
    swap = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0.0]])
    along_x, along_y = bar[0] @ swap.T, bar[0] @ swap @ np.diag([1, 1, 1.0])
    lower = (along_x, bar[1])
    upper = moved((along_y, bar[1]), (0, 0, 2))
    scene = scene_of(("lower", lower), ("upper", upper))
    (contact,) = scene.contacts
    assert contact.point == pytest.approx((0, 0, 1))
    assert contact.normal == pytest.approx((0, 0, 1))


def test_boxes_side_by_side_do_not_bear_at_their_borders() -> None:
    """Two that share an edge of the ground only: as for convex ones."""
    scene = scene_of(("a", box((1, 1, 1))), ("b", box((1, 1, 1), (1, 0, 1))))
    assert not scene.contacts
    assert not ds.check(scene).stable


# Curved fits


def peg(radius: float, head: float | None = None) -> Mesh:
    """Upright, 3 long; with a head, 1 high, above z = 2."""
    if head is None:
        return revolved([(0, -1), (radius, -1), (radius, 2), (0, 2)])
    return revolved([(0, -1), (radius, -1), (radius, 2), (head, 2), (head, 3), (0, 3)])


PLATE = tube(circle(3), circle(1), 2.0)


def test_a_peg_in_a_hole() -> None:
    """Without clearance the wall is touched all around and bears by friction alone."""
    scene = scene_of(("plate", PLATE), ("peg", peg(1)), friction=0)
    contacts = scene.contacts
    assert len(contacts) == 4 * 48
    for contact in contacts:
        assert contact.normal[2] == pytest.approx(0)
        assert min(abs(contact.point[2]), abs(contact.point[2] - 2)) < 1e-9
    assert not ds.check(scene).stable
    assert stands(("plate", PLATE), ("peg", peg(1)), friction=0.5)
    assert stands(("plate", PLATE), ("peg", peg(1, 1.5)), friction=0)
    # Pulled sideways and turned, it is held by the wall.
    assert stands(("plate", PLATE), ("peg", peg(1, 1.5)), friction=0, gravity=(9, 3, -1))


def test_a_peg_with_clearance() -> None:
    """A tenth of a millimetre: it falls through, or hangs on its head; the gap is listed."""
    for tolerance in (None, 1e-5):
        scene = scene_of(("plate", PLATE), ("peg", peg(1 - 1e-4)), tolerance=tolerance)
        assert not scene.contacts
        assert not ds.check(scene).stable
    (miss,) = scene.near_misses
    assert (miss.a, miss.b) == ("plate", "peg")
    assert miss.gap == pytest.approx(1e-4, rel=0.01)
    headed = scene_of(("plate", PLATE), ("peg", peg(1 - 1e-4, 1.5)))
    assert {round(c.point[2], 9) for c in headed.contacts} == {2.0}
    assert ds.check(headed).stable


def test_a_spline_holds_a_crank() -> None:
    """Twelve teeth without friction: the arm does not turn the shaft, which slides out
    along its axis."""
    teeth = np.concatenate([circle(1.0, 12), circle(1.3, 12, np.pi / 12)], axis=1).reshape(-1, 2)
    outer = 2.5 * teeth / np.linalg.norm(teeth, axis=1)[:, None]
    # The arm is a shell of its own that touches the shaft: one rigid body.
    crank = together(prism(teeth, 0, 2.0), moved(box((3, 0.5, 0.5)), (1.2, 0, 2.25)))
    pair = (("bearing", tube(outer, teeth, 2.0)), ("crank", crank))
    assert stands(*pair, friction=0, gravity=(0, -9.81, 0))
    assert stands(*pair, friction=0, gravity=(0, 9.81, 0))
    assert not stands(*pair, friction=0, gravity=(0, 0, 9.81))


def test_a_ring_on_a_cone() -> None:
    """Of the same slope: without friction it stands where the cone widens downwards only."""
    n = 32
    cone = revolved([(0, 0), (2, 0), (1, 2), (0, 2)], n)
    # The hole follows the cone between the heights .5 and 1.5.
    collar = lathe([ring(1.75, 0.5, n), ring(3, 0.5, n), ring(3, 1.5, n), ring(1.25, 1.5, n)])
    scene = scene_of(("cone", cone), ("ring", collar), friction=0)
    slope = np.array([2, 1]) / np.sqrt(5)
    for contact in scene.contacts:
        out = np.array([np.hypot(*contact.normal[:2]), contact.normal[2]])
        assert out == pytest.approx(slope, abs=0.01)
    assert ds.check(scene).stable
    assert not stands(("cone", cone), ("ring", collar), friction=0, gravity=(0, 0, 9.81))


def test_a_ball_in_a_socket() -> None:
    """A block with a hemispherical hollow holds a ball without friction against all that presses it
    in, and lets it out upwards."""
    n, rows = 24, 12
    angles = -np.pi / 2 * (1 - np.arange(rows // 2 + 1) / (rows // 2))
    inner = [(np.cos(a), np.sin(a)) for a in angles]
    profile = [(0, -2), (2, -2), (2, 0), *((r, z) for r, z in inner[::-1] if r > 1e-9), (0, -1)]
    socket = revolved(profile, n)
    pair = (("socket", socket), ("ball", ball(1, rows=rows, sections=n)))
    scene = scene_of(*pair, friction=0)
    assert scene.contacts
    for contact in scene.contacts:
        assert np.array(contact.point) @ contact.normal == pytest.approx(-1, abs=0.02)
    assert ds.check(scene).stable
    assert stands(*pair, friction=0, gravity=(5, 2, -9.81))
    assert not stands(*pair, friction=0, gravity=(0, 0, 9.81))
    assert not stands(*pair, friction=0, gravity=(9.81, 0, 3))


def test_many_points_are_thinned_out_within_the_stated_error() -> None:
    """A fine ball in its socket: thousands of facet corners, of which some hundreds are left. Every
    corner of a facet, pressed along its normal, is a sum of what those bear."""
    sections, rows = 64, 32
    angles = -np.pi / 2 * (1 - np.arange(rows // 2 + 1) / (rows // 2))
    profile = [(0, -2), (2, -2), (2, 0), *((np.cos(a), np.sin(a)) for a in angles[:0:-1]), (0, -1)]
    sphere = ball(1, rows=rows, sections=sections)
    scene = scene_of(("socket", revolved(profile, sections)), ("ball", sphere), friction=0)
    contacts = scene.contacts
    facets = sphere[0][sphere[1]]
    facets = facets[facets[:, :, 2].max(axis=1) < 1e-9]
    assert len(contacts) < len(facets)  # and not three for each
    columns = [np.r_[c.normal, np.cross(c.point, c.normal)] for c in contacts]
    normals = np.cross(facets[:, 1] - facets[:, 0], facets[:, 2] - facets[:, 0])
    normals /= -np.linalg.norm(normals, axis=1)[:, None]
    for k in np.random.default_rng(0).choice(len(facets), 40, replace=False):
        wrench = np.r_[normals[k], np.cross(facets[k, 0], normals[k])]
        assert nnls(np.array(columns).T, wrench)[1] < 0.05
    assert ds.check(scene).stable
    assert [c.feature for c in scene.contacts] == [c.feature for c in contacts]


# Assemblies


def test_a_dovetail_lets_go_along_its_groove_only() -> None:
    """Section of the groove: open at the top, wider below."""
    tail = [(-1, -0.5), (1, -0.5), (0.6, 0.5), (-0.6, 0.5)]
    slider = prism(tail, 0, 4.0)
    outer = [
        (-0.6, 0.5),
        (-2, 0.5),
        (-2, -1.5),
        (2, -1.5),
        (2, 0.5),
        (0.6, 0.5),
        (1, -0.5),
        (-1, -0.5),
    ]
    vertices = np.array([(x, y, z) for z in (0.0, 4.0) for x, y in outer])
    caps = [(0, 1, 7), (1, 2, 7), (2, 3, 7), (3, 6, 7), (3, 4, 6), (4, 5, 6)]
    sides = [
        t
        for k in range(8)
        for t in ((k, (k + 1) % 8, 8 + (k + 1) % 8), (k, 8 + (k + 1) % 8, 8 + k))
    ]
    triangles = (
        [(a, c, b) for a, b, c in caps] + [(8 + a, 8 + b, 8 + c) for a, b, c in caps] + sides
    )
    pair = (("block", (vertices, np.array(triangles))), ("slider", slider))
    for gravity, expected in (
        ((0, 9.81, 0), True), ((0, -9.81, 0), True), ((9.81, 0, 0), True), ((3, 9, 0), True),
        ((0, 0, 9.81), False), ((0, 5, -2), False),
    ):  # fmt: skip
        assert stands(*pair, friction=0, gravity=gravity) == expected, gravity


def test_a_ball_in_a_closed_box_rests_on_its_floor() -> None:
    shell = together(box((4, 4, 4)), turned_out(box((3, 3, 3))))
    inside = ball(1, (0.2, 0, -0.5))
    ground = ("ground", box((9, 9, 1), (0, 0, -2.5)))
    scene = scene_of(ground, ("shell", shell), ("ball", inside))
    assert Counter((c.a, c.b) for c in scene.contacts) == {
        ("ground", "shell"): 4,
        ("shell", "ball"): 1,
    }
    assert ds.check(scene).stable
    assert ds.plan(scene).order[-1] == "shell"


def test_a_box_with_a_lid() -> None:
    """The lid's rim goes into the box: held sideways, taken off upwards, and first."""
    tray = cells([(x, y, z) for x in range(4) for y in range(4) for z in range(2)
                  if z == 0 or x in (0, 3) or y in (0, 3)])  # fmt: skip
    lid = cells([*((x, y, 2) for x in range(4) for y in range(4)), (1, 1, 1), (2, 2, 1)])
    bodies = (("ground", box((20, 20, 2), (0, 0, -1))), ("tray", tray), ("lid", lid))
    scene = scene_of(*bodies, friction=0.3)
    assert ds.check(scene).stable
    plan = ds.plan(scene, clear_path=True)
    assert plan.order == ("lid", "tray")
    assert plan.directions[0] == pytest.approx((0, 0, 1))
    assert stands(("tray", tray), ("lid", lid), friction=0, gravity=(9, 2, -1))
    assert not stands(("tray", tray), ("lid", lid), friction=0, gravity=(0, 0, 1))


def test_straight_ways_out_of_fine_parts() -> None:
    """A peg leaves its hole upwards if its head is there, downwards if not; one with two heads is
    locked in."""
    scene = scene_of(("plate", PLATE), ("peg", peg(1, 1.5)))
    plan = ds.plan(scene, clear_path=True)
    assert (plan.order, plan.directions) == (("peg",), ((0.0, 0.0, 1.0),))
    stopper = revolved([(0, -1), (1.5, -1), (1.5, 0), (1, 0), (1, 2), (1.5, 2), (1.5, 3), (0, 3)])
    locked = ds.plan(scene_of(("plate", PLATE), ("stopper", stopper)), clear_path=True)
    assert locked.status == "locked"
    assert locked.blocked[0].name == "stopper"
    # Through a level bore the way out is along the axis of neither the world nor a contact.
    turn = np.array([[0.8, 0, 0.6], [0, 1, 0], [-0.6, 0, 0.8]])
    plate, headed = ((mesh[0] @ turn.T, mesh[1]) for mesh in (PLATE, peg(0.999, 1.5)))
    plan = ds.plan(scene_of(("plate", plate), ("peg", headed), friction=2), clear_path=True)
    assert plan.directions[0] == pytest.approx(turn @ [0, 0, 1])


def test_an_arch_of_surfaces_stands_and_its_plan_needs_a_hand() -> None:
    """Seven wedges of a half circle around half of a drum, which holds them from below."""
    scene = ds.Scene(3, friction=0.6)
    angles = np.linspace(0, np.pi, 8)
    add(scene, box((8, 2, 1), (0, 0.5, -0.5)), "ground", fixed=True)
    for k, (a, b) in enumerate(itertools.pairwise(angles)):
        flat = [(r * np.cos(t), r * np.sin(t)) for r, t in ((2, a), (3, a), (3, b), (2, b))]
        vertices = np.array([(x, y, z) for y in (0.0, 1.0) for x, z in flat])
        triangles = [t[::-1] for t in ((0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7))]
        triangles += [t[::-1] for i in range(4) for j in [(i + 1) % 4]
                      for t in ((i, j, 4 + j), (i, 4 + j, 4 + i))]  # fmt: skip
        add(scene, (vertices, np.array(triangles)), f"w{k}")
    assert ds.check(scene).stable
    assert not ds.plan(scene).found
    held = ds.plan(scene, hold=4)
    assert held.found
    assert set(held.order) == {f"w{k}" for k in range(7)}
    structure = ds.Structure(scene)
    for name in ("w0", "w1", "w2"):
        structure.add(name)
    assert structure.stands() == ds.check(scene, ["w0", "w1", "w2"]).stable


# Overlaps and gaps


@pytest.mark.parametrize(
    ("by", "depth"),
    [((0, 0, 0), None), ((0.5, 0, 0), 0.5), ((0.3, 0.2, 0.1), None), ((0.999, 0, 0), 1e-3),
     ((0.99, 0.99, 0.99), 0.01)],
)  # fmt: skip
def test_boxes_that_overlap_are_named(by: tuple[float, float, float], depth: float | None) -> None:
    scene = scene_of(("a", box((1, 1, 1))), ("b", box((1, 1, 1), by)))
    (overlap,) = scene.overlaps
    assert (overlap.a, overlap.b) == ("a", "b")
    if depth is not None:
        assert overlap.depth == pytest.approx(depth)
    with pytest.raises(ds.SceneError, match='blocks "a" and "b" overlap by'):
        ds.check(scene)


def test_what_goes_through_or_is_inside_overlaps() -> None:
    bar = box((3, 1, 1))
    for other in (box((1, 3, 1)), box((0.5, 0.5, 3)), box((0.2, 0.2, 0.2)), ball(0.3), ball(2.0)):
        assert len(scene_of(("bar", bar), ("other", other)).overlaps) == 1
    # The other way round, and in a hollow that is too small.
    hollow = together(box((4, 4, 4)), turned_out(box((2, 2, 2))))
    assert scene_of(("hollow", hollow), ("ball", ball(0.9))).overlaps == []
    assert len(scene_of(("hollow", hollow), ("ball", ball(1.1))).overlaps) == 1
    assert len(scene_of(("ball", ball(0.3, (1.5, 0, 0))), ("hollow", hollow)).overlaps) == 1


def test_penetration_within_the_tolerance_is_contact() -> None:
    for gap, touch in ((-0.9e-6, True), (0.9e-6, True), (1.1e-6, False)):
        pair = (("a", box((1, 1, 1))), ("b", box((1, 1, 1), (0, 0, 1 + gap))))
        scene = scene_of(*pair)
        assert bool(scene.contacts) == touch
        assert scene.overlaps == []
        assert bool(scene.near_misses) != touch
        for contact in scene.contacts:
            assert contact.gap == pytest.approx(gap, rel=1e-3)


# What is no closed surface


def test_open_and_broken_surfaces_are_refused() -> None:
    vertices, triangles = box((1, 1, 1))
    scene = ds.Scene(dimension=3)
    for broken, says in (
        (triangles[1:], "not closed"),
        (triangles[:, ::-1], "inside out"),
        (np.r_[triangles, [[0, 0, 1]]], "does not have three different vertices"),
        (triangles[:0], "no triangles|must be"),
    ):
        with pytest.raises(ds.SceneError, match=says):
            scene.add_surface(vertices, broken, "x")
    flipped = triangles.copy()
    flipped[0] = flipped[0, ::-1]
    with pytest.raises(ds.SceneError, match="not closed: its triangles do not go as often"):
        scene.add_surface(vertices, flipped)
    with pytest.raises(ds.SceneError, match="must be"):
        scene.add_surface(vertices, triangles + 1)
    with pytest.raises(ds.SceneError, match="must be"):
        scene.add_surface(vertices[:, :2], triangles)
    assert len(scene) == 0


def test_broken_meshes_are_mended_and_said_or_refused() -> None:
    """Never a wrong mass: duplicate and spare vertices, slivers, flips, a hollow that faces out."""
    trimesh = pytest.importorskip("trimesh")
    vertices, triangles = cells([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    apart = (vertices[triangles].reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3))
    spare = (np.r_[vertices, [[100.0, 0, 0]]], np.r_[triangles, [[0, 0, 1]]])
    flipped = (vertices, np.r_[triangles[:3, ::-1], triangles[3:]])
    inside_out = (vertices, triangles[:, ::-1])
    for mended, says in ((apart, "duplicate vertices"), (spare, "without area"),
                         (flipped, "faced the other way"), (inside_out, "inside out")):  # fmt: skip
        scene = ds.Scene(dimension=3)
        with pytest.warns(ds.meshes.MeshWarning, match=says):
            scene.add_mesh(trimesh.Trimesh(*mended, process=False), surface=True, name="L")
        assert scene.body("L").mass == pytest.approx(3)
        assert scene.body("L").surface is not None
    hollow = together(box((4, 4, 4)), box((2, 2, 2)))
    with pytest.raises(ds.meshes.MeshError, match="turn the inner part's faces inwards"):
        ds.Scene(3).add_mesh(trimesh.Trimesh(*hollow, process=False), surface=True)


# The rest of the library


def test_files_copies_and_simulation(tmp_path: Path) -> None:
    scene = scene_of(("plate", PLATE), ("peg", peg(1, 1.5)))
    scene.save(tmp_path / "a.json")
    for other in (ds.Scene.load(tmp_path / "a.json"), pickle.loads(pickle.dumps(scene))):
        assert other.to_json() == scene.to_json()
        assert [c.feature for c in other.contacts] == [c.feature for c in scene.contacts]
    with pytest.raises(ds.SimulationError, match=r'block "plate" is a closed surface: .* pieces'):
        ds.simulate(scene, 0.01)
    with pytest.raises(ds.SimulationError, match="closed surface"):
        ds.World(scene)


def test_pictures_and_pages_draw_the_triangles(tmp_path: Path) -> None:
    scene = scene_of(("plate", PLATE), ("peg", peg(1, 1.5)))
    scene.draw(tmp_path / "a.svg")
    assert (tmp_path / "a.svg").read_text(encoding="utf-8").count("<path") > 100
    scene.view().save(tmp_path / "a.html")
    (body, _) = scene.view().recording.to_json()["bodies"]
    assert body["pieces"] is not None
    assert len(body["pieces"][0]["faces"]) == len(PLATE[1])
    ds.check(scene).draw(tmp_path / "b.svg")


def test_parts_keep_their_contacts() -> None:
    """A contact's name is that of its pair, whatever else is there."""
    bodies = (("plate", PLATE), ("peg", peg(1, 1.5)), ("lid", box((1, 1, 1), (0, 0, 3.5))))
    whole, part = scene_of(*bodies), scene_of(*bodies[:2])
    named = [(c.a, c.b, c.feature, c.point) for c in whole.contacts if c.b == "peg"]
    assert named == [(c.a, c.b, c.feature, c.point) for c in part.contacts]
    assert len({(c.a, c.b, c.feature) for c in whole.contacts}) == len(whole.contacts)


def test_numbers_are_the_same_in_other_units_and_far_away() -> None:
    scene = scene_of(("plate", PLATE), ("peg", peg(1, 1.5)))
    reference = [(c.feature, c.point) for c in scene.contacts]
    for scale, by in ((1e-3, 0.0), (1e4, 0.0), (1.0, 4096.0)):
        meshes = [((v * scale + by), t) for v, t in (PLATE, peg(1, 1.5))]
        other = scene_of(("plate", meshes[0]), ("peg", meshes[1]))
        assert len(other.contacts) == len(reference)
        assert ds.check(other).stable


def test_a_part_of_many_planes_is_read_as_a_surface(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.Trimesh(*tube(circle(3, 60), circle(1, 60), 2.0), process=False)
    mesh.export(tmp_path / "ring.stl")
    scene = ds.Scene(dimension=3)
    with pytest.warns(ds.meshes.MeshWarning, match="more than 100 planes: taken as the surface"):
        scene.add_mesh(tmp_path / "ring.stl", name="ring")
    assert scene.body("ring").surface is not None
    assert scene.body("ring").mass == pytest.approx(mesh.volume, rel=1e-6)
    imported = ds.imports.load(tmp_path / "ring.stl")
    assert imported.to_dict()["bodies"][0]["triangles"] == len(mesh.faces)
    with pytest.raises(ds.meshes.MeshError, match="convex pieces"):
        ds.imports.load(tmp_path / "ring.stl", max_pieces=8)


def test_a_tolerance_that_lets_nothing_overlap(tmp_path: Path) -> None:
    """Numbers of two parts that go 2 mm into each other: auto takes no more than that."""
    trimesh = pytest.importorskip("trimesh")
    for name, z in (("0", 0.0), ("1", 0.998)):
        trimesh.Trimesh(*box((1, 1, 1), (0, 0, z)), process=False).export(tmp_path / f"{name}.obj")
    with pytest.raises(ds.SceneError, match="overlap"):
        ds.check(ds.imports.load(tmp_path, fixed=["0"]).scene)
    imported = ds.imports.load(tmp_path, fixed=["0"], tolerance="auto")
    assert imported.scene.contact_tolerance == pytest.approx(0.002, rel=0.02)
    assert "overlap by up to 0.002 m" in imported.messages[-1]
    assert ds.check(imported.scene).stable
    trimesh.Trimesh(*box((1, 1, 1), (0, 0, 0.6)), process=False).export(tmp_path / "1.obj")
    with pytest.raises(ds.SceneError, match=r"overlap by 4\.000e-1"):
        ds.check(ds.imports.load(tmp_path, fixed=["0"], tolerance="auto").scene)
    with pytest.raises(ds.imports.FormatError, match="a length in metres or 'auto'"):
        ds.imports.load(tmp_path, tolerance="all")


def test_a_file_of_the_whole_beside_its_parts_is_left_out(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    parts = [box((1, 1, 1), (0, 0, k)) for k in range(3)]
    for number, part in enumerate(parts):
        trimesh.Trimesh(*part, process=False).export(tmp_path / f"{number}.obj")
    trimesh.Trimesh(*together(*parts), process=False).export(tmp_path / "tower.obj")
    trimesh.Trimesh(*box((9, 9, 1), (0, 0, -1)), process=False).export(tmp_path / "ground.obj")
    imported = ds.imports.load(tmp_path)
    assert imported.scene.names == ["0", "1", "2", "ground"]
    assert [out.what for out in imported.left_out] == ["tower.obj"]
