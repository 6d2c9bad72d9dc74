"""A bracket of two pieces

A body in space may be made of several convex pieces. The centre of mass of this one is beyond its
foot.
"""

import drystone as ds


def cuboid(x, z, width, height):
    return [(x + i * width, j, z + k * height) for i in (0, 1) for j in (0, 1) for k in (0, 1)]


scene = ds.Scene(dimension=3)
scene.add_box((0.5, 0.5, -0.25), (4, 2, 0.5), name="ground", fixed=True)
scene.add_solid([cuboid(0, 0, 1, 2), cuboid(1, 1, 2, 1)], name="bracket")
ds.check(scene).draw("20_bracket.svg")
