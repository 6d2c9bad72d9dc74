"""One step's contact problem by its matrices: `drystone.contact`."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy import sparse

import drystone as ds
from drystone import contact

FALL = 9.81 / 240


def block(angle: float) -> dict[str, Any]:
    """A cube of 2 kg on a slope, four corners on it, after a step of free fall."""
    rows = []
    for x, y in [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]:
        lever = np.array([x, y, -0.5])
        for d in np.eye(3)[[2, 0, 1]]:
            rows.append([*d, *np.cross(lever, d)])
    down = FALL * np.array([np.sin(angle), 0, -np.cos(angle)])
    mass = np.diag([2.0] * 3 + [1 / 3] * 3)
    return {"M": mass, "J": np.array(rows), "mu": 0.5, "free": [*down, 0, 0, 0]}


@pytest.mark.parametrize("angle", [0.3, 0.46, 0.47, 1.0])
def test_a_block_on_a_slope(angle: float) -> None:
    """It sticks up to tan(angle) = mu, and slides by g (sin - mu cos) beyond (Coulomb)."""
    s = contact.solve(**block(angle), dimension=3)
    speed = max(0.0, FALL * (np.sin(angle) - 0.5 * np.cos(angle)))
    assert s.status == "solved"
    assert s.error <= s.tolerance
    np.testing.assert_allclose(s.velocities, [speed, 0, 0, 0, 0, 0], atol=1e-9)
    assert s.impulses.shape == (12,)
    assert s.impulses[::3].sum() == pytest.approx(2 * FALL * np.cos(angle))


def test_every_way_to_give_m() -> None:
    given = block(0.6)
    mass = given.pop("M")
    once = contact.solve(mass, **given, dimension=3).velocities
    for other in (sparse.csr_array(mass), mass.diagonal(), mass[None]):
        again = contact.solve(other, **given, dimension=3).velocities
        np.testing.assert_array_equal(again, once)
    given["J"] = sparse.coo_array(given["J"])
    given["mu"] = [0.5] * 4
    np.testing.assert_array_equal(contact.solve(mass, **given).velocities, once)


def departure(
    s: contact.Solution,
    M: Any,
    J: Any,
    mu: Any,
    free: Any,
    offset: Any = 0.0,
    d: int = 3,
) -> float:
    """The balance of momentum, and each condition of Coulomb's law, computed again."""
    balance = np.abs(M @ (s.velocities - free) - J.T @ s.impulses).max()
    u, p = (J @ s.velocities).reshape(-1, d), s.impulses.reshape(-1, d)
    opening = u[:, 0] + offset
    speed, friction = np.linalg.norm(u[:, 1:], axis=1), np.linalg.norm(p[:, 1:], axis=1)
    limit = np.asarray(mu) * p[:, 0]
    against = p[:, 1:] * speed[:, None] + limit[:, None] * u[:, 1:]
    return max(
        balance,
        np.abs(np.minimum(opening, p[:, 0])).max(),
        (friction - limit).max(),
        np.abs(against).max(),
    )


@pytest.mark.parametrize("d", [2, 3])
def test_any_m_that_couples(d: int) -> None:
    """Random M, J and coefficients; M couples all unknowns, as that of a mechanism does."""
    random = np.random.default_rng(d)
    for size, contacts in [(4, 1), (9, 5), (40, 12)]:
        root = random.normal(size=(size, size))
        M = root @ root.T + np.eye(size)
        J = random.normal(size=(d * contacts, size))
        mu = random.uniform(0, 0.8, contacts)
        free, offset = random.normal(size=size), random.uniform(0, 0.1, contacts)
        s = contact.solve(M, J, mu, free, offset)
        assert s.status == "solved"
        assert departure(s, M, J, mu, free, offset, d) < 1e-7


def test_the_solver_of_steps_agrees() -> None:
    """A chain of blocks in the plane, pushed along a floor, as `World` makes the step by pivots."""
    world = ds.World(chain(3))
    before = world.velocities.copy()
    before[2] = (1.0, 0, 0)
    world.set_velocity("2", (1.0, 0, 0))
    world.step()
    # The same by hand: unit squares 1, 2, 3 side by side, each on two corners; faces meet at two.
    rows, centers = [], {k: np.array([k - 1.0, 0.5]) for k in (1, 2, 3)}
    contacts = [(None, k, (k - 1 + x, 0), (0, 1)) for k in (1, 2, 3) for x in (-0.5, 0.5)]
    contacts += [(a, b, (a - 0.5, y), (1, 0)) for a, b in pairwise((1, 2, 3)) for y in (0, 1)]
    for a, b, point, n in contacts:
        for along in (n, (-n[1], n[0])):
            row = np.zeros(9)
            for k, sign in ((a, -1), (b, 1)):
                if k is not None:
                    x, y = np.array(point) - centers[k]
                    row[3 * k - 3 : 3 * k] = sign * np.array([*along, x * along[1] - y * along[0]])
            rows.append(row)
    masses = np.tile([1, 1, 1 / 6], 3)
    free = before[1:].ravel() + np.tile([0, -FALL, 0], 3)
    s = contact.solve(masses, np.array(rows), [0.5] * len(contacts), free)
    assert s.status == "solved"
    np.testing.assert_allclose(s.velocities.reshape(3, 3), world.velocities[1:], atol=1e-8)


def chain(blocks: int) -> ds.Scene:
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, -0.5), (40, 1), name="ground", fixed=True)
    for k in range(blocks):
        scene.add_box((k, 0.5), (1, 1), name=f"{k + 1}", density=1)
    return scene


def test_restitution_and_offset() -> None:
    def ball(**options: Any) -> float:
        s = contact.solve(np.eye(2), [[0, 1], [1, 0]], [0.0], [3, -2], **options)
        return float(s.velocities[1])

    assert ball() == 0
    assert ball(restitution=0.5) == pytest.approx(1)
    assert ball(restitution=1) == pytest.approx(2)
    assert ball(offset=0.5) == pytest.approx(-0.5)
    assert ball(offset=2.5, restitution=1) == -2  # it does not touch
    assert ball(offset=-0.25) == pytest.approx(0.25)


def test_starts() -> None:
    given = block(0.3)
    once = contact.solve(**given, dimension=3)
    for start in (once, once.impulses):
        again = contact.solve(**given, dimension=3, start=start)
        assert again.sweeps <= 2
        np.testing.assert_allclose(again.velocities, once.velocities, atol=1e-12)


def test_a_tolerance_that_is_not_reached_is_a_status() -> None:
    s = contact.solve(**block(0.3), dimension=3, tolerance=0.0)
    assert s.status == ("solved" if s.error == 0 else "limit")
    assert contact.solve(**block(0.3), dimension=3, scale=100.0).tolerance == pytest.approx(1e-6)


def test_nothing_to_solve() -> None:
    s = contact.solve(np.eye(3), np.zeros((0, 3)), 0.5, [1, 2, 3])
    assert (s.status, s.error, s.impulses.size) == ("solved", 0, 0)
    np.testing.assert_array_equal(s.velocities, [1, 2, 3])


@pytest.mark.parametrize("size", [1e200, 1e307])
def test_what_overflows_is_not_solved(size: float) -> None:
    s = contact.solve(np.eye(2), [[0.0, 1.0], [1.0, 0.0]], 0.5, (size, -size))
    assert s.status == "limit"
    assert not np.isfinite(s.error)


@pytest.mark.parametrize("mu", [1e2, 1e4, 1e6, 1e9, 1e300])
def test_great_friction_stops_what_falls(mu: float) -> None:
    """Nothing slides: the velocities are 0, and the impulses are minus the momentum."""
    s = contact.solve(np.eye(3), np.eye(3), mu, [-1, 2, 0])
    assert s.status == "solved"
    np.testing.assert_allclose(s.velocities, [0, 0, 0], atol=1e-7)
    np.testing.assert_allclose(s.impulses, [1, -2, 0], atol=1e-7)


@pytest.mark.parametrize("mu", [1e4, 1e6, 1e8])
def test_great_friction_lets_nothing_in(mu: float) -> None:
    """No contact closes, however little of that the error sees at so flat a cone."""
    random = np.random.default_rng(1)
    for _ in range(100):
        J = random.normal(size=(3 * random.integers(1, 8), 12))
        free = random.normal(size=12)
        s = contact.solve(np.ones(12), J, mu, free, dimension=3)
        closing = -(J @ s.velocities)[::3].min()
        assert s.status == "limit" or closing < 100 * s.tolerance


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"M": np.eye(5)}, "M is of shape"),
        ({"M": -np.eye(6)}, "positive definite"),
        ({"M": np.eye(6) + np.eye(6, k=1)}, "not symmetric"),
        ({"M": np.full((6, 6), np.nan)}, "M"),
        ({"M": np.eye(6) * 1j}, "real numbers"),
        ({"J": np.zeros((12, 5))}, "J has 5 columns"),
        ({"J": np.zeros((13, 6))}, "J has 13 rows"),
        ({"J": np.full((12, 6), np.inf)}, r"^J\[0, 0\] is inf"),
        ({"J": np.diag([1, np.nan])[[0, 0, 1, *[0] * 9]][:, [0, 0, 0, 1, 0, 0]]}, r"^J\[2, 3\]"),
        ({"M": [[1.0, 0.0], [0.0]]}, "M must hold real numbers"),
        ({"mu": -0.1}, "friction of contact 0"),
        ({"mu": None}, "mu must hold real numbers, not None"),
        ({"mu": [0.5, None, 0.5, 0.5]}, "mu must hold real numbers"),
        ({"mu": [0.5] * 5}, "mu is of shape|J has 12 rows"),
        ({"free": [0] * 5 + [np.nan]}, "free 5 is not finite"),
        ({"free": [[0.0] * 6]}, "free must be a vector"),
        ({"offset": np.nan}, "offset"),
        ({"restitution": 1.5}, "from 0 to 1"),
        ({"start": [0.0]}, "start has 1 impulses"),
        ({"dimension": 4}, "dimension is 4"),
        ({"dimension": None}, "say dimension=2 or dimension=3"),
        ({"tolerance": -1.0}, "tolerance"),
        ({"scale": np.inf}, "scale"),
    ],
)
def test_bad_input(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ds.ContactError, match=message):
        contact.solve(**(block(0.3) | {"dimension": 3} | change))


def test_rows_without_zeros_do_not_take_all_memory() -> None:
    """Newton's matrix of so many would take many gigabytes; without it there are sweeps."""
    random = np.random.default_rng(5)
    contacts, unknowns = 1000, 1200
    J = random.normal(size=(2 * contacts, unknowns))
    found = ds.contact.solve(np.ones(unknowns), J, 0.5, random.normal(size=unknowns), dimension=2)
    assert found.newton_steps == 0
    assert found.sweeps > 0
    assert np.isfinite(found.error)
