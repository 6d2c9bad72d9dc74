"""A plank that leans too far

Red falls, the dashed outline shows how it begins to, and the arrow is the acceleration of its
middle.
"""

import drystone as ds

scene = ds.Scene(friction=0.5)
scene.add_box((0, 0.5), (1, 1), name="pier", fixed=True)
scene.add_box((0.6, 1.1), (2, 0.2), name="plank")
ds.check(scene).draw("01_plank_falls.svg")
