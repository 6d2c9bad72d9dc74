"""The engine on Ray: tasks on the machines of a cluster, repeated elsewhere when one dies.

A task is a pure function of the text of its scene, so that repeating it is harmless; and only the
caller keeps answers, one for each job, however often its task was begun.
"""

from __future__ import annotations

import json
import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from drystone.common.extras import extra
from drystone.many import work
from drystone.many.engine import AHEAD, EngineError, Take, cores, readable
from drystone.many.jobs import Job
from drystone.many.work import Settings, failure

OBJECT_STORE = 256 * 2**20
"""Bytes of shared memory for a Ray started here: scenes and answers are texts of a few megabytes
at most, and only a few are under way."""


def on_ray(
    jobs: Iterator[Job],
    settings: Settings,
    take: Take,
    workers: int | None,
    address: str | None,
    retries: int,
) -> None:
    """As tasks of Ray, of one CPU each."""
    with _connected(address, workers) as ray:
        task = ray.remote(num_cpus=1, max_retries=retries)(work.plan_text)
        running: dict[Any, Job] = {}
        try:
            for job in readable(jobs, take):
                running[task.remote(job.text, job.source, settings)] = job
                while len(running) >= AHEAD * _cpus(ray):
                    _take_finished(ray, running, take)
            while running:
                _take_finished(ray, running, take)
        except BaseException:
            _take_done(ray, running, take)
            for reference in running:
                ray.cancel(reference)
            raise


def _take_finished(ray: Any, running: dict[Any, Job], take: Take) -> None:
    ray.wait(list(running), num_returns=1)
    _take_done(ray, running, take)


def _take_done(ray: Any, running: dict[Any, Job], take: Take) -> None:
    done, _ = ray.wait(list(running), num_returns=len(running), timeout=0)
    for reference in done:
        take(running.pop(reference), _text(ray, reference))


def _text(ray: Any, reference: Any) -> str:
    """The answer of a task, or why there is none: no machine lived long enough, say."""
    try:
        text: str = ray.get(reference)
    except ray.exceptions.RayError as error:
        return json.dumps(failure("failed", error))
    return text


def _cpus(ray: Any) -> int:
    """CPUs of the cluster as it is now: machines come and go."""
    return max(1, int(ray.cluster_resources().get("CPU", 1)))


@contextmanager
def _connected(address: str | None, workers: int | None) -> Iterator[Any]:
    """Ray, connected; what was connected or started here is let go of at the end."""
    with extra("ray", "plans on a cluster"):
        import ray
    if ray.is_initialized():
        if address is not None:
            raise EngineError(
                f"Ray is connected already: leave out address {address!r}, or ray.shutdown() first"
            )
        yield ray
        return
    _connect(ray, address, workers)
    try:
        yield ray
    finally:
        ray.shutdown()


def _connect(ray: Any, address: str | None, workers: int | None) -> None:
    try:
        ray.init(address=address or "auto", logging_level=logging.WARNING, log_to_driver=False)
    except (ConnectionError, RuntimeError, ValueError, OSError) as error:
        if address is not None:
            raise EngineError(f"no Ray cluster at {address!r}: {error}") from None
        # Nothing is told to anybody by a Ray that only serves this call.
        os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
        ray.init(
            address="local",
            num_cpus=workers or cores(),
            include_dashboard=False,
            object_store_memory=OBJECT_STORE,
            logging_level=logging.ERROR,
            log_to_driver=False,
        )
