"""Blocks that overlap

Rigid blocks cannot: there is no verdict, and the picture shows where, and how deep.
"""

import drystone as ds

scene = ds.Scene()
scene.add_box((0, 0), (1, 1), name="a")
scene.add_box((0.75, 0.3), (1, 1), name="b")
scene.draw("14_overlap.svg")
