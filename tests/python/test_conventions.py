"""What users of Python take for granted: errors by kind, types of options, names of files."""

from __future__ import annotations

import ast
import inspect
import json
import math
import os
import re
import stat
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
import trimesh
from matplotlib.figure import Figure

import drystone as ds
from conftest import ROOT
from drystone.common import choices, cones
from drystone.common.cones import core_cones
from drystone.meshes import objects

SCENE = ds.scenes.column(4)
CUBE = trimesh.creation.box()

WRONG_TYPES: dict[str, tuple[Callable[[], object], str]] = {
    "a name for a scene": (lambda: ds.check("wall.json"), "Scene.load reads a file"),  # type: ignore[arg-type]
    "nothing to plan": (lambda: ds.plan(None), "drystone.Scene"),  # type: ignore[arg-type]
    "nothing to move": (lambda: ds.simulate(3), "drystone.Scene"),  # type: ignore[arg-type]
    "no world": (lambda: ds.World("x"), "drystone.Scene"),  # type: ignore[arg-type]
    "no limit": (lambda: ds.limit(3, gravity=(1, 0)), "drystone.Scene"),  # type: ignore[arg-type]
    "no margin": (lambda: ds.margin(None), "drystone.Scene"),  # type: ignore[arg-type]
    "no structure": (lambda: ds.Structure("x"), "drystone.Scene"),  # type: ignore[arg-type]
    "blocks as one string": (lambda: ds.check(SCENE, "1"), "list of names"),
    "limit of one string": (lambda: ds.limit(SCENE, gravity=(1, 0), blocks="1"), "list of names"),
    "margin of one string": (lambda: ds.margin(SCENE, "1"), "list of names"),
    "structure of one string": (lambda: ds.Structure(SCENE, "1"), "list of names"),
    "numbers for names": (lambda: ds.check(SCENE, [1]), "text"),  # type: ignore[list-item]
    "a number for names": (lambda: ds.check(SCENE, 1), "list of names"),  # type: ignore[arg-type]
    "a list for a name": (lambda: ds.Structure(SCENE).add(["1"]), "text"),  # type: ignore[arg-type]
    "a number for a name": (
        lambda: ds.Scene().add_box((0, 0), (1, 1), name=3),  # type: ignore[arg-type]
        "text",
    ),
    "a number for a place": (lambda: ds.Scene().add_box(3, (1, 1)), "two numbers"),  # type: ignore[arg-type]
    "text for a place": (lambda: ds.Scene().add_box("12", (1, 1)), "two numbers"),  # type: ignore[arg-type]
    "a number for gravity": (lambda: ds.Scene(gravity=9.81), "two numbers"),  # type: ignore[arg-type]
    "no vertices": (lambda: ds.Scene().add_polygon(None), "list of points"),  # type: ignore[arg-type]
    "no pieces": (lambda: ds.Scene(3).add_solid(3), "list of points"),  # type: ignore[arg-type]
    "text for a force": (lambda: SCENE.add_load("1", "ab"), "two numbers"),
    "three for a moment": (lambda: SCENE.add_load("1", moment=(1, 2, 3)), "number"),
    "a number for a push": (lambda: ds.limit(SCENE, {"1": 3}), "2 numbers of force"),  # type: ignore[dict-item]
    "a list for a push": (lambda: ds.limit(SCENE, [1, 2]), "dict"),  # type: ignore[arg-type]
    "text for steps": (lambda: ds.simulate(SCENE, steps="9"), "steps"),  # type: ignore[arg-type]
    "half a step": (lambda: ds.simulate(SCENE, steps=1.5), "steps"),  # type: ignore[arg-type]
    "nothing for dt": (lambda: ds.simulate(SCENE, dt=None), "dt"),  # type: ignore[arg-type]
    "text for hands": (lambda: ds.plan(SCENE, hold="1"), "hold"),  # type: ignore[arg-type]
    "one string of fixed bodies": (lambda: ds.imports.load("a.stl", fixed="ab"), "list of names"),
    "no mesh": (lambda: ds.Scene(3).add_mesh(None), "trimesh"),  # type: ignore[arg-type]
    "no axes": (lambda: SCENE.draw(ax="a.svg"), "axes of matplotlib"),  # type: ignore[arg-type]
    "a figure for axes": (lambda: SCENE.draw(ax=Figure()), "axes of matplotlib"),  # type: ignore[arg-type]
    "axes for a name": (lambda: SCENE.draw(Figure().subplots()), "draw\\(ax=axes\\)"),  # type: ignore[arg-type]
    "no progress": (lambda: ds.plan(SCENE, progress=3), "a function"),  # type: ignore[arg-type]
    "a number for a method": (lambda: ds.check(SCENE, method=3), "text"),  # type: ignore[arg-type]
    "text for seconds": (lambda: ds.plan(SCENE, time_limit=[]), "time_limit"),  # type: ignore[arg-type]
}


@pytest.mark.parametrize("case", WRONG_TYPES)
def test_a_wrong_type_is_a_type_error_that_says_what_is_wanted(case: str) -> None:
    provoke, said = WRONG_TYPES[case]
    with pytest.raises(TypeError, match=said):
        provoke()


NUMBERS: dict[str, tuple[str, Callable[[Any], object]]] = {
    "dimension": ("dimension", lambda x: ds.Scene(x)),
    "gravity": ("gravity", lambda x: ds.Scene(gravity=(x, -9.81))),
    "friction": ("friction", lambda x: ds.Scene(friction=x)),
    "contact tolerance": ("contact_tolerance", lambda x: ds.Scene(contact_tolerance=x)),
    "center": ("center", lambda x: ds.Scene().add_box((x, 0), (1, 1))),
    "size": ("size", lambda x: ds.Scene().add_box((0, 0), (x, 1))),
    "angle": ("angle", lambda x: ds.Scene().add_box((0, 0), (1, 1), x)),
    "density": ("density", lambda x: ds.Scene().add_box((0, 0), (1, 1), density=x)),
    "a box's friction": ("friction", lambda x: ds.Scene().add_box((0, 0), (1, 1), friction=x)),
    "mass": ("mass", lambda x: ds.Scene().add_box((0, 0), (1, 1), mass=x)),
    "inertia": ("inertia", lambda x: ds.Scene().add_box((0, 0), (1, 1), inertia=x)),
    "whether fixed": ("fixed", lambda x: ds.Scene().add_box((0, 0), (1, 1), fixed=x)),
    "a vertex": ("a vertex", lambda x: ds.Scene().add_polygon([(0, 0), (1, 0), (x, 1)])),
    "a corner": ("a vertex", lambda x: ds.Scene(3).add_polyhedron([(x, 0, 0)] * 4)),
    "a cuboid's density": (
        "density",
        lambda x: ds.Scene(3).add_box((0, 0, 0), (1, 1, 1), density=x),
    ),
    "an orientation": (
        "orientation",
        lambda x: ds.Scene(3).add_box((0, 0, 0), (1, 1, 1), orientation=(x, 0, 0, 0)),
    ),
    "a surface": ("vertices", lambda x: ds.Scene(3).add_surface([(x, 0, 0)], [(0, 0, 0)])),
    "its triangles": ("triangles", lambda x: ds.Scene(3).add_surface([(0, 0, 0)], [(x, 0, 0)])),
    "a mesh's density": ("density", lambda x: ds.Scene(3).add_mesh(CUBE, density=x)),
    "a mesh's scale": ("scale", lambda x: ds.Scene(3).add_mesh(CUBE, scale=x)),
    "simplify": ("simplify", lambda x: ds.Scene(3).add_mesh(CUBE, simplify=x)),
    "a mesh's tolerance": ("tolerance", lambda x: ds.Scene(3).add_mesh(CUBE, tolerance=x)),
    "pieces": ("max_pieces", lambda x: ds.Scene(3).add_mesh(CUBE, max_pieces=x)),
    "a load": ("force", lambda x: SCENE.add_load("1", (x, 0))),
    "a moment": ("moment", lambda x: SCENE.add_load("1", moment=x)),
    "pressure": ("pressure", lambda x: SCENE.add_pressure("1", (1, 0), x)),
    "a pair's friction": ("friction", lambda x: SCENE.set_friction("1", "2", x)),
    "depth": ("depth", lambda x: SCENE.extruded(x)),
    "facets": ("facets", lambda x: ds.check(SCENE, facets=x)),
    "a budget": ("strong_budget", lambda x: ds.check(SCENE, strong=True, strong_budget=x)),
    "rows": ("rows", lambda x: ds.check(SCENE).table(x)),
    "a push": ("the push on", lambda x: ds.limit(SCENE, {"1": (x, 0)})),
    "factors": ("factors", lambda x: ds.load_cases(SCENE, [(1, 0)], [(x,)])),
    "a margin's tolerance": ("tolerance", lambda x: ds.margin(SCENE, tolerance=x)),
    "hold": ("hold", lambda x: ds.plan(SCENE, hold=x)),
    "a time limit": ("time_limit", lambda x: ds.plan(SCENE, time_limit=x)),
    "a node limit": ("node_limit", lambda x: ds.plan(SCENE, node_limit=x)),
    "threads": ("threads", lambda x: ds.plan(SCENE, threads=x)),
    "a plan's margin": ("margin", lambda x: ds.plan(SCENE, margin=x)),
    "directions": (
        "directions",
        lambda x: ds.plan(SCENE, clear_path=True, directions=[(x, 1)]),
    ),
    "workers": ("workers", lambda x: ds.plan_many([SCENE], workers=x)),
    "dt": ("dt", lambda x: ds.simulate(SCENE, x, 1)),
    "a world's dt": ("dt", lambda x: ds.World(SCENE, x)),
    "restitution": ("restitution", lambda x: ds.World(SCENE, restitution=x)),
    "Coulomb's law": ("coulomb_tolerance", lambda x: ds.World(SCENE, coulomb_tolerance=x)),
    "a velocity": ("velocity", lambda x: ds.World(SCENE).set_velocity("1", (x, 0, 0))),
    "an impulse": ("impulse", lambda x: ds.World(SCENE).apply_impulse("1", (x, 0))),
    "steps": ("steps", lambda x: ds.World(SCENE).run(x)),
    "built-in scenes": ("column: n", lambda x: ds.scenes.column(x)),
    "an import's scale": ("scale", lambda x: ds.imports.load("cube.stl", scale=x)),
    "an import's density": ("density", lambda x: ds.imports.load("cube.stl", density=x)),
    "mu": ("mu", lambda x: ds.contact.solve(np.eye(2), np.eye(2), x, (0, 0))),
    "scale": ("scale", lambda x: ds.contact.solve(np.eye(2), np.eye(2), 1, (0, 0), scale=x)),
    "q": ("q", lambda x: ds.lcp.solve(np.eye(1), [x])),
    "dpi": ("dpi", lambda x: SCENE.draw("a.png", dpi=x)),
}


@pytest.mark.parametrize("case", NUMBERS)
@pytest.mark.parametrize("text", ["x", "3", b"3"])
def test_text_for_a_number_is_a_type_error_that_names_it(case: str, text: object) -> None:
    what, given = NUMBERS[case]
    with pytest.raises(TypeError, match=rf"{what}\b.* must "):
        given(text)


@pytest.mark.parametrize("case", NUMBERS)
def test_a_number_beyond_all_bounds_is_an_error_too(case: str) -> None:
    with pytest.raises((ds.DrystoneError, ValueError, TypeError)):
        NUMBERS[case][1](10**400)


@pytest.mark.parametrize("kind", [np.float64, np.float32, np.int64])
def test_arrays_are_taken_wherever_numbers_in_a_row_are(kind: type[np.generic]) -> None:
    def row(*numbers: float) -> np.ndarray[Any, Any]:
        return np.array(numbers, dtype=kind)

    scene = ds.Scene(gravity=row(0, -10))
    scene.add_box(row(0, -1), row(8, 2), name="ground", fixed=True)
    scene.add_polygon([row(0, 0), row(1, 0), row(1, 1), row(0, 1)], name="block")
    scene.add_load("block", row(0, -1), at=row(0, 1))
    space = ds.Scene(3)
    space.add_box(row(0, 0, 0), row(1, 1, 1), orientation=row(1, 0, 0, 0), inertia=np.eye(3))
    world = ds.World(scene)
    world.apply_force("block", row(1, 0))
    world.set_velocity("block", row(0, 0, 0))
    assert ds.simulate(scene, steps=1, velocities={"block": row(0, 0, 0)}).finished
    assert ds.limit(scene, push={"block": row(1, 0)}, gravity=row(0, 0)).factor > 0
    assert ds.plan(scene, clear_path=True, directions=np.eye(2, dtype=kind)).found
    many = ds.plan_many([scene], clear_path=True, directions=np.eye(2, dtype=kind))
    assert many[0].found
    assert ds.check(scene.with_gravity(row(0, -1)), blocks=np.array(["block"])).stable


@pytest.mark.parametrize("dpi", [0, 1, -160, 1e5, math.nan])
def test_resolutions_have_bounds(dpi: float, tmp_path: Path) -> None:
    """matplotlib ends the process at one dot for each inch and less."""
    with pytest.raises(ValueError, match="from 10 to 2400"):
        SCENE.draw(tmp_path / "a.png", dpi=dpi)


MISSING: dict[str, Callable[[str], object]] = {
    "a scene": ds.Scene.load,
    "a run": ds.Run.load,
    "a mesh": lambda path: ds.meshes.read_part(path + ".obj"),
    "a mesh as a body": lambda path: ds.Scene(3).add_mesh(path + ".stl"),
    "an assembly": lambda path: ds.imports.load(path + ".json"),
    "a folder of parts": ds.imports.load,
    "scenes to plan": ds.plan_many,
    "a folder to save in": lambda path: SCENE.save(f"{path}/scene.json"),
    "a folder to draw in": lambda path: SCENE.draw(f"{path}/scene.svg"),
}


@pytest.mark.parametrize("what", MISSING)
def test_what_is_missing_is_one_kind_of_error(what: str, tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError) as caught:
        MISSING[what](str(tmp_path / "nothing"))
    assert "nothing" in str(caught.value)


@pytest.mark.skipif(os.name != "posix", reason="modes of files")
def test_files_have_the_mode_that_the_user_gives_new_files(tmp_path: Path) -> None:
    before = os.umask(0o027)
    try:
        SCENE.save(tmp_path / "scene.json")
        SCENE.draw(tmp_path / "scene.svg")
        SCENE.view().save(tmp_path / "scene.html")
        ds.simulate(SCENE, steps=2).save(tmp_path / "run.npz")
        ds.check(SCENE).save(tmp_path / "verdict.json")
    finally:
        os.umask(before)
    for path in tmp_path.iterdir():
        assert stat.S_IMODE(path.stat().st_mode) == 0o640, path


def test_tables_have_numbers_that_people_read() -> None:
    """A block of 2e6 kg is told in meganewtons, and a search in microseconds."""
    scene = ds.Scene()
    scene.add_box((0, -0.5), (4, 1), name="ground", fixed=True)
    scene.add_box((0, 0.5), (1, 1), name="block", density=2e6)
    table = ds.check(scene).table()
    assert "normal [MN]" in table
    assert "9.81 " in table
    assert re.search(r"[\d.]+ (µs|ms) in tests of [\d.]+ (µs|ms)\.", str(ds.plan(scene)))


def test_an_angle_in_degrees_gets_a_hint() -> None:
    with pytest.warns(UserWarning, match=r"angle is 45 radians.*math\.radians"):
        ds.Scene().add_box((0, 0), (1, 1), angle=45)
    ds.Scene().add_box((0, 0), (1, 1), angle=-math.tau)  # a full turn is none of these


@pytest.mark.parametrize("name", ["9", "b2", "0"])
def test_another_number_is_no_suggestion(name: str) -> None:
    with pytest.raises(ds.SceneError) as caught:
        SCENE.body(name)
    assert "did you mean" not in str(caught.value)
    with pytest.raises(ds.SceneError, match='did you mean "ground"'):
        SCENE.body("grund")


RING = np.array([(0, 0), (2, 0), (1, 1.5), (0, 1)], dtype=float)


@pytest.mark.parametrize(
    "make", [lambda r: r[::-1], lambda r: [*r, r[0]], lambda r: [*r[::-1], r[-1]]]
)
def test_a_ring_may_be_closed_and_run_either_way(make: Callable[[Any], Any]) -> None:
    scene = ds.Scene()
    for ring in (RING, make(RING)):
        scene.add_polygon(ring, name=f"{len(scene)}")
    one, other = scene.bodies
    assert one.mass == other.mass
    assert one.centroid == pytest.approx(other.centroid)
    assert len(other.vertices) == 4
    told = json.loads(scene.to_json())
    outline = told["bodies"][0]["polygon"]
    outline["vertices"] = np.asarray(make(np.array(outline["vertices"]))).tolist()
    read = ds.Scene.from_json(json.dumps(told)).bodies[0]
    assert read.mass == one.mass
    assert len(read.vertices) == 4


def _public() -> Iterator[tuple[str, ast.FunctionDef]]:
    """Every function and method that users call."""
    for path in sorted((ROOT / "python/drystone").rglob("*.py")):
        if path.parent.name in ("cli", "paper", "common"):
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ClassDef) and node.name in ds.__all__:
                for inner in node.body:
                    if isinstance(inner, ast.FunctionDef) and not inner.name.startswith("_"):
                        yield f"{node.name}.{inner.name}", inner
            elif isinstance(node, ast.FunctionDef) and node.name in ds.__all__:
                yield node.name, node
    for module in (ds.lcp, ds.contact):
        tree = ast.parse(Path(str(module.__file__)).read_text())
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
                yield f"{module.__name__}.{node.name}", node


def test_public_signatures_say_their_types() -> None:
    """`Any` says nothing; only what is to become JSON has values of any kind."""
    found = dict(_public())
    assert {"check", "plan", "Scene.body", "Run.save"} <= found.keys()
    for name, function in found.items():
        arguments = function.args
        every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
        written = [ast.unparse(a.annotation) for a in every if a.annotation is not None]
        written += [ast.unparse(function.returns)] if function.returns else []
        for text in written:
            assert "Any" not in text.replace("dict[str, Any]", ""), f"{name}: {text}"


def test_options_are_words_that_a_type_checker_knows() -> None:
    for function, names in (
        (ds.check, ["method", "cone", "forces"]),
        (ds.limit, ["cone"]),
        (ds.margin, ["cone", "loads"]),
        (ds.plan, ["test", "cone"]),
        (ds.plan_many, ["engine", "test"]),
        (ds.simulate, ["reuse", "formulation", "cone"]),
        (ds.World, ["reuse", "formulation", "cone"]),
        (ds.Structure, ["cone"]),
        (ds.imports.load, ["up", "split", "joints"]),
    ):
        for name in names:
            parameter = inspect.signature(function).parameters[name]
            words = eval(parameter.annotation, vars(sys.modules[function.__module__]))
            known = [word for one in get_args(words) for word in get_args(one) or (one,)]
            assert len(known) > 1, f"{function.__name__}: {name}"
            assert parameter.default in [*known, None], f"{function.__name__}: {name}"
    assert get_args(choices.Split) == objects.SPLITS
    for word in get_args(cones.ConeOfCheck):
        assert core_cones(8, word, get_args(cones.ConeOfCheck)) == (8, word)


def test_python_dash_m() -> None:
    command = [sys.executable, "-m", "drystone", "--version"]
    ran = subprocess.run(command, capture_output=True, text=True, check=True)
    assert ran.stdout.strip() == ds.__version__


def _drystone(
    *arguments: str, given: str = "", **environment: str
) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "drystone", *arguments],
        input=given,
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, **environment},
    )


def test_standard_input_and_output() -> None:
    made = _drystone("scene", "wall:3,columns=4", "-o", "-")
    assert ds.Scene.from_json(made.stdout).to_json() == ds.scenes.wall(3, 4).to_json()
    checked = _drystone("check", "-", given=made.stdout)
    assert (checked.returncode, checked.stderr) == (0, "")
    assert checked.stdout.startswith("Stands: 13 blocks")
    cut = _drystone("check", "-", given=made.stdout[:100])
    assert cut.returncode == 2
    assert cut.stderr.startswith("drystone: standard input: ")


def test_parameters_behind_a_name_are_known_everywhere(cli: Callable[..., Any]) -> None:
    assert ds.Scene.from_json(cli("scene", "wall:3,4").out).to_json() == (
        ds.scenes.wall(3, 4).to_json()
    )
    wrong = cli("scene", "wall:rowz=3")
    assert wrong.status == 2
    assert "wall has no parameter 'rowz'" in wrong.err


def test_a_shell_completes_commands_and_scenes() -> None:
    """What bash asks when the tab key is pressed."""

    def offered(line: str) -> list[str]:
        asked = _drystone(
            _DRYSTONE_COMPLETE="complete_bash",
            COMP_WORDS=line,
            COMP_CWORD=str(len(line.split()) - 1),
        )
        return asked.stdout.split()

    assert offered("drystone che") == ["check"]
    assert offered("drystone check random") == ["random_stack"]
