"""A progress bar over scenes, on standard error, once the work has lasted a second."""

from __future__ import annotations

import sys
import threading
from types import TracebackType
from typing import TYPE_CHECKING

from drystone.common.progress import PATIENCE
from drystone.many.answers import ScenePlan

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID


class ManyProgress:
    """Use as a context, and pass it to `plan_many` as its `progress`.

    >>> import drystone as ds
    >>> with ManyProgress() as progress:
    ...     ds.plan_many([ds.scenes.column(4)], progress=progress).found
    1
    """

    def __init__(self) -> None:
        self._bar: Progress | None = None
        self._task: TaskID | None = None
        self._told: tuple[int, int | None] = (0, None)
        self._without = 0
        self._guard = threading.Lock()
        # By a timer: the first answer may take long.
        self._timer = threading.Timer(PATIENCE, self._show)
        self._timer.daemon = True

    def __call__(self, done: int, total: int | None, answer: ScenePlan) -> None:
        with self._guard:
            self._without += not answer.found
            self._told = (done, total)
            self._update()

    def _show(self) -> None:
        with self._guard:
            self._bar, self._task = _shown()
            self._update()

    def _update(self) -> None:
        if self._bar is not None and self._task is not None:
            done, total = self._told
            self._bar.update(self._task, completed=done, total=total, without=self._without)

    def __enter__(self) -> ManyProgress:
        if sys.stderr.isatty():
            self._timer.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._timer.cancel()
        with self._guard:
            if self._bar is not None:
                self._bar.stop()


def _shown() -> tuple[Progress, TaskID]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    bar = Progress(
        TextColumn("planning"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("scenes, {task.fields[without]} without an order"),
        TimeElapsedColumn(),
        TextColumn("[dim]Ctrl-C keeps what is finished"),
        console=Console(stderr=True),
        transient=True,
    )
    bar.start()
    return bar, bar.add_task("planning", total=None, without=0)
