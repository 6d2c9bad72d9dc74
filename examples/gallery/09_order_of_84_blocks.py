"""In which order can it be taken apart?

A random heap of 84 blocks. The colour of a block is its place in an order in which what is left
always stands.
"""

import drystone as ds

ds.plan(ds.scenes.random_stack(84)).draw("09_order_of_84_blocks.svg")
