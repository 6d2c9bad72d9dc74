"""Arguments and options that commands share, and the words that some of them take."""

from __future__ import annotations

from enum import Enum
from pathlib import Path
from typing import Annotated

import typer

File = Annotated[
    str,
    typer.Argument(
        metavar="SCENE",
        help="A scene file, or a built-in scene with its parameters: "
        "[bold]column:50[/], [bold]random_stack:84,seed=3[/].",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")]
Picture = Annotated[
    Path | None, typer.Option("-o", "--output", help="Write a picture, .svg or .png.")
]


Blocks = Annotated[str | None, typer.Option(help="Only these blocks, names separated by commas.")]
Block = Annotated[
    list[str] | None, typer.Option(help="One of them, its name as it is; to be repeated.")
]


class StabilityTest(str, Enum):
    """The stability tests of `plan`."""

    reuse = "reuse"
    reuse_dantzig = "reuse-dantzig"
    lcp = "lcp"
    lp = "lp"
    lp_warm = "lp-warm"


class Reuse(str, Enum):
    """What a step of `simulate` takes over."""

    full = "full"
    motionless = "motionless"
    none = "none"


class Formulation(str, Enum):
    """What the unknowns of a step of `simulate` are."""

    velocity = "velocity"
    acceleration = "acceleration"


class Cone(str, Enum):
    """Friction cones in space, within or around the round ones."""

    inscribed = "inscribed"
    circumscribed = "circumscribed"


class ConeOfLimit(str, Enum):
    """Those of `limit` and `margin`."""

    round = "round"
    inscribed = "inscribed"
    circumscribed = "circumscribed"


class LoadsOfMargin(str, Enum):
    """What permanent loads do under `margin`."""

    stay = "stay"
    turn = "turn"


class ConeOfCheck(str, Enum):
    """Those of `check`."""

    round = "round"
    inscribed = "inscribed"
    circumscribed = "circumscribed"
    both = "both"


class WhichForces(str, Enum):
    """Which contact forces `check` shows."""

    canonical = "canonical"
    any = "any"


Facets = Annotated[int, typer.Option(min=3, help="In space: edges of a friction cone.")]


class Engine(str, Enum):
    """Where the scenes of a folder are planned."""

    threads = "threads"
    ray = "ray"


class Up(str, Enum):
    """Axes that may point up in a file."""

    y = "y"
    z = "z"


class Joints(str, Enum):
    """What is done with joints that turn or slide."""

    error = "error"
    fixed = "fixed"


class Split(str, Enum):
    """What of a mesh file becomes a body."""

    objects = "objects"
    groups = "groups"
    none = "none"
