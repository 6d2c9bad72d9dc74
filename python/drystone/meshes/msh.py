"""MuJoCo's own binary mesh files, `.msh`: counts, then vertices, normals, texture and faces."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from drystone.common.extras import extra
from drystone.meshes.errors import MeshError

if TYPE_CHECKING:
    import trimesh


def read_msh(path: Path) -> trimesh.Trimesh:
    """The surface in a file; MeshError if its size is not what its counts say."""
    with extra("meshes", "mesh files"):
        import trimesh

    data = path.read_bytes()
    counts = np.frombuffer(data[:16], dtype="<i4")
    if len(counts) == 4 and counts.min() >= 0:
        vertices, normals, texture, faces = (int(count) for count in counts)
        if len(data) == 16 + 4 * (3 * vertices + 3 * normals + 2 * texture + 3 * faces):
            points = np.frombuffer(data, "<f4", 3 * vertices, 16).reshape(-1, 3)
            corners = np.frombuffer(data, "<i4", 3 * faces, len(data) - 12 * faces)
            return trimesh.Trimesh(points.astype(float), corners.reshape(-1, 3), process=False)
    raise MeshError("it is no .msh of MuJoCo, whose size follows from its counts: export it as OBJ")
