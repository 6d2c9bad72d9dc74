"""The least thickness at which a semicircular arch stands, by bisection.

Milankovitch (1907): 0.1075 of the mean radius for very many voussoirs.
"""

import drystone as ds

thin, thick = 0.05, 0.20
while thick - thin > 1e-4:
    middle = (thin + thick) / 2
    if ds.check(ds.scenes.arch(41, middle, friction=10.0)).stable:
        thick = middle
    else:
        thin = middle
print(f"an arch of 41 voussoirs needs a thickness of {thick:.4f} of its mean radius")

ds.check(ds.scenes.arch(41, thick)).draw("arch.svg")
