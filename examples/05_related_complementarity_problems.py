"""A sequence of growing LCPs, each started from the solution of the one before."""

import numpy as np

from drystone import lcp

rng = np.random.default_rng(0)
n = 60
B = rng.standard_normal((n, n))
M, q = B.T @ B, rng.standard_normal(n)

fresh = reused = 0
start = None
for k in range(1, n + 1):
    part = M[:k, :k], q[:k]
    fresh += lcp.solve(*part).pivots
    solution = lcp.solve(*part, start=start)
    assert solution.status == "solved"
    assert solution.recheck(*part) <= 1e-9
    reused += solution.pivots
    start = solution.start(range(k))
print(f"{n} problems: {fresh} pivots from scratch, {reused} with reuse")
