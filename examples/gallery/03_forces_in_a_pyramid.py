"""The forces in a pyramid

Many sets of forces hold a redundant structure up. These have the least norm: there is one such
set, and it is as symmetric as the pyramid.
"""

import drystone as ds

ds.check(ds.scenes.pyramid(5, friction=0.6)).draw("03_forces_in_a_pyramid.svg")
