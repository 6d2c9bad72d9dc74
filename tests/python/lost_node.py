"""`drystone plan` on a cluster of three machines, of which one is killed at work.

    python lost_node.py SCENES OUTPUT TRACE

A process of its own: Ray reads its environment when it is imported. TRACE gets a line "SCENE NODE"
for each time a task was begun, and "killed NODE".

The machine to be killed is told so by a file, and does not end a task that it begins after that:
so it dies at work however slow or fast the machine below is.
"""

from __future__ import annotations

import sys
import threading
import time
from pathlib import Path

import ray
from ray.cluster_utils import Cluster

from drystone.cli import run
from drystone.many import work
from drystone.many.store import read_index

SCENES, OUTPUT, TRACE = (Path(argument) for argument in sys.argv[1:])
ENOUGH = 4
"""Answers before a machine is killed: both have begun to work, most work is still to do."""
NODE = {"object_store_memory": 80 * 2**20, "include_dashboard": False}
# Who does not answer twice within a second is dead; Ray's own patience is 15 seconds.
PATIENCE = {"health_check_period_ms": 500, "health_check_failure_threshold": 2}
CONDEMNED = TRACE.with_name("condemned")
"""Holds the name of the machine to be killed."""
AT_WORK = 120.0
"""Seconds that the condemned machine is at its last task, should nobody kill it."""
plan_text = work.plan_text


def note(text: str) -> None:
    with TRACE.open("a") as trace:
        trace.write(text + "\n")


def traced(text: str, source: str, settings: work.Settings) -> str:
    """`plan_text` with a trace, and without an end on the condemned machine."""
    node = ray.get_runtime_context().get_node_id()
    # Read before the trace is written: who waits for a line of this task sees it not ending.
    condemned = CONDEMNED.exists() and CONDEMNED.read_text() == node
    note(f"{Path(source).stem} {node}" + " condemned" * condemned)
    if condemned:
        time.sleep(AT_WORK)
    return plan_text(text, source, settings)


def main() -> int:
    head = {"num_cpus": 0, "_system_config": PATIENCE, **NODE}
    cluster = Cluster(initialize_head=True, head_node_args=head)
    try:
        nodes = [cluster.add_node(wait=False, num_cpus=1, **NODE) for _ in range(2)]
        cluster.wait_for_nodes()

        def kill_one() -> None:
            while len(read_index(OUTPUT)) < ENOUGH:
                time.sleep(0.01)
            part = CONDEMNED.with_suffix(".part")
            part.write_text(nodes[0].node_id)
            part.replace(CONDEMNED)
            while " condemned" not in TRACE.read_text():
                time.sleep(0.01)
            note(f"killed {nodes[0].node_id}")
            cluster.remove_node(nodes[0], allow_graceful=False)

        work.plan_text = traced
        killer = threading.Thread(target=kill_one, daemon=True)
        killer.start()
        where = ["--engine", "ray", "--address", cluster.address]
        how = ["--test", "lp", "--json"]
        status = run(["plan", str(SCENES), "-o", str(OUTPUT), *where, *how])
        killer.join(AT_WORK)
        return status
    finally:
        cluster.shutdown()


if __name__ == "__main__":
    sys.exit(main())
