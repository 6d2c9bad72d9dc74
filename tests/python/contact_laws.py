"""The laws of contact of planar blocks at rest, written down from the scene alone: nothing here is
shared with the core but where bodies touch.

    M a = F + J' f,   0 <= a_n complementary to f_n >= 0,   |f_t| <= mu f_n,
    f_t = -mu f_n a_t / |a_t| where a_t != 0
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp

import drystone as ds

FREE_FALL = 9.81


class Laws:
    """Masses, loads and the rows of contact points of a planar scene."""

    def __init__(self, scene: ds.Scene) -> None:
        self.names = [body.name for body in scene.bodies if not body.fixed]
        place = {name: 3 * i for i, name in enumerate(self.names)}
        body = {body.name: body for body in scene.bodies}
        self.mass = np.array(
            [x for n in self.names for x in (body[n].mass, body[n].mass, body[n].inertia)]
        )
        gravity = [*scene.gravity, 0.0]
        self.load = self.mass * np.tile(gravity, len(self.names))
        self.contacts = list(scene.contacts)
        count = len(self.contacts)
        self.normal = np.zeros((count, len(self.mass)))
        self.tangent = np.zeros((count, len(self.mass)))
        self.friction = np.array([contact.friction for contact in self.contacts])
        for k, contact in enumerate(self.contacts):
            n = np.array(contact.normal)
            t = np.array([-n[1], n[0]])
            for name, sign in ((contact.a, -1.0), (contact.b, 1.0)):
                if name in place:
                    arm = np.array(contact.point) - body[name].center_of_mass
                    for rows, d in ((self.normal, n), (self.tangent, t)):
                        turn = arm[0] * d[1] - arm[1] * d[0]
                        rows[k, place[name] : place[name] + 3] += sign * np.array([*d, turn])


def check_escape(scene: ds.Scene, escape: ds.Escape, tolerance: float = 1e-6) -> None:
    """AssertionError unless an escape obeys every law and moves."""
    laws = Laws(scene)
    assert list(escape.names) == laws.names
    a = escape.accelerations.ravel()
    assert abs(a).max() > 1e-3
    key = {(c.a, c.b, c.feature): k for k, c in enumerate(laws.contacts)}
    normal, tangential = np.zeros(len(key)), np.zeros(len(key))
    for force in escape.forces:
        k = key[force.a, force.b, force.feature]
        n = np.array(force.normal)
        normal[k], tangential[k] = n @ force.force, np.array([-n[1], n[0]]) @ force.force
    left = laws.mass * a - laws.load - laws.normal.T @ normal - laws.tangent.T @ tangential
    size = tolerance * max(abs(laws.load).max(), normal.max(initial=0.0))
    speed = tolerance * abs(a).max()
    assert abs(left).max() <= size, "Newton and Euler"
    parts, slides = laws.normal @ a, laws.tangent @ a
    assert parts.min(initial=0.0) >= -speed, "contacts close"
    assert normal.min(initial=0.0) >= -size, "contacts pull"
    assert not np.any((parts > speed) & (normal > size)), "a force where contacts part"
    most = laws.friction * normal
    assert np.all(abs(tangential) <= most + size), "outside the friction cone"
    sliding = (abs(slides) > 10 * speed) & (normal > size)
    resisting = -np.sign(slides) * most
    assert np.all(abs(tangential - resisting)[sliding] <= 10 * size), (
        "friction that does not resist"
    )


def most_power(scene: ds.Scene, seconds: float) -> float | None:
    """The largest power of the loads in any solution of the laws, over that of free fall, by HiGHS
    with an integer for every choice; None if it is not proved in time. Forces are at most 200 times
    all loads."""
    laws = Laws(scene)
    root = np.sqrt(laws.mass)
    fall = np.linalg.norm(laws.load / root)
    load = laws.load / root / fall
    normal, tangent = laws.normal / root, laws.tangent / root
    size, count = len(load), len(laws.contacts)
    most = 200.0 * np.abs(laws.load).sum() / fall
    # a, f_n, f_t, and three integers a point: it parts, slides along t, slides against it.
    n = size + 5 * count
    at = {name: size + k * count for k, name in enumerate(("fn", "ft", "part", "along", "against"))}
    rows: list[np.ndarray] = []
    lower: list[float] = []
    upper: list[float] = []

    def row(entries: dict[int, float], low: float, high: float) -> None:
        line = np.zeros(n)
        for column, value in entries.items():
            line[column] += value
        rows.append(line)
        lower.append(low)
        upper.append(high)

    for k in range(size):
        balance = {k: 1.0}
        for c in range(count):
            balance[at["fn"] + c] = -normal[c, k]
            balance[at["ft"] + c] = -tangent[c, k]
        row(balance, load[k], load[k])
    for c in range(count):
        fn, ft, part = at["fn"] + c, at["ft"] + c, at["part"] + c
        along, against, mu = at["along"] + c, at["against"] + c, laws.friction[c]
        far = {k: float(np.abs(r[c]).sum()) for k, r in (("n", normal), ("t", tangent))}
        a_n = {k: normal[c, k] for k in range(size)}
        a_t = {k: tangent[c, k] for k in range(size)}
        row(a_n, 0.0, np.inf)
        row({**a_n, part: -far["n"]}, -np.inf, 0.0)
        row({fn: 1.0, part: most}, -np.inf, most)
        row({fn: mu, ft: -1.0}, 0.0, np.inf)
        row({fn: mu, ft: 1.0}, 0.0, np.inf)
        row({**a_t, along: -far["t"], part: -far["t"]}, -np.inf, 0.0)
        row({**a_t, against: far["t"], part: far["t"]}, 0.0, np.inf)
        row({along: 1.0, against: 1.0, part: 1.0}, -np.inf, 1.0)
        # Sliding along t: f_t = -mu f_n; against it: f_t = mu f_n.
        row({ft: 1.0, fn: mu, along: 2.0 * mu * most}, -np.inf, 2.0 * mu * most)
        row({ft: -1.0, fn: mu, against: 2.0 * mu * most}, -np.inf, 2.0 * mu * most)
    low, high = np.full(n, -1.0), np.ones(n)
    low[size : at["ft"]], high[size : at["ft"]] = 0.0, most
    low[at["ft"] : at["part"]], high[at["ft"] : at["part"]] = -np.inf, np.inf
    low[at["part"] :] = 0.0
    cost = np.zeros(n)
    cost[:size] = -load
    integer = np.zeros(n)
    integer[at["part"] :] = 1
    found = milp(
        cost,
        constraints=LinearConstraint(np.array(rows), lower, upper),
        bounds=Bounds(low, high),
        integrality=integer,
        options={"time_limit": seconds, "mip_rel_gap": 1e-6},
    )
    return None if found.status != 0 else float(-found.fun)


Corner = tuple[float, float]


def _cut(piece: list[Corner], point: Corner, normal: Corner) -> list[list[Corner]]:
    """The two sides of a convex polygon along a line."""
    sides: list[list[Corner]] = [[], []]
    for (x, y), (u, v) in zip(piece, piece[1:] + piece[:1], strict=True):
        here = (x - point[0]) * normal[0] + (y - point[1]) * normal[1]
        there = (u - point[0]) * normal[0] + (v - point[1]) * normal[1]
        for side, sign in zip(sides, (1, -1), strict=True):
            if sign * here >= 0:
                side.append((x, y))
        if here * there < 0:
            t = here / (here - there)
            crossing = (x + t * (u - x), y + t * (v - y))
            sides[0].append(crossing)
            sides[1].append(crossing)
    return sides


def _area(piece: list[Corner]) -> float:
    pairs = zip(piece, piece[1:] + piece[:1], strict=True)
    return 0.5 * sum(x * v - u * y for (x, y), (u, v) in pairs)


def cut_stone(seed: int, most: int = 6) -> ds.Scene:
    """A square cut along random lines, some pieces fixed and sometimes one taken out: blocks that
    lean, hang and are wedged. Up to so many can move."""
    random = np.random.default_rng(seed)
    pieces: list[list[Corner]] = [[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]]
    wanted = int(random.integers(3, 10))
    while len(pieces) < wanted:
        largest = max(range(len(pieces)), key=lambda i: _area(pieces[i]) * random.uniform(0.5, 1))
        piece = pieces.pop(largest)
        middle = np.mean(piece, axis=0) + random.uniform(-0.3, 0.3, 2)
        level = random.uniform(-0.3, 0.3)
        angle = [random.uniform(0, np.pi), level, np.pi / 2 + level][random.integers(3)]
        sides = _cut(piece, (middle[0], middle[1]), (-np.sin(angle), np.cos(angle)))
        whole = all(len(side) > 2 and _area(side) > 0.05 for side in sides)
        pieces += sides if whole else [piece]
    order = random.permutation(len(pieces))
    movable = int(random.integers(1, min(most, len(pieces) - 1) + 1))
    absent = int(random.integers(0, 2))
    scene = ds.Scene(friction=float(random.choice([0.2, 0.4, 0.6, 0.8, 1.0])))
    for i, place in enumerate(order[absent:]):
        scene.add_polygon(pieces[place], name=str(i), fixed=i >= movable)
    return scene
