"""A scene as a recording of one frame: what it looks like, overlapping bodies in red."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from drystone.common.text import place, shown
from drystone.common.units import quantity
from drystone.recording.contract import FALLING, PRESENT
from drystone.recording.recording import Recording
from drystone.report.overlaps import names_in, said, titled

if TYPE_CHECKING:
    from drystone.scene import Load, Scene


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
        loads=scene.loads,
        captions=[(0, "Red blocks overlap." if overlaps else "The scene as it is given.")],
        notes=[
            *(f"Overlap of {line}." for line in said(overlaps)),
            *(_said_of_load(load) for load in scene.loads),
        ],
    )


def _said_of_load(load: Load) -> str:
    """How large it is, whereto, and on what."""
    size = math.hypot(*load.force)
    parts = []
    if size > 0:
        way = place((x / size for x in load.force), 3)
        parts.append(f"{quantity(size, 'N')} towards {way}")
    moment = load.moment if isinstance(load.moment, tuple) else (load.moment,)
    if any(moment):
        parts.append(f"a moment of {quantity(math.hypot(*moment), 'N m')}")
    return f"Load {shown(load.name)} on {shown(load.body)}: {' and '.join(parts) or 'nothing'}."
