"""Many scenes, on the cores of one machine or on a cluster.

    jobs -> engine (threads | ray) -> work on one scene -> store -> answers

Only the process that called `plan_many` writes; workers, wherever they are, get the text of a scene
and send back the text of an answer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from os import PathLike

from drystone.common.cones import FACETS, INSCRIBED, Pyramid
from drystone.common.numbers import FloatRows, number, optional_number, optional_whole, whole
from drystone.many import engines
from drystone.many.answers import ManyPlans, ScenePlan
from drystone.many.engine import EngineError
from drystone.many.engines import EngineName
from drystone.many.jobs import Job, Scenes, jobs_of
from drystone.many.store import Store
from drystone.many.work import Settings
from drystone.planning.search import OrderOfPlan, StabilityTest
from drystone.scene import Scene
from drystone.scene.scene import scene_of

__all__ = ["ENGINES", "EngineError", "ManyPlans", "Progress", "ScenePlan", "plan_many"]

ENGINES = engines.ENGINES
"""Where the planning is done: see `plan_many`."""

Progress = Callable[[int, "int | None", ScenePlan], None]
"""Called with (scenes done, scenes in all or None if nobody knows, the answer that came in)."""


def plan_many(
    scenes: Scenes,
    engine: EngineName = "threads",
    output: str | PathLike[str] | None = None,
    *,
    test: StabilityTest = "reuse",
    node_limit: int | None = None,
    time_limit: float | None = None,
    shortcuts: bool = True,
    hold: int = 0,
    clear_path: bool = False,
    directions: FloatRows | None = None,
    margin: float = 0.0,
    order: OrderOfPlan = "any",
    moves: int = 1,
    together: int = 1,
    obstacles: Scene | None = None,
    facets: int = FACETS,
    cone: Pyramid = INSCRIBED,
    workers: int | None = None,
    address: str | None = None,
    retries: int = 3,
    progress: Progress | None = None,
) -> ManyPlans:
    """Plan many scenes, each as `plan` would, on all cores or on a cluster.

    `scenes` is a folder (its files `*.json`, by name), or any iterable of scenes and of paths of
    scene files, or a mapping from names to these. It may be a generator: only as many scenes as
    keep the workers busy are held at a time.

    `engine` says where the work is done:

    - "threads": on threads of this process, `workers` of them (by default one for each core);
    - "ray": as tasks of Ray, `pip install "drystone[ray]"`. `address` names the cluster ("auto":
      the one that runs on this machine). Without it, it is the cluster that this process is
      connected to, the one that RAY_ADDRESS names, or the one that runs on this machine; if there
      is none, Ray is started on this machine for the call, with `workers` CPUs (by default one for
      each core). A task takes one CPU. If its machine dies it is repeated elsewhere, at most
      `retries` times.

    With `output`, a folder, every answer is written as soon as it is there: one file for each
    scene, named by the scene's name and content, and a line in `index.jsonl`. A file is written
    whole or not at all. A later call with the same folder plans only what is not there for the same
    content and the same settings: all that `plan` takes but `threads` and `progress`, and the
    version of drystone. `obstacles` are in the way of every scene. Without `output` answers are
    kept in memory only.

    A scene that cannot be read is recorded as such, and the others go on. Ctrl-C ends the call
    early: the answer then holds what is finished, and its `interrupted` is True.

    Orders, tests and pivots do not depend on engine or workers, unless `time_limit` cuts them.

    Raises ValueError or TypeError for an argument that is not usable, OSError for a folder that is
    not, and EngineError if Ray is not there.

    >>> import drystone as ds, tempfile
    >>> scenes = {"column": ds.scenes.column(4), "arch": ds.scenes.arch(5)}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     first = ds.plan_many(scenes, output=folder)
    ...     again = ds.plan_many(scenes, output=folder)
    ...     first["column"].order, first["arch"].status, again.reused
    (('3', '2', '1'), 'no_order', 2)
    """
    if directions is not None and not clear_path:
        raise ValueError("directions are for straight ways out: give clear_path=True with them")
    settings = Settings(
        test,
        optional_whole(node_limit, "node_limit"),
        optional_number(time_limit, "time_limit"),
        shortcuts,
        whole(hold, "hold"),
        clear_path,
        tuple(tuple(map(float, way)) for way in (() if directions is None else directions)),
        number(margin, "margin"),
        order,
        whole(moves, "moves"),
        whole(together, "together"),
        None if obstacles is None else scene_of(obstacles).to_json(),
        whole(facets, "facets"),
        cone,
    ).checked()
    jobs, total = jobs_of(scenes)
    run = engines.of(engine, workers=workers, address=address, retries=retries)
    answers: dict[str, ScenePlan | None] = {}  # in the order of the scenes; None: under way
    done = 0
    interrupted = False

    def take(job: Job, answer: ScenePlan) -> None:
        nonlocal done
        answers[job.key] = answer
        done += 1
        if progress is not None:
            progress(done, total, answer)

    def unfinished(store: Store) -> Iterator[Job]:
        nonlocal done
        for job in jobs:
            if job.key in answers:
                done += 1  # the same name and content as one before
                continue
            answers[job.key] = None
            if (answer := store.find(job)) is not None:
                take(job, answer)
            else:
                yield job

    with Store.open(output, settings) as store:
        try:
            run(unfinished(store), settings, lambda job, text: take(job, store.add(job, text)))
        except KeyboardInterrupt:
            interrupted = True
    found = tuple(answer for answer in answers.values() if answer is not None)
    return ManyPlans(found, interrupted)
