"""How far over the edge?

Nine blocks, each one half of 1/k of its length further out than the one below: in all H(9) / 2 =
1.41 lengths. A little more, and it falls.
"""

import drystone as ds

ds.check(ds.scenes.harmonic_stack(9, overhang_factor=0.99)).draw("16_overhang.svg")
