"""Rapier in the plane and in double precision: the Rust program in `benchmarks/rapier`.

Its settings are its own (four substeps, soft contacts) but for the time step, the friction and
sleeping, which is off. It is compiled with thin link-time optimisation in one unit.

Timed: `PhysicsWorld::step`, by a clock around it in Rust.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

import drystone as ds
from simulators.base import Motion, Simulator, Velocities

FOLDER = Path(__file__).parents[1] / "rapier"
PROGRAM = FOLDER / "target" / "release" / "rapier-benchmark"


class Rapier(Simulator):
    """Rapier2d f64."""

    name = "Rapier2d f64"

    def version(self) -> str:
        """See `Simulator.version`."""
        return self._version if self.missing() == "" else ""

    def missing(self) -> str:
        """See `Simulator.missing`."""
        return "" if shutil.which("cargo") else "Rust's cargo is not installed"

    def __init__(self) -> None:
        manifest = (FOLDER / "Cargo.toml").read_text()
        self._version = manifest.split('rapier2d-f64 = "=')[1].split('"')[0]

    def built(self) -> bool:
        """Whether it can run without `prepare`."""
        return PROGRAM.exists()

    def prepare(self) -> None:
        """Build it; a minute the first time."""
        command = ["cargo", "build", "--release", "--locked", "--quiet"]
        subprocess.run(command, cwd=FOLDER, check=True)

    def run(
        self,
        scene: ds.Scene,
        dt: float,
        steps: int,
        every: int,
        velocities: Velocities | None = None,
    ) -> Motion:
        """See `Simulator.run`."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "scene.json"
            described = json.loads(scene.to_json()) | {"velocities": dict(velocities or {})}
            path.write_text(json.dumps(described))
            command = [str(PROGRAM), str(path), repr(dt), str(steps), str(every)]
            answer = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
        seconds = answer["step_seconds"]
        return Motion(sum(seconds), np.array(answer["frames"]), worst=max(seconds))
