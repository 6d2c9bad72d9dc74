"""Where the planning is done: which engine a name stands for."""

from __future__ import annotations

from functools import partial
from typing import Literal, TypeAlias, get_args

from drystone.common.numbers import optional_whole, whole
from drystone.many.engine import Engine, cores
from drystone.many.on_threads import on_threads

EngineName: TypeAlias = Literal["threads", "ray"]
ENGINES = get_args(EngineName)


def of(name: EngineName, workers: int | None, address: str | None, retries: int) -> Engine:
    """The engine called `name`; ValueError for arguments it cannot use."""
    workers = optional_whole(workers, "workers")
    if workers is not None and workers < 1:
        raise ValueError(f"workers is {workers}: it must be one or more")
    if whole(retries, "retries") < 0:
        raise ValueError(f"retries is {retries}: it must be zero or more")
    if name == "threads":
        if address is not None:
            raise ValueError(f"address {address!r} is for engine='ray': threads are all here")
        return partial(on_threads, workers=workers or cores())
    if name == "ray":
        from drystone.many.on_ray import on_ray

        return partial(on_ray, workers=workers, address=address, retries=retries)
    raise ValueError(f"unknown engine {name!r}: choose one of {', '.join(ENGINES)}")
