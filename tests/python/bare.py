"""What `pip install drystone` alone answers, and what it says where an extra is needed.

A program: `test_extras.py` runs it with everything else hidden, `release/dist_test.py` in
environments that have nothing else. It writes into the folder it is run in, and prints "fine".
"""

from __future__ import annotations

import contextlib
import io
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np

import drystone as ds
from drystone.cli import run


def main() -> None:
    answers()
    pages()
    problems()
    missing()
    command_line()
    print("fine")


def answers() -> None:
    """In the plane and in space."""
    scene = ds.scenes.arch()
    assert ds.check(scene).stable
    assert scene._repr_svg_() is None  # a notebook shows the text instead
    assert "normal" in ds.check(scene).table()
    assert ds.plan(ds.scenes.column(4)).order == ("3", "2", "1")
    assert ds.check(ds.scenes.brick_wall(3, 4)).stable
    tower = ds.scenes.column(4, friction=0.5)
    assert ds.margin(tower).acceleration > 0
    assert ds.limit(tower, push={"3": (1, 0)}).factor > 0
    run_ = ds.simulate(ds.scenes.falling_column(), steps=3)
    run_.save("run.npz")
    assert ds.Run.load("run.npz").steps == 3
    scene.save("arch.json")
    assert ds.Scene.load("arch.json").names == scene.names


def pages() -> None:
    """Pages need nothing else: they draw themselves in the browser."""
    ds.plan(ds.scenes.column(4)).view().save("plan.html")
    ds.plan(ds.scenes.brick_wall(2, 2)).view().save("space.html")
    ds.simulate(ds.scenes.falling_column(), steps=2).view().save("run.html")
    assert all(Path(name).stat().st_size > 10_000 for name in ("plan.html", "space.html"))


def problems() -> None:
    """Matrices of NumPy."""
    solution = ds.lcp.solve(np.array([[2.0, 1.0], [1.0, 2.0]]), [-5, -6])
    assert np.allclose(solution.z, [4 / 3, 7 / 3])
    J = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
    assert ds.contact.solve(2 * np.eye(3), J, 0.1, free=[3, 4, -0.1]).status == "solved"


def missing() -> None:
    """One line each that says what to install."""
    scene = ds.scenes.column(3)
    Path("part.stl").write_text("solid part\nendsolid part\n")
    needs: dict[str, list[Callable[[], object]]] = {
        "pictures": [
            lambda: scene.draw("x.svg"),
            lambda: ds.check(scene).draw("x.png"),
            lambda: ds.plan(scene).draw("x.svg"),
            lambda: scene.view().save_frames("frames"),
        ],
        "meshes": [
            lambda: ds.Scene(dimension=3).add_mesh("part.stl"),
            lambda: ds.imports.load("part.stl"),
        ],
        "lp": [lambda: ds.plan(scene, test="lp"), lambda: ds.plan(scene, test="lp-warm")],
        "ray": [lambda: ds.plan_many([scene], engine="ray")],
    }
    for extra, calls in needs.items():
        for call in calls:
            said = _refusal(call)
            assert said.endswith(f'pip install "drystone[{extra}]"'), said
            assert "\n" not in said


def _refusal(call: Callable[[], object]) -> str:
    try:
        call()
    except ds.MissingExtraError as error:
        return str(error)
    raise AssertionError("it needs no extra")


def command_line() -> None:
    assert _ran("check", "arch")[0] == 0
    assert _ran("check", "arch:thickness=0.05")[0] == 1
    status, out, _ = _ran("plan", "pyramid:4", "--json")
    assert (status, json.loads(out)["status"]) == (0, "found")
    for arguments, extra in (
        (("check", "arch", "-o", "x.svg"), "pictures"),
        (("plan", "pyramid:4", "-o", "x.png"), "pictures"),
        (("plan", "pyramid:4", "--test", "lp"), "lp"),
        (("import", "part.stl", "-o", "x.json"), "meshes"),
        (("bench", "paper"), "all"),
    ):
        status, out, err = _ran(*arguments)
        assert (status, out, err.count("\n")) == (2, "", 1), (arguments, status, out, err)
        assert f'pip install "drystone[{extra}]"' in err, err
    status, out, err = _ran("check", "part.stl")
    assert (status, out) == (2, "")
    assert "drystone import" in err


def _ran(*arguments: str) -> tuple[int, str, str]:
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = run(list(arguments))
    return status, out.getvalue(), err.getvalue()


if __name__ == "__main__":
    main()
