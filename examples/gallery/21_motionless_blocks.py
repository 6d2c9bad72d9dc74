"""What moves, and what does not

A column, 1.75 s after its two upper blocks began to fall: dark bodies have not moved, not by a
bit.
"""

from pathlib import Path

import drystone as ds

run = ds.simulate(ds.scenes.falling_column(), steps=420)
[frame] = run.view().save_frames(".", [420], suffix=".svg")
Path(frame).replace("21_motionless_blocks.svg")
