"""Which way does a block leave?

With `clear_path=True` every block leaves along a straight line, past all that remain. The jaw
goes up first; only then can the tongue leave to the right.
"""

import drystone as ds

scene = ds.Scene(friction=0.5)
scene.add_box((0, -0.5), (8, 1), name="floor", fixed=True)
scene.add_polygon([(-3, 0), (-1, 0), (-0.5, 1), (-3, 1)], name="wall", fixed=True)
scene.add_polygon([(1, 0), (3, 0), (3, 0.5), (0.75, 0.5)], name="jaw")
scene.add_polygon([(-1, 0), (1, 0), (0.5, 1), (-0.5, 1)], name="tongue")
ds.plan(scene, clear_path=True).draw("11_ways_out.svg")
