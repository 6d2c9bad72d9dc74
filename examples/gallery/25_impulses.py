"""The impulses of one step

A block slides to the right on two corners. Friction slows it down, so the corner in front presses
harder. The numbers are those of the guide's page on one step's contact problem.
"""

import matplotlib.pyplot as plt
import numpy as np

from drystone import contact

M = np.diag([2.0, 2.0, 0.1])
J = np.array([[0, 1, -0.3], [-1, 0, -0.2], [0, 1, 0.3], [-1, 0, -0.2]])
step = contact.solve(M, J, mu=[0.5, 0.5], free=[1.0, -0.0981, 0.0])
normal, tangent = step.impulses.reshape(-1, 2).T
figure, axes = plt.subplots(figsize=(6, 2.6))
axes.fill([-0.3, 0.3, 0.3, -0.3], [-0.2, -0.2, 0.2, 0.2], color="#ddd6c8", ec="#23272b")
axes.axhline(-0.2, color="#8a9097")
axes.quiver([-0.3, 0.3], [-0.2, -0.2], -tangent, normal, color="#1f6fb2", scale=0.8)
axes.quiver([0.35], [0], [0.2], [0], color="#b8321a", scale=2)
axes.text(0.38, 0.06, "slides", color="#b8321a")
axes.set(aspect="equal", xlim=(-0.8, 0.8), ylim=(-0.3, 0.3))
axes.set_axis_off()
figure.savefig("25_impulses.svg")
