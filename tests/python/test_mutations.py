"""Files that somebody damaged are read or refused with drystone's own error, and nothing else."""

from __future__ import annotations

import json
import random
import re
import resource
import signal
import tempfile
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone as ds
from drystone import imports
from drystone.meshes import read_part

LONGEST = 5
"""Seconds that one small file may take: most take a millisecond."""
MOST_MEMORY = 3 << 30
"""Bytes of address space that reading a file of some kilobytes may add."""

HOSTILE = [
    b"nan",
    b"NaN",
    b"-inf",
    b"Infinity",
    b"1e400",
    b"-0",
    b"1e-320",
    b"99999999999999999999",
]
HOSTILE += [b"-1", b"0", b"2147483648", b"1e308", b"null", b"[]", b"{}", b'""', b"true", b"9" * 400]
NUMBER = re.compile(rb"-?\d+\.?\d*(?:[eE][-+]?\d+)?")
TOKEN = re.compile(rb"[\w.+-]+")


def flip(data: bytes, dice: random.Random) -> bytes:
    changed = bytearray(data)
    for _ in range(dice.choice([1, 1, 1, 4])):
        changed[dice.randrange(len(changed))] ^= 1 << dice.randrange(8)
    return bytes(changed)


def cut(data: bytes, dice: random.Random) -> bytes:
    return data[: dice.randrange(len(data))]


def leave_out(data: bytes, dice: random.Random) -> bytes:
    start = dice.randrange(len(data))
    return data[:start] + data[start + dice.randrange(1, 40) :]


def repeat(data: bytes, dice: random.Random) -> bytes:
    start, at = dice.randrange(len(data)), dice.randrange(len(data))
    return data[:at] + data[start : start + dice.randrange(1, 80)] + data[at:]


def another_number(data: bytes, dice: random.Random) -> bytes:
    found = list(NUMBER.finditer(data))
    if not found:
        return flip(data, dice)
    match = dice.choice(found)
    return data[: match.start()] + dice.choice(HOSTILE) + data[match.end() :]


def swap_tokens(data: bytes, dice: random.Random) -> bytes:
    found = list(TOKEN.finditer(data))
    if len(found) < 2:
        return flip(data, dice)
    a, b = sorted(dice.sample(found, 2), key=lambda match: match.start())
    return b"".join(
        [data[: a.start()], b.group(), data[a.end() : b.start()], a.group(), data[b.end() :]]
    )


def another_value(data: bytes, dice: random.Random) -> bytes:
    """A key that is not there, or another value in a JSON file."""
    try:
        document = json.loads(data)
    except ValueError:
        return another_number(data, dice)
    nodes: list[Any] = [document]
    for node in nodes:
        children = node.values() if isinstance(node, dict) else node
        nodes.extend(child for child in children if isinstance(child, (dict, list)) and child)
    node = dice.choice(nodes)
    key = dice.choice(list(node)) if isinstance(node, dict) else dice.randrange(len(node))
    if dice.random() < 0.4:
        del node[key]
    else:
        node[key] = dice.choice([None, True, -1, 0, 1e308, 10**400, "", "x", [], {}, [[]], [0] * 3])
    return json.dumps(document).encode()


BYTES = [flip, flip, cut, leave_out, repeat]
TEXT = [*BYTES, another_number, another_number, another_number, swap_tokens]
JSON = [*TEXT, another_value, another_value, another_value]


def too_long(*_: object) -> None:
    raise TimeoutError(f"a small file took more than {LONGEST} s")


@contextmanager
def bounded() -> Iterator[None]:
    """Neither much time for one file nor much memory for all."""
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    before = resource.getrlimit(resource.RLIMIT_AS)
    handler = signal.signal(signal.SIGALRM, too_long)
    resource.setrlimit(resource.RLIMIT_AS, (used + MOST_MEMORY, before[1]))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        resource.setrlimit(resource.RLIMIT_AS, before)
        signal.signal(signal.SIGALRM, handler)


def mutate(
    data: bytes,
    read: Callable[[bytes], Any],
    ways: list[Callable[[bytes, random.Random], bytes]],
    times: int,
) -> None:
    read(data)
    dice = random.Random(20061)
    refused = 0
    with bounded():
        for _ in range(times):
            changed = dice.choice(ways)(data, dice)
            if not changed:
                continue
            signal.setitimer(signal.ITIMER_REAL, LONGEST)
            try:
                read(changed)
            except ds.DrystoneError:
                refused += 1
            except BaseException as error:
                raise AssertionError(
                    f"{type(error).__name__}: {error}\n{changed!r:.3000}"
                ) from error
    assert refused > times / 20, f"only {refused} of {times} were refused"


@pytest.fixture
def folder() -> Iterator[Path]:
    """In memory where there is such a place: thousands of files are written."""
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as name:
        yield Path(name)


def through(path: Path, read: Callable[[Path], Any]) -> Callable[[bytes], Any]:
    def from_file(data: bytes) -> Any:
        path.write_bytes(data)
        return read(path)

    return from_file


def small_scene() -> ds.Scene:
    scene = ds.scenes.five_blocks(friction=0.4)
    scene.add_polygon([(20, 0), (22, 0), (21, 1)], name="wedge", density=3)
    return scene


def solid_scene() -> ds.Scene:
    scene = ds.scenes.brick_wall(1, 1)
    corner = [(0, 0, 5), (1, 0, 5), (0, 1, 5), (0, 0, 6)]
    scene.add_solid([corner], name="corner", friction=0.2)
    return scene


@pytest.mark.parametrize("scene", [small_scene, solid_scene])
def test_scene_files(scene: Callable[[], ds.Scene], folder: Path) -> None:
    data = scene().to_json().encode()
    mutate(data, through(folder / "scene.json", ds.Scene.load), JSON, 1500)


@pytest.mark.parametrize("scene", [small_scene, solid_scene])
def test_snapshots(scene: Callable[[], ds.Scene]) -> None:
    world = ds.World(scene())
    for _ in range(3):
        world.step()
    mutate(world.snapshot(), ds.World.restore, BYTES, 700)


def test_runs(folder: Path) -> None:
    """The numbers of an archive have checksums; so its parts are damaged one by one too."""
    saved = folder / "run.npz"
    ds.simulate(small_scene(), steps=4).save(saved)
    read = through(folder / "damaged.npz", ds.Run.load)
    mutate(saved.read_bytes(), read, BYTES, 200)
    with np.load(saved) as archive:
        parts = {name: archive[name] for name in archive.files}

    def with_about(about: bytes) -> Any:
        text = np.array(about.decode("utf-8", "replace"))
        np.savez(folder / "damaged.npz", **{**parts, "about": text})
        return ds.Run.load(folder / "damaged.npz")

    mutate(str(parts["about"]).encode(), with_about, JSON, 300)


BRICK = [[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0], [0, 0, 1], [2, 0, 1], [2, 1, 1], [0, 1, 1]]


def compas() -> bytes:
    faces = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
    mesh = {
        "vertex": {str(k): dict(zip("xyz", corner, strict=True)) for k, corner in enumerate(BRICK)},
        "face": {str(k): face for k, face in enumerate(faces)},
    }
    block = {"dtype": "compas_assembly.datastructures/Block", "data": mesh}
    nodes = {"0": {"block": block, "is_support": True, "density": 3.5}}
    graph = {"dtype": "compas.datastructures/Graph", "data": {"node": nodes, "edge": {}}}
    kind = "compas_assembly.datastructures/Assembly"
    return json.dumps({"dtype": kind, "data": {"graph": graph}}).encode()


MJCF = b"""<mujoco><compiler angle="degree"/><option gravity="0 0 -5"/>
<default><geom friction="0.8 0.1 0.1" density="500"/></default>
<worldbody><geom name="step" type="box" size="1 1 1" pos="-4 0 1"/>
<body name="crate" pos="0 0 1" euler="0 0 90"><freejoint/><geom type="box" size="1 0.5 1"/></body>
</worldbody></mujoco>"""

URDF = b"""<robot name="r"><link name="base"><inertial><mass value="3"/></inertial>
<collision><origin xyz="0 0 1" rpy="0 0 1.5"/><geometry><box size="1 2 2"/></geometry></collision>
</link></robot>"""


@pytest.mark.parametrize(
    ("name", "data", "ways"),
    [("a.json", compas(), JSON), ("a.xml", MJCF, TEXT), ("a.urdf", URDF, TEXT)],
)
def test_imports(name: str, data: bytes, ways: Any, folder: Path) -> None:
    mutate(data, through(folder / name, imports.load), ways, 1200)


@pytest.mark.parametrize("kind", ["obj", "stl", "ply", "glb", "gltf"])
def test_meshes(kind: str, folder: Path) -> None:
    import trimesh

    data = trimesh.creation.box((1, 2, 3)).export(file_type=kind)
    if isinstance(data, dict):  # glTF with its numbers in a file of their own
        for name, content in data.items():
            (folder / name).write_bytes(content)
        data = data["model.gltf"]
    if isinstance(data, str):
        data = data.encode()
    ways = TEXT if kind in ("obj", "gltf") else BYTES
    mutate(data, through(folder / f"mesh.{kind}", read_part), ways, 400)
