"""A string over the ground

The example of the guide's page on sequences. At each of its forty points z or w is zero, never
both positive: that is what complementary means.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy import sparse

from drystone import lcp

n = 40
M = sparse.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(n, n))
q = np.where(np.arange(n) < 30, -0.01, 0.2)
solution = lcp.solve(M, q)
figure, axes = plt.subplots(figsize=(6, 2.6))
axes.bar(range(n), solution.z, label="z")
axes.bar(range(n), solution.w, label="w")
axes.set(xlabel="point")
axes.legend()
figure.savefig("26_string_over_the_ground.svg")
