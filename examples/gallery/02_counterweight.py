"""The same plank with a counterweight

Now it stands. Blue arrows are contact forces, to scale; each shows what a block below does to the
one above it.
"""

import drystone as ds

scene = ds.Scene(friction=0.5)
scene.add_box((0, 0.5), (1, 1), name="pier", fixed=True)
scene.add_box((0.6, 1.1), (2, 0.2), name="plank")
scene.add_box((0, 1.6), (0.8, 0.8), name="counterweight")
ds.check(scene).draw("02_counterweight.svg")
