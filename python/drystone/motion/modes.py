"""How a run may be made, and how it may end."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, TypeAlias, get_args

Reuse: TypeAlias = Literal["full", "motionless", "none"]
REUSE = get_args(Reuse)
"""What a step may take over from the one before it: see `simulate`."""

Formulation: TypeAlias = Literal["velocity", "acceleration"]
FORMULATIONS = get_args(Formulation)
"""What the unknowns of a step may be: see `simulate`."""

COULOMB_TOLERANCE = 1e-8
"""Steps off Coulomb's law by more than this share of the speeds are not exact: see `simulate`."""

MOST_STEPS = 10**9
"""Steps of one run: it holds all of them in memory."""

ENDINGS = {
    "finished": "Finished",
    "interrupted": "Interrupted",
    "unsolved": "Stopped: a step could not be solved",
    "too_fast": "Stopped: a block turns too fast for the step",
    "out_of_bounds": "Stopped: a block is further away or faster than can be computed",
}
"""What a run's status says."""

Progress = Callable[[int, int], None]
"""Called with (steps made, steps in all) a few times a second."""
