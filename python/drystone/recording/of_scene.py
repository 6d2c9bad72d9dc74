"""A scene as a recording of one frame: what it looks like, overlapping bodies in red."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drystone.recording.contract import FALLING, PRESENT
from drystone.recording.recording import Recording
from drystone.report.overlaps import names_in, said, titled

if TYPE_CHECKING:
    from drystone.scene import Scene


def scene_recording(scene: Scene) -> Recording:
    """One frame with every body; the notes name the pairs that overlap, and how deep."""
    overlaps = scene.overlaps
    red = names_in(overlaps)
    states = [[FALLING if name in red else PRESENT for name in scene.names]]
    title, _ = titled(scene, overlaps)
    return Recording(
        kind="plan",
        title=title,
        bodies=scene.bodies,
        states=np.array(states, dtype=np.uint8).reshape(1, len(scene)),
        gravity=scene.gravity,
        captions=[(0, "Red blocks overlap." if overlaps else "The scene as it is given.")],
        notes=[
            *(f"Overlap of {line}." for line in said(overlaps)),
            *(f"Load {load.name}: {load.force} N on {load.body}." for load in scene.loads),
        ],
    )
