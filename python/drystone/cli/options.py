"""Arguments and options that commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from drystone.cli import completion
from drystone.common import cones

File = Annotated[
    str,
    typer.Argument(
        metavar="SCENE",
        help="A scene file, [bold]-[/] for standard input, or a built-in scene with its "
        "parameters: [bold]column:50[/], [bold]random_stack:84,seed=3[/].",
        autocompletion=completion.scenes,
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")]
Picture = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--output",
        help="Write a picture (.svg, .pdf, .png), a page that plays what moves (.html), or what "
        "--json prints (.json).",
    ),
]
Blocks = Annotated[
    str | None, typer.Option(help="Ask about these blocks only: names separated by commas.")
]
Block = Annotated[
    list[str] | None,
    typer.Option(help="The same for one name, which may hold commas; may be repeated."),
]
Facets = Annotated[
    int, typer.Option(min=3, help="In space: edges of the pyramids that stand for friction cones.")
]
ConeOfCheck = Annotated[
    cones.ConeOfCheck,
    typer.Option(
        help="In space: round friction cones (exact), or pyramids within them, around them, or "
        "both."
    ),
]
Cone = Annotated[
    cones.Cone,
    typer.Option(help="In space: round friction cones (exact), or pyramids within or around them."),
]
Pyramid = Annotated[
    cones.Pyramid,
    typer.Option(help="In space: pyramids within or around the round friction cones."),
]
