"""A command line in a process of its own, to be interrupted once it is at work."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

MANY_TIMES_ENOUGH = 120.0
"""Seconds that a slow machine may take until something has happened."""

CODE = """
import sys
from pathlib import Path
from drystone.common import progress
from drystone.cli import main

flag, bar = Path(sys.argv.pop(1)), getattr(progress, sys.argv.pop(1))
show = bar.__call__

def told(self, done, *more):
    if done:
        flag.touch()
    show(self, done, *more)

bar.__call__ = told
main()
"""


def until(happened: Callable[[], bool], process: subprocess.Popen[str]) -> None:
    """Wait for something that `process`, which goes on, has done."""
    deadline = time.monotonic() + MANY_TIMES_ENOUGH
    while not happened():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline, "nothing happened"
        time.sleep(0.02)


def at_work(flag: Path, bar: str, *arguments: str) -> subprocess.Popen[str]:
    """The process of a command line, as soon as its progress `bar` is told of something done.

    `flag` is a file that is not there yet.
    """
    process = subprocess.Popen(
        [sys.executable, "-c", CODE, str(flag), bar, *arguments],
        # A shell may start its background jobs with interrupts ignored.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    until(flag.exists, process)
    return process
