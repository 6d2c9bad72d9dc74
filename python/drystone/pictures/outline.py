"""The outline of what is seen of a body: the convex hull of points in the picture."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def outline(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """The corners of the hull of points (n, 2), counter-clockwise, by Andrew's monotone chains.

    Points on its sides are no corners.

    >>> outline(np.array([[0.0, 0], [2, 0], [1, 0], [1, 0.5], [2, 2], [0, 2], [1, 1]]))
    array([[0., 0.],
           [2., 0.],
           [2., 2.],
           [0., 2.]])
    """
    order = np.lexsort((points[:, 1], points[:, 0]))
    along = [(float(x), float(y)) for x, y in points[order]]
    return np.array(_chain(along)[:-1] + _chain(along[::-1])[:-1])


def _chain(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Those of points in a sorted order that one passes on the right hand, turning left only."""
    chain: list[tuple[float, float]] = []
    for x, y in points:
        while len(chain) > 1:
            (ax, ay), (bx, by) = chain[-2:]
            if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0:
                break
            chain.pop()
        chain.append((x, y))
    return chain
