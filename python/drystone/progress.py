"""A progress bar for a search, on standard error, once the search has lasted a second."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

PATIENCE = 1.0
"""Seconds without a bar."""


class PlanProgress:
    """Use as a context, and pass it to `plan` as its `progress`.

    >>> import drystone as ds
    >>> with PlanProgress() as progress:
    ...     ds.plan(ds.scenes.column(4), progress=progress).found
    True
    """

    def __init__(self, label: str = "planning") -> None:
        self._label = label
        self._begun = time.monotonic()
        self._bar: Progress | None = None
        self._task: TaskID | None = None

    def __call__(self, tests: int, placed: int, total: int) -> None:
        if self._bar is None:
            if time.monotonic() - self._begun < PATIENCE or not sys.stderr.isatty():
                return
            self._bar, self._task = _shown(self._label, total)
        if self._task is not None:
            label = self._label if tests else "checking the whole"
            self._bar.update(self._task, description=label, completed=placed, tests=tests)

    def __enter__(self) -> PlanProgress:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._bar.stop()


def _shown(label: str, total: int) -> tuple[Progress, TaskID]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("blocks, {task.fields[tests]} tests"),
        TimeElapsedColumn(),
        TextColumn("[dim]Ctrl-C keeps the best so far"),
        console=Console(stderr=True),
        transient=True,
    )
    bar.start()
    return bar, bar.add_task(label, total=total, tests=0)
