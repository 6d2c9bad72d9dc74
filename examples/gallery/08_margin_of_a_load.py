"""How hard may the truck brake?

A pallet with a box on it. Inside the curve are the horizontal accelerations, in parts of g, that
the load bears; it is weakest towards the side where the box overhangs.
"""

import matplotlib.pyplot as plt

import drystone as ds

truck = ds.Scene(dimension=3, friction=0.6)
truck.add_box((0, 0, -0.5), (3, 3, 1), name="truck", fixed=True)
truck.add_box((0, 0, 0.6), (1.0, 0.8, 1.2), name="pallet")
truck.add_box((0.2, 0.1, 1.5), (0.5, 0.5, 0.6), name="box", density=3.0)
margin = ds.margin(truck)
figure, axes = plt.subplots(figsize=(4, 4))
axes.fill(*margin.boundary.T, alpha=0.3)
x, y = margin.direction[:2]
axes.plot([margin.acceleration * x], [margin.acceleration * y], "o", label="weakest")
axes.set(aspect="equal", xlabel="force along x (g)", ylabel="force along y (g)")
axes.legend()
figure.savefig("08_margin_of_a_load.svg")
