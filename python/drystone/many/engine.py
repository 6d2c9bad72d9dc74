"""What an engine is: it takes jobs and hands back their answers as they come."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator

from drystone._core import DrystoneError
from drystone.many.jobs import Job
from drystone.many.work import Settings

AHEAD = 2
"""Jobs given out for each worker: one at work, one so that it need not wait for the next."""

Take = Callable[[Job, str], None]
"""Called with each job and the text of its answer, always on the caller's thread."""
Engine = Callable[[Iterator[Job], Settings, Take], None]


class EngineError(DrystoneError):
    """The engine cannot be used; the text says what to do."""


def readable(jobs: Iterator[Job], take: Take) -> Iterator[Job]:
    """The jobs that have a text; the others are answered at once."""
    for job in jobs:
        if job.text is not None:
            yield job
        else:
            error = {"type": "SceneError", "message": job.error}
            take(job, json.dumps({"state": "bad_input", "error": error}))


def cores() -> int:
    """The cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
