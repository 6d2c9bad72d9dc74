"""An arch, with one hand to hold it

Half an arch falls, so nobody can take an arch apart without help. With `hold=1` one block may be
held at a time; the hatched ones are held on the way.
"""

import drystone as ds

ds.plan(ds.scenes.arch(11, thickness=0.3), hold=1).draw("10_arch_with_a_hold.svg")
