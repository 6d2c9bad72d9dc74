"""The order of a pyramid of cubes

From yellow, taken away first, to violet.
"""

import drystone as ds

ds.plan(ds.scenes.square_pyramid(5)).draw("19_pyramid_in_space.svg")
