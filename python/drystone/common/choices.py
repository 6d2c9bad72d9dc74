"""Words that importers and the command line take alike: without what importers need to work."""

from typing import Literal, TypeAlias

Up: TypeAlias = Literal["y", "z"]
"""The axis that points up in a file."""

Joints: TypeAlias = Literal["error", "fixed"]
"""What is done with joints that turn or slide: refused, or welded."""

Split: TypeAlias = Literal["objects", "groups", "none"]
"""What of a mesh file becomes a body."""
