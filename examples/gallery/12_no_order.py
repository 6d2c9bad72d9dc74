"""When there is no order

The plank falls without the weight, and the weight cannot be put on before the plank. The plan
says so: red is what makes something fall.
"""

import drystone as ds

scene = ds.Scene(friction=0.5)
scene.add_box((0, -0.5), (4, 1), name="ground", fixed=True)
scene.add_box((0, 0.5), (1, 1), name="pier")
scene.add_box((0.6, 1.1), (2, 0.2), name="plank")
scene.add_box((0, 1.6), (0.8, 0.8), name="weight")
ds.plan(scene).draw("12_no_order.svg")
