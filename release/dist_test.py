"""Try the packages in a folder as users install them: in fresh environments, with no tools on PATH.

    python release/dist_test.py dist                       every Python found, and the sdist
    python release/dist_test.py dist --python python3.12   one Python, the wheel only
    python release/dist_test.py dist --tests all           all tests that need no browser (or none)

For each Python: the wheel alone, and what it answers (`tests/python/bare.py`); then with its extras
what README and guide show, and tests of the suite, against what was installed. From the sdist: the
same first part, with Rust and a linker on PATH but no Node.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TESTS = ROOT / "tests" / "python"

EXTRAS = "pictures,meshes,lp,sparse,test"
"""What the tests need, but for Ray: it comes late to new Pythons, and its tests start a cluster."""

SOME = (
    "test_docs.py",
    "test_check.py",
    "test_plan.py",
    "test_structure.py",
    "test_lcp.py",
    "test_contact.py",
    "test_scene.py",
    "test_cli.py",
    "test_copies.py",
    "test_run_files.py",
    "test_pictures.py",
    "test_import_models.py",
)
"""One or two of each part of the package."""

NEED_MORE = (
    "test_viewer_page.py",
    "test_viewer_space.py",
    "test_packaging.py",
    "test_benchmarks.py",
    "test_simulation_benchmark.py",
    "test_many.py",
)
"""A browser, the source tree's own tools, Ray."""

KEPT = (
    *("HOME", "LANG", "TMPDIR", "CARGO_HOME", "RUSTUP_HOME"),
    *("SYSTEMROOT", "USERPROFILE", "APPDATA", "LOCALAPPDATA", "TEMP", "TMP", "PATHEXT"),
)
"""Environment variables that programs need to find their own files; on Windows the second line."""

LARGEST = 16 * 2**20
"""Bytes of the compiled library: a wheel that is larger was not stripped."""


class DistTestError(Exception):
    """A package is not as users need it; the text says which and why."""


def main() -> None:
    given = arguments()
    try:
        wheels = sorted(given.folder.glob("drystone-*.whl"))
        sdists = sorted(given.folder.glob("drystone-*.tar.gz"))
        if not wheels:
            raise DistTestError(f"there is no wheel in {given.folder}: run make wheel")
        for wheel in wheels:
            look_into(wheel)
        pythons = given.python or found_pythons()
        for python in pythons:
            try_wheel(wheels, python, given.tests)
        if sdists and not given.python:
            try_sdist(sdists[-1], pythons[-1])
    except DistTestError as error:
        sys.exit(f"dist-test: {error}")
    print("All packages work.")


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Try packages as users install them.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--python", action="append", help="an interpreter; to be repeated")
    parser.add_argument("--tests", choices=("none", "some", "all"), default="some")
    return parser.parse_args()


def found_pythons() -> list[str]:
    """One interpreter for each version from 3.10 on: on PATH, or where pyenv has them."""
    folders = [Path(folder) for folder in os.get_exec_path()]
    folders += sorted(Path.home().glob(".pyenv/versions/*/bin"))
    found: dict[str, str] = {}
    for folder in folders:
        for path in sorted(folder.glob("python3.*")):
            version = re.fullmatch(r"python3\.(\d\dt?)", path.name)
            # A shim of pyenv is there for versions that are not chosen.
            if version and version[1] not in found and _answers(path):
                found[version[1]] = str(path)
    if not found:
        raise DistTestError("no Python 3.10 or newer was found")
    return [found[version] for version in sorted(found)]


def _answers(python: Path) -> bool:
    code = "import ensurepip, venv"
    try:
        return not subprocess.run([python, "-c", code], capture_output=True, check=False).returncode
    except OSError:
        return False


def look_into(wheel: Path) -> None:
    """What a wheel has to hold, and how large it is."""
    with zipfile.ZipFile(wheel) as archive:
        sizes = {entry.filename: entry.file_size for entry in archive.infolist()}
    wanted = {
        "the viewer's pages": r"drystone/viewer/(page|space)\.html",
        "the licences of others": r"[^/]+\.dist-info/licenses/THIRD-PARTY-NOTICES\.txt",
        "a list of what is linked": r"[^/]+\.dist-info/sboms/.+\.cyclonedx\.json",
        "types": r"drystone/(py\.typed|_core\.pyi)",
    }
    for what, pattern in wanted.items():
        if not any(re.fullmatch(pattern, name) for name in sizes):
            raise DistTestError(f"{wheel.name} lacks {what}")
    library = max(
        (size for name, size in sizes.items() if re.search(r"/_core\..*(so|pyd)$", name)), default=0
    )
    if not 0 < library < LARGEST:
        raise DistTestError(f"the library of {wheel.name} has {library / 2**20:.1f} MiB")
    packed = wheel.stat().st_size / 2**20
    print(f"== {wheel.name}: {packed:.1f} MiB, the library {library / 2**20:.1f} MiB")


class Environment:
    """A fresh virtual environment, and commands in it that see its own folder and `tools` only."""

    def __init__(self, folder: Path, python: str, tools: Sequence[str] = ()) -> None:
        self.work = folder / "work"
        self.work.mkdir()
        subprocess.run([python, "-m", "venv", folder / "venv"], check=True)
        scripts = folder / "venv" / ("Scripts" if os.name == "nt" else "bin")
        self.python = scripts / ("python.exe" if os.name == "nt" else "python")
        links = folder / "tools"
        links.mkdir()
        for name in tools:
            path = shutil.which(name)
            if path is None:
                raise DistTestError(f"{name} is needed to build from the sdist")
            (links / name).symlink_to(path)
        self._variables = {name: os.environ[name] for name in KEPT if name in os.environ}
        self._variables |= {
            name: value
            for name, value in os.environ.items()
            if name.startswith(("PIP_", "SSL_", "OPENBLAS_", "CARGO_"))
        }
        self._variables["PATH"] = os.pathsep.join((str(scripts), str(links)))
        for tool in {"cc", "gcc", "cargo", "node", "npm"} - set(tools):
            if shutil.which(tool, path=self._variables["PATH"]):
                raise DistTestError(f"{tool} is on PATH, where nobody should need it")

    def run(self, what: str, *command: str | Path) -> None:
        """Run Python in the folder `work`; its output is shown if it fails."""
        began = time.monotonic()
        ran = subprocess.run(
            [self.python, *command],
            cwd=self.work,
            env=self._variables,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
        if ran.returncode:
            print(ran.stdout[-8000:])
            raise DistTestError(f"{what} failed")
        last = (ran.stdout.strip().splitlines() or [""])[-1].strip("= ")
        print(f"   {what}: {last[:90]} ({time.monotonic() - began:.0f} s)", flush=True)

    def install(self, *what: str) -> None:
        self.run(
            "pip install", "-m", "pip", "install", "--quiet", "--no-warn-script-location", *what
        )

    def installed_here(self) -> None:
        """The package that is imported is the one of this environment."""
        code = (
            "import drystone, sys; from pathlib import Path; "
            "assert Path(drystone.__file__).is_relative_to(sys.prefix), drystone.__file__; "
            "print(drystone.__version__, 'of', Path(drystone._core.__file__).name)"
        )
        self.run("import", "-W", "error", "-c", code)


def try_wheel(wheels: Sequence[Path], python: str, tests: str) -> None:
    """Alone, then with extras."""
    print(f"== {python}", flush=True)
    with tempfile.TemporaryDirectory(prefix="drystone-") as folder:
        environment = Environment(Path(folder), python)
        binaries, here = ("--only-binary", ":all:"), str(wheels[0].resolve().parent)
        # The one of the folder that fits this Python, and then what it needs.
        environment.install(
            *binaries, "--no-index", "--find-links", here, "--no-deps", "--pre", "drystone"
        )
        environment.install(*binaries, "drystone")
        environment.installed_here()
        environment.run("answers without extras", "-W", "error", TESTS / "bare.py")
        if tests != "none":
            environment.install(*binaries, f"drystone[{EXTRAS}]")
            environment.run("tests", *_tests(tests))


def _tests(which: str) -> list[str | Path]:
    files = [TESTS / name for name in SOME]
    if which == "all":
        files = [path for path in sorted(TESTS.glob("test_*.py")) if path.name not in NEED_MORE]
    options = ("-q", "--rootdir", ROOT, "--config-file", ROOT / "pyproject.toml")
    return ["-m", "pytest", *options, "-p", "no:cacheprovider", *files]


def try_sdist(sdist: Path, python: str) -> None:
    """Built with Rust and a linker, and without Node."""
    print(f"== {sdist.name} on {python}", flush=True)
    with tempfile.TemporaryDirectory(prefix="drystone-") as folder:
        environment = Environment(Path(folder), python, tools=("cargo", "rustc", "cc", "ld", "as"))
        environment.install(str(sdist.resolve()))
        environment.installed_here()
        environment.run("answers without extras", "-W", "error", TESTS / "bare.py")


if __name__ == "__main__":
    main()
