"""An arch at its limit

`limit` finds the greatest load on block 7 that the arch bears, and how it collapses beyond: with
four hinges, where blocks turn about their corners.
"""

import drystone as ds

arch = ds.scenes.arch(voussoirs=20, thickness=0.15, friction=0.7)
ds.limit(arch, push={"7": (0, -1)}).draw("06_arch_at_its_limit.svg")
