"""`drystone scene NAME`: one command for every function of `drystone.scenes`."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from drystone import _core, scenes
from drystone.cli.errors import InputError
from drystone.cli.flags import App, Group
from drystone.cli.inputs import (
    STANDARD,
    builder_of,
    load_scene,
    neither,
    parameters_of,
    picture_path,
    python_name,
    reporting_files,
    said_of,
)
from drystone.cli.options import File
from drystone.common.files import PAGE, PICTURES
from drystone.scene import Scene


class SceneGroup(Group):
    """`drystone scene FILE` is `drystone scene draw FILE`, and `wall:6` is `wall --rows 6`."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """A word with a suffix is a file, one with a colon a scene with its parameters."""
        name, colon, parameters = args[0].partition(":")
        builder = builder_of(name) if colon else None
        if builder is not None:
            given = parameters_of(builder, parameters)
            options = [f"--{key.replace('_', '-')}={value}" for key, value in given.items()]
            args = [python_name(name), *options, *args[1:]]
        elif self.get_command(ctx, args[0]) is None:
            if not (Path(args[0]).suffix or args[0] == STANDARD):
                raise neither(args[0], python_name(name))
            args = ["draw", *args]
        _refuse_two_values(args[0], args[1:])
        return super().resolve_command(ctx, args)


def _refuse_two_values(name: str, words: list[str]) -> None:
    """The parser would take the last of them."""
    given: dict[str, str] = {}
    following = iter(words)
    for word in following:
        option, equals, value = word.partition("=")
        if option.startswith("--") and option != "--help":
            value = value if equals else next(following, "")
            if option in given:
                raise InputError(
                    f"{name}: {option} has two values, {given[option]} and {value}: give one"
                )
            given[option] = value


scene_app = App(
    cls=SceneGroup,
    help="Write a built-in scene as a scene file, or draw a scene.",
    no_args_is_help=True,
)

Output = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--output",
        help="The scene file to write, or a picture (.svg, .pdf, .png) or page (.html) of it; "
        "without it, or with [bold]-[/], standard output.",
    ),
]


@scene_app.callback(invoke_without_command=True)
def root(
    context: typer.Context,
    every: Annotated[bool, typer.Option("--list", help="List the built-in scenes.")] = False,
) -> int:
    """Write a built-in scene as a scene file, or draw a scene."""
    if every:
        for name in scenes.__all__:
            print(f"{name:18} {_first_line(getattr(scenes, name))}")
    elif context.invoked_subcommand is None:
        print(context.get_help())
    return 0


@scene_app.command("draw")
def draw(
    scene: File,
    output: Annotated[
        Path, typer.Option("-o", "--output", help="A .svg, .pdf, .png or .html to write.")
    ],
) -> int:
    """Draw a scene, with blocks that overlap in red; `draw` may be left out before a file."""
    picture = picture_path(output, PAGE)
    given = load_scene(scene)
    with reporting_files():
        given.draw(picture or output)
    print(said_of(output))
    return 0


def _command(builder: Callable[..., Scene], helps: dict[str, str]) -> Callable[..., int]:
    """A command whose options are the builder's parameters, and `--output`."""

    def write(**options: Any) -> int:
        output: Path | None = options.pop("output")
        scene = builder(**options)
        if output is None or str(output) == STANDARD:
            print(scene.to_json())
            return 0
        drawn = output.suffix.lower() in (*PICTURES, PAGE)
        with reporting_files():
            (scene.draw if drawn else scene.save)(output)
        print(said_of(output) if drawn else f"{len(scene)} bodies written to {output}")
        return 0

    parameters = [
        parameter.replace(
            kind=inspect.Parameter.KEYWORD_ONLY,
            annotation=Annotated[parameter.annotation, typer.Option(help=helps[name])],
        )
        for name, parameter in inspect.signature(builder, eval_str=True).parameters.items()
    ]
    parameters.append(
        inspect.Parameter("output", inspect.Parameter.KEYWORD_ONLY, default=None, annotation=Output)
    )
    write.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    write.__annotations__ = {p.name: p.annotation for p in parameters}
    return write


def _first_line(builder: Callable[..., Scene]) -> str:
    return (builder.__doc__ or "").strip().splitlines()[0]


for _name, _, _parameters in _core.catalogue():
    _builder = getattr(scenes, _name)
    _helps = {parameter: summary for parameter, summary, _, _ in _parameters}
    scene_app.command(_name, help=_first_line(_builder))(_command(_builder, _helps))
