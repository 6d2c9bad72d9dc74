"""An arch of compas_dem with a load at its quarter. Does it stand, how much more does it bear, and
in which order can it be built?

    pip install compas_drystone "drystone[pictures]"
    python arch.py arch.svg
"""

from __future__ import annotations

import sys

from compas_dem.material import Stone
from compas_dem.models import BlockModel
from compas_dem.problem import Problem
from compas_dem.templates import ArchTemplate

import drystone as ds
from compas_drystone import Drystone, drystone_sequence, push_of, scene_of

arch = ArchTemplate(rise=3.0, span=8.0, thickness=0.6, depth=1.0, n=20)
model = BlockModel.from_template(arch)
model.add_supports([0, 19])
stone = Stone(density=2000, name="limestone")
model.add_material(stone)
model.assign_material(stone, elements=list(model.elements()))

problem = Problem(model)
problem.set_contact_model("MohrCoulomb", mu=0.7)
live = problem.add_boundary_condition("Live")
live.add_point_load(6, [0, 0, -1000.0])

problem.set_solver(Drystone(verbose=True))
results = problem.solve()
x, _, z = results.resultant_global((9, 10))
print(f"At the crown: {abs(x) / 1000:.1f} kN of thrust, {abs(z) / 1000:.1f} kN of shear.")

problem.set_solver(Drystone(live="Live"))
results = problem.solve()
print(f"The load may be {results.metadata['limit']:.1f} times as large.")

print(drystone_sequence(problem, hold=1))

if len(sys.argv) > 1:
    scene = scene_of(problem, live="Live")
    push, _ = push_of(problem, scene, "Live")
    ds.limit(scene, push).save(sys.argv[1])
