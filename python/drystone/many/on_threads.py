"""The engine on threads of this process."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

from drystone.many import work
from drystone.many.engine import AHEAD, Take, readable
from drystone.many.jobs import Job
from drystone.many.work import Settings, StoppedError, failure


def on_threads(jobs: Iterator[Job], settings: Settings, take: Take, workers: int) -> None:
    """The core lets go of the interpreter while it plans."""
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
