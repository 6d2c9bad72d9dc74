"""What anything that the package returns prints of itself in a notebook: one line, however large.

Every public type must be seen here, so that a new one is thought of.
"""

from __future__ import annotations

import contextlib
import dataclasses
import enum
import inspect
from collections.abc import Iterator
from pathlib import Path
from types import MemberDescriptorType
from typing import Any

import numpy as np
import pytest

import drystone as ds

MOST = 300
"""Characters of a line."""

MOST_ENTRIES = 40
"""Of a list this many are looked at."""

PUBLIC = (ds, ds.lcp, ds.contact, ds.meshes, ds.imports, ds.viewer)


def public_types() -> set[type]:
    """All but errors and warnings."""
    named = (getattr(module, name) for module in PUBLIC for name in module.__all__)
    return {x for x in named if inspect.isclass(x) and not issubclass(x, Exception)}


def within(thing: Any, seen: dict[int, Any]) -> Iterator[Any]:
    """A thing of the package, and the things of the package that its attributes hold.

    `seen` keeps all of them, so that no two have the same id.
    """
    if id(thing) in seen or isinstance(thing, str | bytes | np.ndarray | enum.Enum):
        return
    seen[id(thing)] = thing
    if isinstance(thing, list | tuple | ds.ContactForces | ds.ManyPlans):
        for entry in list(thing)[:MOST_ENTRIES]:
            yield from within(entry, seen)
    if type(thing).__module__.startswith("drystone."):
        yield thing
        for name in public_attributes(type(thing)):
            with contextlib.suppress(ds.DrystoneError):  # as contacts of what overlaps
                yield from within(getattr(thing, name), seen)


def public_attributes(kind: type) -> Iterator[str]:
    """Fields, slots and properties."""
    for name in dir(kind):
        held = isinstance(getattr(kind, name), property | MemberDescriptorType)
        if held and not name.startswith("_"):
            yield name
    if dataclasses.is_dataclass(kind):
        yield from (field.name for field in dataclasses.fields(kind) if field.name[0] != "_")


def tongue(jaws: int) -> ds.Scene:
    """A block that many others lock in."""
    scene = ds.Scene(dimension=3, friction=0.5)
    scene.add_box((0, 0, 0.5), (1, jaws, 1), name="tongue")
    for k in range(jaws):
        y = k + 0.5 - jaws / 2
        for side in (-1, 1):
            scene.add_box((side, y, 0.5), (1, 1, 1), name=f"jaw {side} {k}", fixed=True)
            scene.add_box((0, y, 0.5 + side), (1, 1, 1), name=f"lid {side} {k}", fixed=True)
    for side in (-1, 1):
        scene.add_box((0, side * (jaws + 1) / 2, 0.5), (1, 1, 1), fixed=True)
    return scene


def bridges(count: int) -> ds.Scene:
    """Beams in a row, each on two supports of which one sinks."""
    scene = ds.Scene(dimension=3, friction=0.5)
    for k in range(count):
        for side, x in (("left", -2.0), ("right", 2.0)):
            scene.add_box((x + 8 * k, 0, -0.5), (1, 1, 1), name=f"{side} {k}", fixed=True)
        scene.add_box((8 * k, 0, 0.2), (4, 1, 0.4), name=f"beam {k}")
        scene.add_load(f"beam {k}", (0, 0, -1.0), moment=(0.1, 0.2, 0.3))
        scene.add_settlement(f"right {k}", (0, 0, -0.01 - 1e-5 * k))
    return scene


def statics() -> Iterator[Any]:
    """Answers on 200 blocks, all of which move if any does."""
    tower, wall = ds.scenes.column(201, friction=2.0), ds.scenes.wall(14, 14)
    limit = ds.limit(tower, gravity=(9.81, 0))
    assert len(limit.mechanism) == 200
    yield limit
    yield ds.margin(tower)
    yield ds.check(ds.scenes.wall(14, 14, friction=0.0))
    yield ds.check(ds.scenes.arch(20, friction=0.0), strong=True)
    yield ds.Structure(wall, wall.names[1:])
    yield ds.load_cases(wall, [{"9": (1.0, 0.0)}], np.linspace(-1, 1, 200)[:, None])
    yield ds.plan(wall, clear_path=True)
    yield ds.plan(tongue(50), clear_path=True)
    yield ds.check(bridges(66))


def neighbours() -> Iterator[Any]:
    """A block between 200 others that it touches from the side, some too far, some too near."""
    scene = ds.Scene(friction=0.5)
    scene.add_box((0, 100), (1, 200), name="high")
    for k in range(100):
        for side in (-1, 1):
            scene.add_box((side, k + 0.5), (1, 1), name=f"beside {side} {k}", fixed=True)
    scene.add_box((0, -0.5 - 5e-4), (1, 1), name="far", fixed=True)
    yield ds.check(scene)
    scene.add_box((0, 250), (1, 1.2), name="one")
    scene.add_box((0, 251), (1, 1.2), name="two")
    yield scene


def motion() -> Iterator[Any]:
    world = ds.World(ds.scenes.wall(14, 14))
    yield world
    yield world.step()
    run = ds.simulate(ds.scenes.fall7(), steps=30, forces=True)
    yield run
    yield run.view()


def problems() -> Iterator[Any]:
    """Of 200 unknowns."""
    M, q = np.eye(200), np.full(200, -1.0)
    solver = ds.lcp.Solver(M, q)
    solver.add_rows(range(200))
    yield from (solver, solver.solve(), solver.snapshot(), solver.counts)
    yield ds.lcp.Start(np.arange(200), np.ones(200))
    yield ds.contact.solve(np.eye(300), np.eye(300), np.full(100, 0.5), np.full(300, -1.0))


def files(folder: Path) -> Iterator[Any]:
    """A file of 200 objects, and a smooth body of many corners."""
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=3)
    yield ds.meshes.read_part(ball, surface=True)
    yield ds.meshes.read_part(ball, simplify=0.05)
    text, count = "", 0
    for k in range(200):
        box = trimesh.creation.box((1, 1, 1))
        text += f"o block{k}\n"
        text += "".join(f"v {x + 2 * k} {y} {z}\n" for x, y, z in box.vertices)
        text += "".join("f {} {} {}\n".format(*(f + count + 1)) for f in box.faces)
        count += len(box.vertices)
    (folder / "boxes.obj").write_text(text)
    yield ds.imports.load(folder / "boxes.obj")
    scene = ds.Scene(dimension=3, friction=0.5)
    scene.add_surface(ball.vertices, ball.faces, name="ball")
    yield scene
    yield ds.imports.LeftOut("a joint", "it has no place in a scene")


def many() -> Iterator[Any]:
    yield ds.plan_many({f"column {k}": ds.scenes.column(2 + k % 5) for k in range(200)})
    yield ds.plan_many({f"no scene {k}": Path(f"missing{k}.json") for k in range(200)})


def test_every_answer_is_one_line_however_large(tmp_path: Path) -> None:
    roots = (statics(), neighbours(), motion(), problems(), files(tmp_path), many())
    met: set[type] = set()
    long: set[tuple[str, str]] = set()
    seen: dict[int, Any] = {}
    for root in (thing for some in roots for thing in some):
        for thing in within(root, seen):
            met.add(type(thing))
            line = repr(thing)
            if len(line) > MOST or "\n" in line:
                long.add((type(thing).__name__, f"{len(line)} characters: {line[:60]}"))
    assert not dict(long)
    missing = {kind.__name__ for kind in public_types() - met}
    assert not missing, f"no answer of these types was looked at: {missing}"


def test_one_is_not_many() -> None:
    scene = ds.Scene()
    scene.add_box((0, 0), (1, 1), name="alone")
    scene.add_load("alone", (1, 0))
    assert repr(scene) == "<Scene: 1 body, 0 of them fixed, 1 load, friction 0.5>"
    assert repr(scene.view()) == "<Page: plan, 1 frame of 1 body>"
    world = ds.World(scene)
    world.step()
    assert repr(world) == "<World: 1 body after 1 step of 0.004167 s>"
