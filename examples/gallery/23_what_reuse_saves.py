"""What a kept answer saves

The work to test each structure on the way up a column of 40 blocks: from scratch it grows with
the height, from the answer before it does not.
"""

import matplotlib.pyplot as plt

import drystone as ds

column = ds.scenes.column(40)
figure, axes = plt.subplots(figsize=(6, 3))
for test, label in (("lcp", "from scratch"), ("reuse-dantzig", "from the answer before")):
    records = ds.plan(column, test).records
    axes.plot([r.size for r in records], [r.pivots for r in records], ".-", label=label)
axes.set(xlabel="blocks in the structure", ylabel="pivots")
axes.legend()
figure.savefig("23_what_reuse_saves.svg")
