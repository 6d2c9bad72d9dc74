"""Progress bars for searches and runs, on standard error, once they have lasted a second."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING

from drystone.common.text import counted

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID
    from typing_extensions import Self

PATIENCE = 1.0
"""Seconds without a bar."""


class _Bar:
    """A bar of blocks, or of something else, with a few words behind it."""

    label = ""
    unit = "blocks"
    hint = ""

    def __init__(self, label: str | None = None) -> None:
        self._label = label or self.label
        self._begun = time.monotonic()
        self._bar: Progress | None = None
        self._task: TaskID | None = None

    def _show(self, placed: int, total: int, more: str = "") -> None:
        if self._bar is None:
            if time.monotonic() - self._begun < PATIENCE or not sys.stderr.isatty():
                return
            self._bar, self._task = _shown(self._label, total, self.unit, self.hint)
        if self._task is not None:
            self._bar.update(self._task, completed=placed, more=more)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._bar.stop()


class PlanProgress(_Bar):
    """Use as a context, and pass it to `plan` as its `progress`.

    >>> import drystone as ds
    >>> with PlanProgress() as progress:
    ...     ds.plan(ds.scenes.column(4), progress=progress).found
    True
    """

    label = "planning"
    hint = "Ctrl-C keeps the best so far"

    def __call__(self, tests: int, placed: int, total: int) -> None:
        self._show(placed, total, f", {tests} tests" if tests else ", checking the whole")


class ForcesProgress(_Bar):
    """Use as a context, and pass it to `Plan.view` as its `progress`."""

    label = "computing forces"

    def __call__(self, placed: int, total: int) -> None:
        self._show(placed, total)


class StrongProgress(_Bar):
    """Use as a context, and pass it to `check` as its `progress`.

    >>> import drystone as ds
    >>> with StrongProgress() as progress:
    ...     ds.check(ds.scenes.column(4), strong=True, progress=progress).must_stand
    True
    """

    label = "looking for another motion"
    unit = "% of the budget"

    def __call__(self, nodes: int, share: float) -> None:
        self._show(int(100 * share), 100, ", " + counted(nodes, "node"))


class FilmProgress(_Bar):
    """Use as a context, for the frames of a film."""

    label = "drawing"
    unit = "frames"

    def __call__(self, drawn: int, total: int) -> None:
        self._show(drawn, total)


class RunProgress(_Bar):
    """Use as a context, and pass it to `simulate` as its `progress`.

    >>> import drystone as ds
    >>> with RunProgress() as progress:
    ...     ds.simulate(ds.scenes.column(4), steps=10, progress=progress).steps
    10
    """

    label = "simulating"
    unit = "steps"
    hint = "Ctrl-C keeps what is done"

    def __call__(self, made: int, total: int) -> None:
        self._show(made, total)


def _shown(label: str, total: int, unit: str, hint: str) -> tuple[Progress, TaskID]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn(unit + "{task.fields[more]}"),
        TimeElapsedColumn(),
        TextColumn(f"[dim]{hint}"),
        console=Console(stderr=True),
        transient=True,
    )
    bar.start()
    return bar, bar.add_task(label, total=total, more="")
