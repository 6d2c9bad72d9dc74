"""Without the packages of the extras: what is asked is answered, what is missing is named."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import drystone as ds
from conftest import ROOT
from drystone.common.compressed import by_columns, by_rows, of_diagonal_blocks, times
from drystone.common.extras import EXTRAS, extra, require

HIDE = f"import runpy, sys; sys.modules.update(dict.fromkeys({EXTRAS['all']!r}))"


def test_what_drystone_alone_answers(tmp_path: Path) -> None:
    bare = Path(__file__).with_name("bare.py")
    code = f"{HIDE}; runpy.run_path({str(bare)!r}, run_name='__main__')"
    ran = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], cwd=tmp_path, capture_output=True, text=True
    )
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "fine\n", "")


def test_every_public_name_is_there_without_extras() -> None:
    code = f"{HIDE}; from drystone import *; print(meshes.MeshError, StaticsError)"
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)


def test_the_extras_are_those_that_are_declared() -> None:
    tomllib = pytest.importorskip("tomllib", reason="Python 3.11 and newer read TOML")
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    for name, packages in EXTRAS.items():
        needs = declared["optional-dependencies"][name]
        if name == "all":
            needs = [one for other in EXTRAS for one in declared["optional-dependencies"][other]]
            needs = [one for one in needs if not one.startswith("drystone")]
        assert {need.partition(">")[0] for need in needs} == set(packages), name


def test_only_a_missing_package_of_the_extra_is_named() -> None:
    with pytest.raises(ModuleNotFoundError, match="No module named 'nowhere'"), extra("lp", "x"):
        import nowhere  # noqa: F401
    inner = ModuleNotFoundError("No module named 'ray.data'", name="ray.data")
    with (
        pytest.raises(ds.DrystoneError, match=r"^things need ray, w") as told,
        extra("ray", "things"),
    ):
        raise inner
    assert isinstance(told.value, ImportError)
    assert told.value.name == "ray"


def test_what_is_required_is_looked_for_and_not_imported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(ds.MissingExtraError, match=r'^pictures need matplotlib, .*"drystone\[pict'):
        require("pictures", "pictures")


@pytest.mark.parametrize("kind", ["csc_array", "csr_matrix", "coo_array"])
def test_compressed_as_scipy_does(kind: str) -> None:
    sparse = pytest.importorskip("scipy.sparse")
    rng = np.random.default_rng(3)
    dense = rng.normal(size=(5, 7)) * (rng.random((5, 7)) < 0.4)
    for make, reference in ((by_columns, sparse.csc_array), (by_rows, sparse.csr_array)):
        wanted = reference(dense)
        for given in (dense, getattr(sparse, kind)(dense), dense.astype(object)):
            made = make(given, "A", ds.LcpError)
            assert made.shape == dense.shape
            assert np.array_equal(made.starts, wanted.indptr)
            assert np.array_equal(made.places, wanted.indices)
            assert np.array_equal(made.values, wanted.data)
    vector = rng.normal(size=7)
    assert np.array_equal(times(by_rows(dense, "A", ds.LcpError), vector), wanted @ vector)
    blocks = rng.normal(size=(3, 2, 2))
    wanted = sparse.csc_array(sparse.block_diag(list(blocks)))
    made = of_diagonal_blocks(blocks)
    assert np.array_equal(made.starts, wanted.indptr)
    assert np.array_equal(made.places, wanted.indices)
    assert np.array_equal(made.values, wanted.data)
    assert of_diagonal_blocks(np.zeros((0, 2, 2))).shape == (0, 0)


def test_repeated_entries_are_added() -> None:
    sparse = pytest.importorskip("scipy.sparse")
    given = sparse.coo_array(([1.0, 2.0, 4.0], ([0, 0, 1], [1, 1, 0])), shape=(2, 2))
    made = by_columns(given, "A", ds.LcpError)
    assert (made.places.tolist(), made.values.tolist()) == ([1, 0], [4.0, 3.0])
    assert given.nnz == 3  # what was given is left alone


def test_pictures_of_notebooks_are_left_out_without_matplotlib(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from drystone.common import later

    def refuse(thing: object) -> SimpleNamespace:
        raise ds.MissingExtraError("pictures need matplotlib")

    monkeypatch.setattr(later, "figure", refuse)
    scene = ds.scenes.column(3)
    assert scene._repr_svg_() is None
    assert ds.check(scene)._repr_svg_() is None
    assert ds.plan(scene)._repr_svg_() is None
