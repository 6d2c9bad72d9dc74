"""Exact contact dynamics of stacked and assembled rigid bodies, with computation reuse.

`import drystone` costs next to nothing: a name below is loaded when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from drystone.common import later

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
    from drystone.common.errors import StaticsError
    from drystone.common.extras import MissingExtraError
    from drystone.equilibrium.contact_force import ContactForce, ContactForces
    from drystone.equilibrium.limits import Limit, LimitEnd, limit
    from drystone.equilibrium.load_cases import LoadCases, load_cases
    from drystone.equilibrium.margins import Margin, margin
    from drystone.equilibrium.settled import Joint, Settled
    from drystone.equilibrium.strong import Escape
    from drystone.equilibrium.structure import Structure
    from drystone.equilibrium.verdict import Verdict, check
    from drystone.many import EngineError, ManyPlans, ScenePlan, plan_many
    from drystone.motion.run import Run
    from drystone.motion.simulation import simulate
    from drystone.motion.world import StepRecord, World
    from drystone.planning.answer import Blocked, Move, Plan, TestRecord
    from drystone.planning.search import plan
    from drystone.scene import Body, Contact, Load, Piece, Scene, Settlement, Solid

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
    "Escape",
    "Joint",
    "LcpError",
    "Limit",
    "LimitEnd",
    "Load",
    "LoadCases",
    "ManyPlans",
    "Margin",
    "MissingExtraError",
    "Move",
    "Piece",
    "Plan",
    "Run",
    "Scene",
    "SceneError",
    "ScenePlan",
    "Settled",
    "Settlement",
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
    "load_cases",
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
    "Blocked": "drystone.planning.answer",
    "Move": "drystone.planning.answer",
    "Body": "drystone.scene",
    "BusyError": "drystone._core",
    "Contact": "drystone.scene",
    "ContactError": "drystone._core",
    "ContactForce": "drystone.equilibrium.contact_force",
    "ContactForces": "drystone.equilibrium.contact_force",
    "DrystoneError": "drystone._core",
    "EngineError": "drystone.many",
    "Escape": "drystone.equilibrium.strong",
    "Joint": "drystone.equilibrium.settled",
    "LcpError": "drystone._core",
    "Limit": "drystone.equilibrium.limits",
    "LimitEnd": "drystone.equilibrium.limits",
    "Load": "drystone.scene",
    "LoadCases": "drystone.equilibrium.load_cases",
    "ManyPlans": "drystone.many",
    "Margin": "drystone.equilibrium.margins",
    "MissingExtraError": "drystone.common.extras",
    "Piece": "drystone.scene",
    "Plan": "drystone.planning.answer",
    "Run": "drystone.motion.run",
    "Scene": "drystone.scene",
    "SceneError": "drystone._core",
    "ScenePlan": "drystone.many",
    "Settled": "drystone.equilibrium.settled",
    "Settlement": "drystone.scene",
    "SimulationError": "drystone._core",
    "Solid": "drystone.scene",
    "StartError": "drystone._core",
    "StaticsError": "drystone.common.errors",
    "Structure": "drystone.equilibrium.structure",
    "StepError": "drystone._core",
    "StepRecord": "drystone.motion.world",
    "TestRecord": "drystone.planning.answer",
    "Verdict": "drystone.equilibrium.verdict",
    "World": "drystone.motion.world",
    "__version__": "drystone._core",
    "check": "drystone.equilibrium.verdict",
    "limit": "drystone.equilibrium.limits",
    "load_cases": "drystone.equilibrium.load_cases",
    "margin": "drystone.equilibrium.margins",
    "plan": "drystone.planning.search",
    "plan_many": "drystone.many",
    "simulate": "drystone.motion.simulation",
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


# Who does what scenes and answers offer by the means of later rooms.
later.figure.done_by(lambda: import_module("drystone.pictures").figure_of)
later.save_figure.done_by(lambda: import_module("drystone.pictures").save)
later.svg_of.done_by(lambda: import_module("drystone.pictures").svg)
later.draw_on.done_by(lambda: import_module("drystone.pictures").draw_on)
later.film.done_by(lambda: import_module("drystone.pictures").save_film)
later.show.done_by(lambda: import_module("drystone.viewer").show_thing)
later.page.done_by(lambda: import_module("drystone.viewer").page_of)
later.table.done_by(lambda: import_module("drystone.report.tables").table_of)
later.imported.done_by(lambda: import_module("drystone.imports").load)
later.advice.done_by(lambda: import_module("drystone.imports.foreign").advice)
later.lies.done_by(lambda: import_module("drystone.imports.foreign").lies)
