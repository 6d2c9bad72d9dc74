"""Parts with curved surfaces

A ring on a plate with a hole, from meshes. What is curved is not cut into pieces: contacts are
found on the surface itself.
"""

import warnings

import trimesh

import drystone as ds

warnings.simplefilter("ignore", ds.meshes.MeshWarning)  # which says that surfaces are kept
scene = ds.Scene(dimension=3, friction=0.5)
scene.add_mesh(trimesh.creation.annulus(0.3, 1.0, 0.4), name="plate", fixed=True)
ring = trimesh.creation.annulus(0.5, 0.7, 0.3)
scene.add_mesh(ring, name="ring", position=(0.25, 0, 0.35))
ds.check(scene).draw("24_curved_parts.svg")
