"""What a worker does: the text of a scene in, the text of an answer out.

Both are JSON, so that a worker shares nothing with the caller but this function's name.
"""

from __future__ import annotations

import json
import os
import socket
from dataclasses import asdict, dataclass
from typing import Any

from drystone import _core
from drystone.planning.answer import Plan
from drystone.planning.search import Progress, StabilityTest, plan
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
    drystone: str = _core.__version__
    """Another version may find another order."""

    def checked(self) -> Settings:
        """The settings; ValueError or SceneError if `plan` would refuse them for any scene."""
        lengths = {len(way) for way in self.directions}
        if lengths - {2, 3} or len(lengths) > 1:
            raise ValueError(
                "directions must all have two numbers, for scenes in the plane, or three, in space"
            )
        flat = Scene._of(_core.Scene.built_in("column", {"n": 1}))
        self.plan(flat.extruded() if lengths == {3} else flat, None)
        return self

    def plan(self, scene: Scene, progress: Progress | None) -> Plan:
        """The plan of `scene` under these settings."""
        if self.directions and len(self.directions[0]) != scene.dimension:
            raise _core.SceneError(
                f"directions have {len(self.directions[0])} numbers each, and this scene "
                f"{scene.dimension} dimensions: plan scenes in the plane and in space apart"
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
        )

    def to_dict(self) -> dict[str, Any]:
        """In types that JSON knows."""
        return {**asdict(self), "directions": [list(way) for way in self.directions]}


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
