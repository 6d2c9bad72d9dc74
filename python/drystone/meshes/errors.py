"""A mesh that cannot be a rigid body."""

from drystone._core import SceneError


class MeshError(SceneError):
    """A mesh cannot be used; the text names it, says why, and what to do."""


class MeshWarning(UserWarning):
    """A mesh was mended; the text names it and says how."""
