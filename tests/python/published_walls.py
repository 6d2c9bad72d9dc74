"""Walls whose limits others have published.

M. C. Ferris and F. Tin-Loi, Limit analysis of frictional block assemblies as a mathematical program
with complementarity constraints, Int. J. Mech. Sci. 43 (2001), 209-224: six walls of bricks of
4 x 1.75 in running bond, half bricks at their ends and beside openings, friction .65 at all joints,
no cohesion; each brick is pushed sideways by a multiple of its weight. Taken up by M. Gilbert,
C. Casapulla and H. M. Ahmed, Computers and Structures 84 (2006), 873-887.
"""

from __future__ import annotations

import drystone as ds

LENGTH, HEIGHT, FRICTION = 4.0, 1.75, 0.65

PUBLISHED = {1: 0.64, 2: 0.58}
"""Limit factors with the associated flow rule, to the digits that we have a source for."""

# Courses from the ground up; each entry is a brick of so many lengths, or an opening if negative.
_HALVES = [0.5, 1, 1, 1, 1, 0.5]
_WHOLES = [1] * 5
_WINDOWS_3 = [[0.5, 1, -1, 1, 0.5], [1, 0.5, -1, 0.5, 1]]
_WINDOWS_4 = [[1, -1, 1, -1, 1], [0.5, 0.5, -1, 0.5, 0.5, -1, 0.5, 0.5]]
_WINDOWS_5 = [[1, -1, 1], [0.5, 0.5, -1, 0.5, 0.5]]
_WINDOWS_6 = [[0.5, 1, -1, 1, 1, -1, 1, 0.5], [1, 0.5, -1, 0.5, 1, 0.5, -1, 0.5, 1]]


def _storey(windows: list[list[float]]) -> list[list[float]]:
    """Five courses with openings."""
    first, second = windows
    return [first, second, first, second, first]


def _courses(wall: int) -> list[list[float]]:
    if wall in (1, 2):
        return [_HALVES, _WHOLES] * (3 if wall == 1 else 5)
    if wall == 3:
        whole, half = [1.0] * 4, [0.5, 1, 1, 1, 0.5]
        return [whole, half, whole, *_storey(_WINDOWS_3), whole, half, whole]
    if wall == 4:
        band = [_HALVES, _WHOLES, _HALVES]
        return [*band, *_storey(_WINDOWS_4), *band]
    if wall == 5:
        half, whole = [0.5, 1, 1, 0.5], [1.0] * 3
        band, storey = [half, whole, half], _storey(_WINDOWS_5)
        return [*band, *storey, *band, *storey, *band]
    half, whole = [0.5, *[1.0] * 6, 0.5], [1.0] * 7
    storey = _storey(_WINDOWS_6)
    between = [whole, half, whole]
    return [half, *between, *storey, *between, *storey, *between, half]


def published_wall(wall: int) -> ds.Scene:
    """One of the six."""
    scene = ds.Scene(friction=FRICTION)
    width = LENGTH * sum(_courses(wall)[0])
    scene.add_box((width / 2, -HEIGHT / 2), (width, HEIGHT), name="ground", fixed=True)
    for level, course in enumerate(_courses(wall)):
        left = 0.0
        for share in course:
            size = abs(share) * LENGTH
            if share > 0:
                scene.add_box((left + size / 2, (level + 0.5) * HEIGHT), (size, HEIGHT))
            left += size
    return scene
