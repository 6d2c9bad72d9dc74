"""A wall that is tilted

Gravity sideways, in parts of g, until the wall gives way: the right end of every row slides and
turns away.
"""

import drystone as ds

wall = ds.scenes.wall(rows=6, columns=4, friction=0.65)
ds.limit(wall, gravity=(9.81, 0)).draw("07_wall_tilted.svg")
