"""What a simulator is: something that moves a scene and says how long its steps took."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import drystone as ds


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """A scene simulated once."""

    seconds: float
    """All steps, and nothing but the steps: no set-up, no recording."""
    frames: NDArray[np.float64]
    """(k, n, 6): x, y (m), angle (rad) and their rates, at first and every so many steps. In space
    (k, n, 13): x, y, z, a unit quaternion (w, x, y, z), m/s, and rad/s along the world's axes."""
    stopped: str = ""
    """Why it did not get to the end; empty if it did."""
    worst: float = math.nan
    """Seconds of the slowest step; NaN where steps are not timed one by one."""
    not_exact: int = 0
    """Steps that say so themselves."""


Velocities = Mapping[str, Sequence[float]]
"""At the beginning, of the bodies that are not at rest, by name: m/s, m/s, rad/s."""


class Simulator(ABC):
    """A way to move a scene."""

    name: str
    """In tables and results."""
    dimensions: tuple[int, ...] = (2,)
    """Of the scenes that it can move."""

    @abstractmethod
    def version(self) -> str:
        """The version measured; empty if it is not installed."""

    @abstractmethod
    def missing(self) -> str:
        """What has to be installed for it; empty if it is there."""

    def prepare(self) -> None:
        """Whatever must be done once before it can run."""
        return

    @abstractmethod
    def run(
        self,
        scene: ds.Scene,
        dt: float,
        steps: int,
        every: int,
        velocities: Velocities | None = None,
    ) -> Motion:
        """Make `steps` steps of `dt` seconds, and look at the bodies after each `every`. With
        `velocities`, which are for the plane only, some bodies move at the beginning."""
