"""Files of runs: what was saved comes back to the bit, any other bytes are a SimulationError."""

from __future__ import annotations

import io
import json
import tracemalloc
import zipfile
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone as ds


@pytest.fixture(scope="module")
def run() -> ds.Run:
    return ds.simulate(ds.scenes.fall7(), steps=4, forces=True)


@pytest.fixture(scope="module")
def content(run: ds.Run, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    path = tmp_path_factory.mktemp("run") / "run.npz"
    run.save(path)
    return path.read_bytes()


@pytest.fixture
def load(tmp_path: Path) -> Callable[[bytes], ds.Run]:
    def of(content: bytes) -> ds.Run:
        (tmp_path / "any.npz").write_bytes(content)
        return ds.Run.load(tmp_path / "any.npz")

    return of


def test_it_comes_back_to_the_bit(
    run: ds.Run, content: bytes, load: Callable[[bytes], ds.Run], tmp_path: Path
) -> None:
    again = load(content)
    for f in fields(run):
        a, b = getattr(run, f.name), getattr(again, f.name)
        if isinstance(a, np.ndarray):
            assert a.dtype == b.dtype
            assert np.array_equal(a, b)
            assert not b.flags.writeable
        elif isinstance(a, ds.Scene):
            assert a.to_json() == b.to_json()
        else:
            assert a == b
    solid = ds.simulate(ds.scenes.fall7().extruded(), steps=0)
    solid.save(tmp_path / "solid.npz")
    assert ds.Run.load(tmp_path / "solid.npz").poses.shape == (1, 8, 7)


def test_changed_bytes_are_no_run_or_the_same_run(
    run: ds.Run, content: bytes, load: Callable[[bytes], ds.Run]
) -> None:
    """Dates and the like in an archive say nothing about the run; all else is noticed."""
    rng = np.random.default_rng(4)
    refused = 0
    for trial in range(400):
        changed = bytearray(content)
        if trial % 4 == 0:
            del changed[int(rng.integers(len(changed))) :]
        for _ in range(int(rng.integers(1, 4))):
            if changed:
                changed[int(rng.integers(len(changed)))] = int(rng.integers(256))
        try:
            again = load(bytes(changed))
        except ds.SimulationError:
            refused += 1
            continue
        assert again.to_dict() == run.to_dict()
    assert refused > 300


def _with(content: bytes, change: Callable[[dict[str, bytes]], object]) -> bytes:
    """The archive with other members, checksums and all."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    change(members)
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return out.getvalue()


def _npy(array: Any) -> bytes:
    out = io.BytesIO()
    np.save(out, array, allow_pickle=True)
    return out.getvalue()


def _forged(shape: str, dtype: str = "'<f8'") -> bytes:
    """A header that claims an array that is not there."""
    head = f"{{'descr': {dtype}, 'fortran_order': False, 'shape': {shape}, }}".encode()
    return b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head + b"\0" * 64


def _about(**changes: Any) -> Callable[[dict[str, bytes]], object]:
    def change(members: dict[str, bytes]) -> None:
        about = json.loads(str(np.load(io.BytesIO(members["about.npy"]))))
        for name, value in changes.items():
            if value is ...:
                del about[name]
            else:
                about[name] = value
        members["about.npy"] = _npy(np.array(json.dumps(about)))

    return change


def _set(name: str, data: Any) -> Callable[[dict[str, bytes]], object]:
    written = data if isinstance(data, bytes) else _npy(data)
    return lambda members: members.update({f"{name}.npy": written})


FORGED: dict[str, Callable[[dict[str, bytes]], object]] = {
    "no about": lambda members: members.pop("about.npy"),
    "no poses": lambda members: members.pop("poses.npy"),
    "one more array": _set("more", np.zeros(3)),
    "another format": _about(format="other"),
    "another version": _about(version=7),
    "no dt": _about(dt=...),
    "one more field": _about(more=1),
    "dt is negative": _about(dt=-1.0),
    "dt is not a number": _about(dt=float("nan")),
    "dt is a text": _about(dt="fast"),
    "an unknown status": _about(status="well"),
    "names of others": _about(names=["a"]),
    "names that are none": _about(names=[1, 2, 3, 4, 5, 6, 7, 8]),
    "no scene": _about(scene="{}"),
    "deep about": _set("about", np.array("[" * 100_000)),
    "about is a list": _set("about", np.array("[1, 2]")),
    "about is a number": _set("about", np.array(3)),
    "objects": _set("pivots", np.array([{}, 1], dtype=object)),
    "other steps": _set("pivots", np.zeros(5, dtype=np.int64)),
    "other bodies": _set("poses", np.zeros((5, 3, 3))),
    "other numbers": _set("pivots", np.zeros(4)),
    "no shape": _set("pivots", np.int64(4)),
    "a flat run": _set("poses", np.zeros(3)),
    "bodies out of range": _set("force_bodies", np.full((200, 2), 99)),
    "starts that fall": _set("force_starts", np.array([0, 9, 3, 4, 5])),
    "endless": _set("poses", _forged("(1000000000000, 8, 3)")),
    "overflowing": _set("poses", _forged("(4611686018427387904, 4611686018427387904)")),
    "negative": _set("poses", _forged("(-1, 8, 3)")),
    "no header": _set("poses", b"\x93NUMPY\x01\x00\xff\xff{"),
    "a program": _set("poses", _forged("__import__('os')")),
    "no array": _set("poses", b"poses"),
}


@pytest.mark.parametrize("case", FORGED)
def test_forged_files(content: bytes, load: Callable[[bytes], ds.Run], case: str) -> None:
    forged = _with(content, FORGED[case])
    tracemalloc.start()
    with pytest.raises(ds.SimulationError, match="this is no run that drystone recorded"):
        load(forged)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 50e6


def test_what_is_no_archive(load: Callable[[bytes], ds.Run], tmp_path: Path) -> None:
    for data in (b"", b"PK", b"PK\x05\x06" + b"\0" * 18, _npy(np.zeros(3)), b"\0" * 1000):
        with pytest.raises(ds.SimulationError, match=r"any\.npz: this is no run"):
            load(data)
    with pytest.raises(FileNotFoundError):
        ds.Run.load(tmp_path / "nowhere.npz")
