"""Where the planning is done. An engine takes jobs and hands back their answers as they come."""

from __future__ import annotations

import json
import os
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from functools import partial

from drystone._core import DrystoneError
from drystone.many import work
from drystone.many.jobs import Job
from drystone.many.work import Settings, StoppedError, failure

ENGINES = ("threads", "ray")
AHEAD = 2
"""Jobs given out for each worker: one at work, one so that it need not wait for the next."""

Take = Callable[[Job, str], None]
"""Called with each job and the text of its answer, always on the caller's thread."""
Engine = Callable[[Iterator[Job], Settings, Take], None]


class EngineError(DrystoneError):
    """The engine cannot be used; the text says what to do."""


def of(name: str, workers: int | None, address: str | None, retries: int) -> Engine:
    """The engine called `name`; ValueError for arguments it cannot use."""
    if workers is not None and workers < 1:
        raise ValueError(f"workers is {workers}: it must be one or more")
    if retries < 0:
        raise ValueError(f"retries is {retries}: it must be zero or more")
    if name == "threads":
        if address is not None:
            raise ValueError(f"address {address!r} is for engine='ray': threads are all here")
        return partial(on_threads, workers=workers or cores())
    if name == "ray":
        from drystone.many.on_ray import on_ray

        return partial(on_ray, workers=workers, address=address, retries=retries)
    raise ValueError(f"unknown engine {name!r}: choose one of {', '.join(ENGINES)}")


def on_threads(jobs: Iterator[Job], settings: Settings, take: Take, workers: int) -> None:
    """On threads of this process: the core lets go of the interpreter while it plans."""
    stop = threading.Event()

    def watch(tests: int, placed: int, total: int) -> None:
        if stop.is_set():
            raise StoppedError

    running: dict[Future[str], Job] = {}
    with ThreadPoolExecutor(workers, thread_name_prefix="drystone") as pool:

        def begin(job: Job) -> None:
            assert job.text is not None
            running[pool.submit(work.plan_text, job.text, job.source, settings, watch)] = job

        try:
            for job in readable(jobs, take):
                begin(job)
                while len(running) >= AHEAD * workers:
                    _take_finished(running, take)
            while running:
                _take_finished(running, take)
        except BaseException:
            stop.set()
            for future in [future for future in running if future.cancel()]:
                del running[future]
            _take_done(running, take)
            raise


def _take_finished(running: dict[Future[str], Job], take: Take) -> None:
    wait(running, return_when=FIRST_COMPLETED)
    _take_done(running, take)


def _take_done(running: dict[Future[str], Job], take: Take) -> None:
    for future in [future for future in running if future.done()]:
        job, error = running.pop(future), future.exception()
        if not isinstance(error, StoppedError):
            text = future.result() if error is None else json.dumps(failure("failed", error))
            take(job, text)


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
