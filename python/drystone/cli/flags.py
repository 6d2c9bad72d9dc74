"""Commands whose help shows a flag without a value: newer parsers write `<bool>` beside it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup


def _without_value(parameters: list[Any]) -> list[Any]:
    """The same parameters; beside flags nothing is written."""
    for parameter in parameters:
        if getattr(parameter, "is_flag", False):
            parameter.metavar = ""
    return parameters


class Command(TyperCommand):
    """A command; the parser adds its `--help` when asked for the parameters."""

    def get_params(self, ctx: Any) -> list[Any]:
        """Its parameters."""
        return _without_value(super().get_params(ctx))


class Group(TyperGroup):
    """Commands under one name."""

    def get_params(self, ctx: Any) -> list[Any]:
        """The parameters of the group itself."""
        return _without_value(super().get_params(ctx))


class App(typer.Typer):
    """An application of such commands."""

    def __init__(self, *, cls: type[TyperGroup] = Group, **options: Any) -> None:
        super().__init__(cls=cls, **options)

    def command(
        self, name: str | None = None, *, cls: type[TyperCommand] | None = Command, **options: Any
    ) -> Callable[[Any], Any]:
        """Register a command, as `typer.Typer.command` does."""
        return super().command(name, cls=cls, **options)
