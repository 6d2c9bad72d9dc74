"""The same arch in space

Any scene in the plane can be given a thickness. Contacts are then whole faces, and friction cones
are round.
"""

import drystone as ds

arch = ds.scenes.arch(voussoirs=11, thickness=0.3).extruded(0.6)
ds.check(arch).draw("18_arch_in_space.svg")
