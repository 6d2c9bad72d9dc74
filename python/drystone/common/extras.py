"""Packages that come with an extra: what is missing is one line that says how to install it.

`pip install drystone` brings what answers questions; what draws, reads meshes or compares with
others comes with an extra, as `pyproject.toml` lists them.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec

from drystone._core import DrystoneError

EXTRAS = {
    "pictures": ("matplotlib",),
    "meshes": ("trimesh", "manifold3d", "scipy", "lxml", "networkx"),
    "cad": ("trimesh", "scipy", "cascadio"),
    "lp": ("highspy",),
    "sparse": ("scipy",),
    "ray": ("ray",),
    "all": (
        "matplotlib",
        "trimesh",
        "manifold3d",
        "scipy",
        "lxml",
        "networkx",
        "cascadio",
        "highspy",
        "ray",
    ),
}
"""The packages of each extra."""


class MissingExtraError(DrystoneError, ImportError):
    """A package of an extra is not installed; the text says how to install it."""


@contextmanager
def extra(name: str, what: str) -> Iterator[None]:
    """Around imports for `what` (plural) that the extra `name` brings: MissingExtraError if not."""
    try:
        yield
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if package not in EXTRAS[name]:
            raise
        raise _missing(package, name, what) from None


def require(name: str, what: str) -> None:
    """MissingExtraError unless all packages of an extra are installed; imports none of them."""
    for package in EXTRAS[name]:
        if find_spec(package) is None:
            raise _missing(package, name, what)


def _missing(package: str, name: str, what: str) -> MissingExtraError:
    return MissingExtraError(
        f'{what} need {package}, which is not installed: pip install "drystone[{name}]"',
        name=package,
    )
