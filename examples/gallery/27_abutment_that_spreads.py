"""An abutment that spreads

The right abutment of an arch goes outwards by two centimetres. Three hinges open; the thrust
becomes the least that holds the arch. Displacements are drawn larger than they are.
"""

import drystone as ds

whole = ds.scenes.arch(voussoirs=20, thickness=0.2, friction=0.7)
arch = ds.Scene(friction=0.7)
for name, x in (("left", -1), ("right", 1)):
    arch.add_box((x, -0.125), (0.6, 0.25), name=name, fixed=True)
for stone in whole.bodies:
    if not stone.fixed:
        arch.add_polygon(stone.vertices, name=stone.name)
arch.add_settlement("right", (0.02, 0))
ds.check(arch).settled.draw("27_abutment_that_spreads.svg")
