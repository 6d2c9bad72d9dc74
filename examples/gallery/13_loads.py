"""Loads beside the weight

A statue on block 5 and a pressure on block 4 (purple), as a part of the scene: every question
takes them into account.
"""

import drystone as ds

scene = ds.scenes.five_blocks()
scene.add_load("5", force=(0, -50), at=(0.2, 2.2), name="statue")
scene.add_pressure("4", (0, 1), 20.0)
ds.check(scene).draw("13_loads.svg")
