"""A wall with a gap

The lintel carries the bricks above the opening; the forces go around it.
"""

import drystone as ds

wall = ds.scenes.wall(rows=7, columns=5, friction=0.7)
opening = [b.name for b in wall.bodies if abs(b.centroid[0] - 2.5) < 0.8 and b.centroid[1] < 1.6]
left = [b.name for b in wall.bodies if not b.fixed and b.name not in opening]
ds.check(wall, left).draw("17_paths_of_load.svg")
