"""drystone inside COMPAS: a back end for problems of compas_dem.

>>> from compas_dem.problem import Problem
>>> from compas_drystone import Drystone
>>> problem = Problem(model)                      # doctest: +SKIP
>>> problem.set_solver(Drystone())                # doctest: +SKIP
>>> results = problem.solve()                     # doctest: +SKIP

With this package imported, or found by COMPAS as a plug-in, `Problem.solve` knows the solver.
"""

from __future__ import annotations

from compas_drystone.results import results_of
from compas_drystone.scene import push_of, scene_of
from compas_drystone.sequence import Sequence, drystone_sequence
from compas_drystone.solver import Drystone, drystone_solve

__version__ = "0.1.0"

__all__ = [
    "Drystone",
    "Sequence",
    "drystone_sequence",
    "drystone_solve",
    "push_of",
    "results_of",
    "scene_of",
]

__all_plugins__ = ["compas_drystone.solver"]
