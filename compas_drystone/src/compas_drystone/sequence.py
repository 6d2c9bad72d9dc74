"""In which order can the blocks of a problem be taken away, or put up?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from compas.data import Data

import drystone as ds
from compas_drystone.scene import scene_of

if TYPE_CHECKING:
    from compas_dem.models import BlockModel
    from compas_dem.problem import Problem


class Sequence(Data):
    """An order in which blocks are taken away so that what is left always stands.

    Parameters
    ----------
    order : list[int]
        Graph nodes, first removed first; empty if there is no order.
    holds : list[list[int]]
        `holds[k]` are the blocks that are held when the first k blocks of `order` are gone.
    status : str
        How the search ended: "found", or as in `drystone.Plan.status`.
    text : str
        The answer in words.
    """

    def __init__(
        self,
        order: list[int],
        holds: list[list[int]],
        status: str = "found",
        text: str = "",
        name: str | None = None,
    ) -> None:
        super().__init__(name=name)
        self.order = order
        self.holds = holds
        self.status = status
        self.text = text

    @property
    def __data__(self) -> dict[str, Any]:
        return {"order": self.order, "holds": self.holds, "status": self.status, "text": self.text}

    @property
    def found(self) -> bool:
        return self.status == "found"

    @property
    def assembly_order(self) -> list[int]:
        """First put up first."""
        return self.order[::-1]

    def step(self, k: int) -> dict[str, list[int]]:
        """What is there when the first k blocks are gone: `blocks` and `held`, for `Drystone`."""
        if not 0 <= k <= len(self.order):
            raise ValueError(f"step {k} of a sequence of {len(self.order)} blocks")
        held = self.holds[k] if k < len(self.holds) else []
        return {"blocks": self.order[k:], "held": held}

    def __str__(self) -> str:
        return self.text or super().__str__()


def drystone_sequence(
    problem: Problem,
    model: BlockModel | None = None,
    *,
    mu: float | None = None,
    density: float | None = None,
    tolerance: float | None = None,
    **options: Any,
) -> Sequence:
    """Plan in which order a structure can be taken apart; read backwards, be built.

    `mu`, `density` and `tolerance` are as in `scene_of`, `options` those of `drystone.plan`:
    `hold=1` for a hand or a prop, `clear_path=True` for straight ways out, `margin=0.05` for steps
    that bear an acceleration, and others.

    Every boundary condition acts at each step, on the blocks that are there.
    """
    scene = scene_of(problem, model, mu=mu, density=density, tolerance=tolerance)
    plan = ds.plan(scene, **options)
    holds = [[int(name) for name in held] for held in plan.holds] if plan.found else []
    return Sequence([int(name) for name in plan.order], holds, plan.status, str(plan))
