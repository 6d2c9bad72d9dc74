"""What is asked about: bodies, their shapes and weights, loads, and where they touch."""

from drystone.scene.adding import Point
from drystone.scene.body import Body, Contact, Piece, Solid, Surface
from drystone.scene.loads import Load
from drystone.scene.near_miss import NearMiss
from drystone.scene.overlaps import Overlap
from drystone.scene.scene import Scene
from drystone.scene.settlements import Settlement
from drystone.scene.weight import Inertia

__all__ = [
    "Body",
    "Contact",
    "Inertia",
    "Load",
    "NearMiss",
    "Overlap",
    "Piece",
    "Point",
    "Scene",
    "Settlement",
    "Solid",
    "Surface",
]
