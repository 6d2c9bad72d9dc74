"""MuJoCo: in the plane boxes one metre deep, each on two slides and a hinge; in space free bodies.
Friction cones are pyramids unless elliptic ones are asked for.

Its settings are its own (Newton's method, Euler integration) but for the time step and the
friction. It never sleeps.

Timed: `mj_step` with the number of steps between two looks, by a clock around the call. The call
itself costs a microsecond or two, once for all these steps.
"""

from __future__ import annotations

import json
import time
from collections.abc import Iterable, Sequence
from importlib import metadata
from typing import Any

import numpy as np

import drystone as ds
from judge import axes_of
from simulators.base import Motion, Simulator, Velocities

DEPTH = 1.0
"""Metres: a box has the mass and the inertia of its rectangle."""


class MuJoCo(Simulator):
    """`mujoco` from PyPI."""

    name = "MuJoCo"
    dimensions = (2, 3)

    def __init__(self, cone: str = "pyramidal") -> None:
        self.cone = cone

    def version(self) -> str:
        """See `Simulator.version`."""
        try:
            return metadata.version("mujoco")
        except metadata.PackageNotFoundError:
            return ""

    def missing(self) -> str:
        """See `Simulator.missing`."""
        return "" if self.version() else "the Python package mujoco is not installed"

    def run(
        self,
        scene: ds.Scene,
        dt: float,
        steps: int,
        every: int,
        velocities: Velocities | None = None,
    ) -> Motion:
        """See `Simulator.run`."""
        import mujoco

        bodies = json.loads(scene.to_json())["bodies"]
        model = mujoco.MjModel.from_xml_string(_xml(scene, bodies, dt, self.cone))
        data = mujoco.MjData(model)
        moving = [body["name"] for body in bodies if not body["fixed"]]
        for name, velocity in (velocities or {}).items():
            _start(scene.dimension, moving.index(name), velocity, data)
        states = _states if scene.dimension == 2 else _states_in_space
        frames = [states(bodies, data)]
        seconds = 0.0
        for _ in range(steps // every):
            begin = time.perf_counter()
            mujoco.mj_step(model, data, nstep=every)
            seconds += time.perf_counter() - begin
            frames.append(states(bodies, data))
        return Motion(seconds, np.array(frames))


def _xml(scene: ds.Scene, bodies: list[dict[str, Any]], dt: float, cone: str) -> str:
    """The plane is MuJoCo's x and z. Its y axis points away, so that angles change sign."""
    if scene.dimension == 2:
        gravity, made = (scene.gravity[0], 0.0, scene.gravity[1]), _body
    else:
        gravity, made = scene.gravity, _free_body
    return f"""<mujoco>
  <compiler angle="radian"/>
  <option timestep="{dt!r}" gravity="{_spaced(gravity)}" cone="{cone}"/>
  <size memory="500M"/>
  <default><geom type="box" condim="3"/></default>
  <asset>{"".join(map(_mesh, bodies))}</asset>
  <worldbody>{"".join(made(body, scene.friction) for body in bodies)}</worldbody>
</mujoco>"""


def _spaced(numbers: Iterable[float]) -> str:
    return " ".join(repr(float(x)) for x in numbers)


def _free_body(body: dict[str, Any], friction: float) -> str:
    half = _spaced(side / 2 for side in body["box"]["size"])
    geom = (
        f'<geom size="{half}" density="{body["density"]!r}"'
        f' friction="{body.get("friction", friction)!r} 0 0"/>'
    )
    place = f'pos="{_spaced(body["position"])}" quat="{_spaced(body["orientation"])}"'
    return f"<body {place}>{'' if body['fixed'] else '<freejoint/>'}{geom}</body>"


def _start(dimension: int, place: int, velocity: Sequence[float], data: Any) -> None:
    """Gives a body a velocity; see `_states_in_space`."""
    if dimension == 2:
        data.qvel[3 * place :][:3] = velocity
        return
    axes = axes_of(data.qpos[7 * place :][None, :7], 3)[0]
    data.qvel[6 * place :][:6] = [*velocity[:3], *(axes @ velocity[3:])]


def _states_in_space(bodies: list[dict[str, Any]], data: Any) -> list[Any]:
    """Turning is along the body's own axes in MuJoCo."""
    places, rates = data.qpos.reshape(-1, 7), data.qvel.reshape(-1, 6)
    turning = np.einsum("iax,ia->ix", axes_of(places, 3), rates[:, 3:])
    moved = iter(np.hstack([places, rates[:, :3], turning]))
    begin = [
        np.array([*body["position"], *body["orientation"], *6 * [0.0]], dtype=float)
        for body in bodies
    ]
    return [b if body["fixed"] else next(moved) for body, b in zip(bodies, begin, strict=True)]


def _mesh(body: dict[str, Any]) -> str:
    """The prism of a polygon."""
    if "polygon" not in body:
        return ""
    corners = body["polygon"]["vertices"]
    vertices = [(x, end * DEPTH / 2, y) for end in (-1, 1) for x, y in corners]
    return f'<mesh name="{body["name"]}" vertex="{_spaced(sum(vertices, ()))}"/>'


def _shape(body: dict[str, Any]) -> str:
    if "polygon" in body:
        return f'type="mesh" mesh="{body["name"]}"'
    width, height = body["box"]["size"]
    return f'size="{width / 2!r} {DEPTH / 2!r} {height / 2!r}"'


def _body(body: dict[str, Any], friction: float) -> str:
    x, y = body["position"]
    geom = (
        f'<geom {_shape(body)} density="{body["density"]!r}"'
        f' friction="{body.get("friction", friction)!r} 0 0" euler="0 {-body["angle"]!r} 0"/>'
    )
    joints = '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>'
    joints += '<joint type="hinge" axis="0 -1 0"/>'
    return f'<body pos="{x!r} 0 {y!r}">{"" if body["fixed"] else joints}{geom}</body>'


def _states(bodies: list[dict[str, Any]], data: Any) -> list[list[float]]:
    """Joints count from where the body was put. It is the geom that is turned there, not the body:
    slides go along the axes of the body as it was put."""
    moved = iter(np.hstack([data.qpos.reshape(-1, 3), data.qvel.reshape(-1, 3)]))
    begin = [np.array([*body["position"], body["angle"], 0, 0, 0], dtype=float) for body in bodies]
    return [b if body["fixed"] else b + next(moved) for body, b in zip(bodies, begin, strict=True)]
