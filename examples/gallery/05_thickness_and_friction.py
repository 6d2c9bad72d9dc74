"""How thin may an arch be?

For each coefficient of friction the least thickness at which an arch of 21 stones stands, by
bisection: some hundred verdicts. Below a friction of 0.31 it falls however thick it is.
"""

import matplotlib.pyplot as plt
import numpy as np

import drystone as ds


def least_thickness(friction: float) -> float:
    thin, thick = 0.05, 0.6
    while thick - thin > 1e-3:
        middle = (thin + thick) / 2
        stands = ds.check(ds.scenes.arch(21, middle, friction)).stable
        thin, thick = (thin, middle) if stands else (middle, thick)
    return thick


frictions = np.linspace(0.32, 0.8, 13)
figure, axes = plt.subplots(figsize=(6, 3))
axes.plot(frictions, [least_thickness(mu) for mu in frictions], "o-")
axes.set(xlabel="coefficient of friction", ylabel="least thickness / mean radius", ylim=0)
figure.savefig("05_thickness_and_friction.svg")
