"""Scenes and pictures named on the command line."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from drystone.cli.errors import InputError
from drystone.common import later
from drystone.common.drawn import DPI
from drystone.common.extras import require
from drystone.common.files import FILMS, JSON, PAGE, PICTURES, RUN, ending_of
from drystone.common.json_text import Written, save_json
from drystone.common.progress import FilmProgress
from drystone.common.text import shown

if TYPE_CHECKING:
    from drystone.scene import Scene


STANDARD = "-"
"""A file's name that stands for standard input or output."""


def load_scene(text: str) -> Scene:
    """The scene in the file `text`, on standard input, or the built-in one that `text` names."""
    from drystone import _core
    from drystone.scene import Scene

    if not text.strip():
        raise InputError("the scene's name is empty: a file, a built-in scene or - is needed")
    if text == STANDARD:
        return Scene._of(_core.Scene.from_json(_standard_input(), "standard input"))
    name, _, parameters = text.partition(":")
    builder = builder_of(name)
    if not Path(text).exists():
        if builder is not None:
            return builder(**parameters_of(builder, parameters))
        if Path(name).name == name and not Path(name).suffix:
            raise neither(text, python_name(name))
    with reporting_files():
        return Scene.load(text)


def _standard_input() -> str:
    try:
        return sys.stdin.buffer.read().decode()
    except UnicodeDecodeError as error:
        raise InputError(f"standard input is no text: {error}") from None


def builder_of(name: str) -> Callable[..., Scene] | None:
    """The function of `drystone.scenes` that has a name; None if there is none."""
    from drystone import scenes

    return getattr(scenes, python_name(name)) if python_name(name) in scenes.__all__ else None


def neither(text: str, name: str) -> InputError:
    """What to say of a word that is no file; the nearest scene's name with it."""
    from drystone import _core, scenes

    try:
        scenes._built(name)
    except _core.SceneError as error:
        return InputError(f"{text}: no such file, and {error}")
    return InputError(f"{text}: no such file")


def parameters_of(builder: Callable[..., Scene], text: str) -> dict[str, int | float]:
    """Parameters of a built-in scene from text like "50,friction=0.5": in order, or by name."""
    signature = inspect.signature(builder, eval_str=True)
    names = list(signature.parameters)
    given: dict[str, int | float] = {}
    for place, part in enumerate(filter(None, text.split(","))):
        key, equals, value = part.partition("=")
        if not equals:
            if place >= len(names):
                takes = ", ".join(names)
                raise InputError(f"{builder.__name__}: {part} is one too many: it takes {takes}")
            key, value = names[place], part
        if key not in signature.parameters:
            raise InputError(
                f"{builder.__name__} has no parameter {key!r}: it takes {', '.join(names)}"
            )
        if key in given:
            raise InputError(
                f"{builder.__name__}: {key} has two values, {given[key]} and {value}: give one"
            )
        given[key] = _number(value, signature.parameters[key].annotation, builder.__name__, key)
    return given


def listed(text: str | None) -> list[str]:
    """Names separated by commas."""
    return [name.strip() for name in (text or "").split(",") if name.strip()]


def numbers(text: str, what: str) -> tuple[float, ...]:
    """Numbers separated by commas."""
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"{what}: {text!r} is no list of numbers, as 9.81,0") from None


def chosen(blocks: str | None, block: Sequence[str] | None) -> list[str] | None:
    """The names given by --blocks and --block; None if there is neither."""
    return None if blocks is None and not block else [*listed(blocks), *(block or ())]


class Drawn(Protocol):
    """What can be drawn."""

    def draw(self, path: str | PathLike[str]) -> None: ...


def write(answer: Written, drawn: Drawn, path: Path | None) -> None:
    """The answer as JSON, or the picture or page of what is drawn of it, if one was asked for."""
    if path is not None:
        with reporting_files():
            if path.suffix.lower() == JSON:
                save_json(answer, path)
            else:
                drawn.draw(path)


def save_film(answer: object, path: Path) -> None:
    """The film of a plan or a run, with a bar while it is drawn."""
    with FilmProgress() as progress:
        later.film(answer, path, DPI, progress)


def python_name(name: str) -> str:
    """random-stack is random_stack."""
    return name.replace("-", "_")


KINDS = {
    **dict.fromkeys(PICTURES, "picture"),
    **dict.fromkeys(FILMS, "film"),
    PAGE: "page",
    RUN: "run",
    JSON: "answer",
}
"""What a file is, by the ending of its name."""


def picture_path(path: Path | None, *others: str) -> Path | None:
    """`path`, refused before any work if it ends neither as a picture's nor in one of `others`, or
    if what draws it is not installed."""
    if path is None:
        return None
    try:
        ending = ending_of(path, (*PICTURES, *others))
    except ValueError as error:
        raise InputError(str(error)) from None
    if ending in (*PICTURES, *FILMS):
        require("pictures", "pictures")
    return path


def kind_of(path: Path) -> str:
    """What is written to a file."""
    return KINDS[path.suffix.lower()]


def said_of(path: Path) -> str:
    """The line that says where it is."""
    return f"{kind_of(path)}: {shown(str(path))}"


@contextmanager
def reporting_files() -> Iterator[None]:
    """Failures to read or write a file become one line that names the file."""
    try:
        yield
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        raise InputError(f"{where}{error.strerror or error}") from None


def _number(text: str, kind: type, scene: str, parameter: str) -> int | float:
    try:
        return int(text) if kind is int else float(text)
    except ValueError:
        wanted = "a whole number" if kind is int else "a number"
        raise InputError(f"{scene}: {parameter} must be {wanted}, not {text!r}") from None
