"""What a worker does: the text of a scene in, the text of an answer out.

Both are JSON, so that a worker shares nothing with the caller but this function's name.
"""

from __future__ import annotations

import hashlib
import json
import os
import socket
from dataclasses import asdict, dataclass
from typing import Any

from drystone import _core
from drystone.common.cones import FACETS, INSCRIBED, Pyramid
from drystone.planning.answer import Plan
from drystone.planning.search import OrderOfPlan, Progress, StabilityTest, plan
from drystone.scene import Scene


@dataclass(frozen=True, slots=True)
class Settings:
    """Everything but the scene that a plan depends on."""

    test: StabilityTest
    node_limit: int | None
    time_limit: float | None
    shortcuts: bool
    hold: int = 0
    clear_path: bool = False
    directions: tuple[tuple[float, ...], ...] = ()
    margin: float = 0.0
    order: OrderOfPlan = "any"
    moves: int = 1
    together: int = 1
    obstacles: str | None = None
    """The text of a scene."""
    facets: int = FACETS
    cone: Pyramid = INSCRIBED
    drystone: str = _core.__version__
    """Another version may find another order."""

    def checked(self) -> Settings:
        """The settings; ValueError or SceneError if `plan` would refuse them for any scene."""
        lengths = {len(way) for way in self.directions}
        if lengths - {2, 3} or len(lengths) > 1:
            raise ValueError(
                "directions must all have two numbers, for scenes in the plane, or three, in space"
            )
        dimensions = self._dimensions(self._obstacles())
        if len(set(dimensions.values())) > 1:
            raise ValueError("directions and obstacles are not of the same dimension")
        flat = Scene._of(_core.Scene.built_in("column", {"n": 1}))
        for scene in (flat, flat.extruded()):
            if all(dimension == scene.dimension for dimension in dimensions.values()):
                self.plan(scene, None)
        return self

    def _dimensions(self, obstacles: Scene | None) -> dict[str, int]:
        """Of what is for scenes in the plane, or in space, only."""
        ways = {"directions": len(self.directions[0])} if self.directions else {}
        return ways if obstacles is None else {**ways, "obstacles": obstacles.dimension}

    def _obstacles(self) -> Scene | None:
        if self.obstacles is None:
            return None
        return Scene._of(_core.Scene.from_json(self.obstacles, "obstacles"))

    def plan(self, scene: Scene, progress: Progress | None) -> Plan:
        """The plan of `scene` under these settings."""
        obstacles = self._obstacles()
        for what, dimension in self._dimensions(obstacles).items():
            if dimension != scene.dimension:
                raise _core.SceneError(
                    f"{what} have {dimension} dimensions, and this scene {scene.dimension}: "
                    "plan scenes in the plane and in space apart"
                )
        return plan(
            scene,
            self.test,
            self.node_limit,
            self.time_limit,
            progress,
            self.shortcuts,
            1,  # thread: every core has a scene of its own
            self.hold,
            self.clear_path,
            self.directions or None,
            margin=self.margin,
            order=self.order,
            moves=self.moves,
            together=self.together,
            obstacles=obstacles,
            facets=self.facets,
            cone=self.cone,
        )

    def to_dict(self) -> dict[str, Any]:
        """In types that JSON knows; of the obstacles the SHA-256 of their scene's text."""
        obstacles = self.obstacles
        return {
            **asdict(self),
            "directions": [list(way) for way in self.directions],
            "obstacles": None if obstacles is None else _sha256(obstacles),
        }


def plan_text(text: str, source: str, settings: Settings, progress: Progress | None = None) -> str:
    """Plan the scene of a scene file's text.

    The answer is a JSON object: `state`, `worker`, and `plan` or `error`. An exception raised by
    `progress` comes through; everything else that goes wrong is in the answer.
    """
    try:
        _same_version(settings)
        scene = Scene._of(_core.Scene.from_json(text, source))
        answer = {"state": "planned", "plan": settings.plan(scene, progress).to_dict()}
    except StoppedError:
        raise
    except _core.SceneError as error:
        answer = failure("bad_input", error)
    except Exception as error:
        answer = failure("failed", error)
    return json.dumps({**answer, "worker": f"{socket.gethostname()}:{os.getpid()}"})


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _same_version(settings: Settings) -> None:
    if settings.drystone != _core.__version__:
        raise RuntimeError(
            f"drystone here is {_core.__version__}, the caller's is {settings.drystone}: "
            "install the same version on every machine"
        )


def failure(state: str, error: BaseException) -> dict[str, Any]:
    """An answer without a plan."""
    return {"state": state, "error": {"type": type(error).__name__, "message": str(error)}}


class StoppedError(Exception):
    """The caller wants no more answers."""
