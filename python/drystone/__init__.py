"""Exact contact dynamics of stacked and assembled rigid bodies, with computation reuse.

`import drystone` costs next to nothing: a name below is loaded when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from drystone import contact, imports, lcp, meshes, scenes, viewer
    from drystone._core import (
        BusyError,
        ContactError,
        DrystoneError,
        LcpError,
        SceneError,
        SimulationError,
        StartError,
        StepError,
        __version__,
    )
    from drystone.body import Body, Contact, Piece, Solid
    from drystone.contact_force import ContactForce, ContactForces
    from drystone.limits import Limit, LimitEnd, limit
    from drystone.loads import Load
    from drystone.many import EngineError, ManyPlans, ScenePlan, plan_many
    from drystone.margins import Margin, margin
    from drystone.plan_answer import Blocked, Plan, TestRecord
    from drystone.planning import plan
    from drystone.scene import Scene
    from drystone.simulation import Run, simulate
    from drystone.statics import StaticsError
    from drystone.structure import Structure
    from drystone.verdict import Verdict, check
    from drystone.world import StepRecord, World

__all__ = [
    "Blocked",
    "Body",
    "BusyError",
    "Contact",
    "ContactError",
    "ContactForce",
    "ContactForces",
    "DrystoneError",
    "EngineError",
    "LcpError",
    "Limit",
    "LimitEnd",
    "Load",
    "ManyPlans",
    "Margin",
    "Piece",
    "Plan",
    "Run",
    "Scene",
    "SceneError",
    "ScenePlan",
    "SimulationError",
    "Solid",
    "StartError",
    "StaticsError",
    "StepError",
    "StepRecord",
    "Structure",
    "TestRecord",
    "Verdict",
    "World",
    "__version__",
    "check",
    "contact",
    "imports",
    "lcp",
    "limit",
    "margin",
    "meshes",
    "plan",
    "plan_many",
    "scenes",
    "simulate",
    "viewer",
]

_MODULES = ("contact", "imports", "lcp", "meshes", "scenes", "viewer")
_HOMES = {
    "Blocked": "drystone.plan_answer",
    "Body": "drystone.body",
    "BusyError": "drystone._core",
    "Contact": "drystone.body",
    "ContactError": "drystone._core",
    "ContactForce": "drystone.contact_force",
    "ContactForces": "drystone.contact_force",
    "DrystoneError": "drystone._core",
    "EngineError": "drystone.many",
    "LcpError": "drystone._core",
    "Limit": "drystone.limits",
    "LimitEnd": "drystone.limits",
    "Load": "drystone.loads",
    "ManyPlans": "drystone.many",
    "Margin": "drystone.margins",
    "Piece": "drystone.body",
    "Plan": "drystone.plan_answer",
    "Run": "drystone.simulation",
    "Scene": "drystone.scene",
    "SceneError": "drystone._core",
    "ScenePlan": "drystone.many",
    "SimulationError": "drystone._core",
    "Solid": "drystone.body",
    "StartError": "drystone._core",
    "StaticsError": "drystone.statics",
    "Structure": "drystone.structure",
    "StepError": "drystone._core",
    "StepRecord": "drystone.world",
    "TestRecord": "drystone.plan_answer",
    "Verdict": "drystone.verdict",
    "World": "drystone.world",
    "__version__": "drystone._core",
    "check": "drystone.verdict",
    "limit": "drystone.limits",
    "margin": "drystone.margins",
    "plan": "drystone.planning",
    "plan_many": "drystone.many",
    "simulate": "drystone.simulation",
}


def __getattr__(name: str) -> Any:
    """Load the module that holds `name` on first use (PEP 562)."""
    if name in _MODULES:
        return import_module(f"drystone.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module 'drystone' has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
