"""A block on a slope

Its speed after a push, and what Coulomb's law says: g (sin a - mu cos a) t.
"""

from math import cos, radians, sin

import matplotlib.pyplot as plt
import numpy as np

import drystone as ds

angle, mu = radians(30), 0.3
run = ds.simulate(ds.scenes.slope(30, friction=mu, width=2, height=0.5), steps=240)
time = np.arange(0, run.steps + 1) * run.dt
figure, axes = plt.subplots(figsize=(6, 3))
speed = np.hypot(run.velocities[:, 1, 0], run.velocities[:, 1, 1])
axes.plot(time[::16], speed[::16], "o", label="simulated")
axes.plot(time, 9.81 * (sin(angle) - mu * cos(angle)) * time, label="by hand")
axes.set(xlabel="time (s)", ylabel="speed (m/s)")
axes.legend()
figure.savefig("22_sliding_block.svg")
