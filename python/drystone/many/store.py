"""A folder of answers: one file a scene, written whole or not at all, and an index that only grows.

The files are the truth. A file counts as finished if its own checksum, the content hash of the
scene and the settings agree. `index.jsonl` tells what was done: a line for each file ever written,
and for each scene of which there is none (it could not be read, or its planning broke).
"""

from __future__ import annotations

import errno
import hashlib
import json
import os
from os import PathLike
from pathlib import Path
from types import TracebackType
from typing import IO, Any

from drystone.common.files import write_whole
from drystone.many.answers import ScenePlan
from drystone.many.jobs import Job
from drystone.many.work import Settings, failure

FORMAT = "drystone plan"
VERSION = 1
INDEX = "index.jsonl"
LOCK = ".lock"


class Store:
    """Finds and keeps answers. Use as a context: one process at a time has the folder."""

    def __init__(self, folder: Path | None, settings: Settings) -> None:
        self._folder = folder
        self._settings = settings.to_dict()
        self._lock: IO[bytes] | None = None
        self._indexed: set[str] = set()

    @classmethod
    def open(cls, folder: str | PathLike[str] | None, settings: Settings) -> Store:
        """The store in `folder`, made if need be; in memory without a folder.

        Raises OSError if the folder cannot be used or another process has it.
        """
        store = cls(None if folder is None else Path(folder), settings)
        if store._folder is not None:
            store._folder.mkdir(parents=True, exist_ok=True)
            store._lock = _locked(store._folder / LOCK)
            store._indexed = _digests(store._folder / INDEX)
        return store

    def __enter__(self) -> Store:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._lock is not None:
            self._lock.close()

    def find(self, job: Job) -> ScenePlan | None:
        """The finished answer of an earlier run; None if there is none that is sound."""
        if self._folder is None or job.sha256 is None:
            return None
        record = _sound(self._folder / job.key)
        if (
            record is None
            or record["scene"].get("sha256") != job.sha256
            or record["settings"] != self._settings
        ):
            return None
        if record["sha256"] not in self._indexed:  # killed between the file and its line
            self._append(job, record, None)
        return self._answer(job, record, reused=True)

    def add(self, job: Job, text: str) -> ScenePlan:
        """Keep a worker's answer."""
        answer = json.loads(text)
        worker = answer.pop("worker", None)
        if answer.get("plan", {}).get("status") == "interrupted":
            answer = failure("failed", InterruptedError("the planning was interrupted"))
        record: dict[str, Any] = {
            "format": FORMAT,
            "version": VERSION,
            "scene": {"name": job.name, "sha256": job.sha256},
            "settings": self._settings,
            **answer,
        }
        record["sha256"] = _digest(record)
        if self._folder is not None:
            if _kept(record):
                write_whole(self._folder / job.key, (json.dumps(record) + "\n").encode())
            self._append(job, record, worker)
        return self._answer(job, record, reused=False)

    def _answer(self, job: Job, record: dict[str, Any], reused: bool) -> ScenePlan:
        plan, error = record.get("plan", {}), record.get("error")
        on_disk = self._folder is not None and _kept(record)
        return ScenePlan(
            name=job.name,
            sha256=job.sha256,
            state=record["state"],
            found=plan.get("found", False),
            status=plan.get("status", ""),
            error="" if error is None else f"{error['type']}: {error['message']}",
            reused=reused,
            file=self._folder / job.key if self._folder is not None and on_disk else None,
            _record=None if on_disk else record,
        )

    def _append(self, job: Job, record: dict[str, Any], worker: str | None) -> None:
        """One line, in one write, after whatever a killed process left of its last one."""
        assert self._folder is not None
        plan = record.get("plan", {})
        line = {
            "name": job.name,
            "file": job.key if _kept(record) else None,
            "scene_sha256": job.sha256,
            "settings": self._settings,
            "state": record["state"],
            "status": plan.get("status"),
            "found": plan.get("found", False),
            "seconds": plan.get("seconds"),
            "error": record.get("error"),
            "worker": worker,
            "sha256": record["sha256"],
        }
        path = self._folder / INDEX
        with path.open("ab+") as index:
            if index.tell() > 0:
                index.seek(-1, os.SEEK_END)
            torn = index.read(1) not in (b"", b"\n")
            index.write(b"\n" * torn + json.dumps(line).encode() + b"\n")
        self._indexed.add(record["sha256"])


def read_index(folder: str | PathLike[str]) -> list[dict[str, Any]]:
    """The lines of the index, in the order they were written; a torn one is left out."""
    lines = []
    try:
        content = (Path(folder) / INDEX).read_bytes()
    except FileNotFoundError:
        return []
    for line in content.split(b"\n"):
        try:
            entry = json.loads(line)
        except (ValueError, RecursionError):
            continue
        if isinstance(entry, dict):
            lines.append(entry)
    return lines


def _digests(index: Path) -> set[str]:
    return {str(entry.get("sha256")) for entry in read_index(index.parent)}


def _kept(record: dict[str, Any]) -> bool:
    """Whether asking again would give the same: then it is an answer worth a file."""
    return record["state"] != "failed" and record["scene"]["sha256"] is not None


def _digest(record: dict[str, Any]) -> str:
    rest = {key: value for key, value in record.items() if key != "sha256"}
    return hashlib.sha256(json.dumps(rest, sort_keys=True).encode()).hexdigest()


def _sound(path: Path) -> dict[str, Any] | None:
    """The record in a file; None if there is none or it is not what was written."""
    try:
        record = json.loads(path.read_bytes())
    except (FileNotFoundError, ValueError, RecursionError):
        return None
    if not isinstance(record, dict) or (record.get("format"), record.get("version")) != (
        FORMAT,
        VERSION,
    ):
        return None
    whole = (
        record.get("sha256") == _digest(record)
        and isinstance(record.get("scene"), dict)
        and isinstance(record.get("settings"), dict)
        and isinstance(record.get("state"), str)
        and isinstance(record.get("plan", {}), dict)
        and (record.get("error") is None or {"type", "message"} <= set(record["error"]))
    )
    return record if whole else None


def _locked(path: Path) -> IO[bytes]:
    """An open file that no other process can lock until it is closed, by whatever end."""
    file = path.open("ab")
    try:
        import fcntl
    except ImportError:  # no such locks: two runs at once repeat work, but break no file
        return file
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        file.close()
        raise BlockingIOError(
            errno.EAGAIN,
            "another run is writing here: wait for its end or choose another folder",
            str(path.parent),
        ) from None
    return file
