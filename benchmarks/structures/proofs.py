"""Verdicts proved once more, in exact rational arithmetic, by code of its own.

*Stands:* the contact forces, as the numbers that were handed out, lie in Coulomb's cones and leave
each body an imbalance of at most 1e-9 of the largest force on it and 1e-6 of its weight (moments
about the centroid, with half the body's diagonal as the arm); both bounds carry the rounding of the
numbers themselves, 2^-50 of each term.

*Falls:* the accelerations close no contact: at each point the acceleration u of the second body
against the first has u_n >= 0, but for 1e-7 of the fastest and the rounding of the forces over the
body's mass, and the weights' power is above 0.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

import drystone as ds

ROUNDING = Fraction(1, 2**50)


def proves(verdict: ds.Verdict) -> str:
    """ "" if the verdict's own numbers prove it, or else why they do not."""
    return _balance(verdict) if verdict.stable else _fall(verdict)


def _balance(verdict: ds.Verdict) -> str:
    scene = verdict.scene
    bodies = {body.name: body for body in scene.bodies}
    for f in verdict.forces:
        limit = scene_friction(scene, f.a, f.b) * f.normal_force
        if (
            f.normal_force < 0
            or abs(f.tangential_force) > limit * (1 + 1e-9) + 1e-12 * f.normal_force
        ):
            return f"a force of {f.a} on {f.b} is outside the cone"
    for name in verdict.names:
        why = _balanced(bodies[name], [f for f in verdict.forces if name in (f.a, f.b)], scene)
        if why:
            return why
    return ""


def _balanced(body: ds.Body, forces: list[ds.ContactForce], scene: ds.Scene) -> str:
    d = scene.dimension
    center = [Fraction(c) for c in body.centroid]
    weight = [Fraction(body.mass) * Fraction(g) for g in scene.gravity]
    own = Fraction(float(np.linalg.norm([float(w) for w in weight])))
    arm = Fraction(float(np.linalg.norm(np.ptp(np.array(body_corners(body)), axis=0)) / 2))
    total, moment = list(weight), [Fraction(0)] * (1 if d == 2 else 3)
    sizes, largest = sum(map(abs, weight)), own
    for f in forces:
        sign = 1 if f.b == body.name else -1
        force = [sign * Fraction(c) for c in f.force]
        lever = [Fraction(p) - c for p, c in zip(f.point, center, strict=True)]
        total = [t + c for t, c in zip(total, force, strict=True)]
        turn = _cross(lever, force)
        moment = [m + t for m, t in zip(moment, turn, strict=True)]
        sizes += sum(map(abs, force)) * (1 + sum(map(abs, lever)) / arm)
        largest = max(largest, Fraction(float(np.linalg.norm(f.force))))
    allowed = min(largest / 10**9, own / 10**6) + ROUNDING * sizes
    worst = max(*map(abs, total), *(abs(m) / arm for m in moment))
    if worst > allowed:
        return f"forces leave {float(worst / own):.1e} of the weight of {body.name}"
    return ""


def _fall(verdict: ds.Verdict) -> str:
    scene = verdict.scene
    bodies = {body.name: body for body in scene.bodies}
    moving = dict(zip(verdict.names, verdict.accelerations, strict=True))
    d = scene.dimension
    if not verdict.falling:
        return "falls, but nothing is named"
    power, fastest = 0.0, 0.0
    for name in verdict.names:
        power += bodies[name].mass * float(np.dot(moving[name][:d], scene.gravity))
        arm = np.linalg.norm(np.ptp(np.array(body_corners(bodies[name])), axis=0)) / 2
        fastest = max(
            fastest,
            float(np.abs(moving[name][:d]).max()),
            float(arm * np.abs(moving[name][d:]).max()),
        )
    if not power > 0:
        return f"the weights' power is {power:.1e}"
    pressed: dict[str, float] = {}
    for f in verdict.forces:
        for name in (f.a, f.b):
            size = float(np.linalg.norm(f.force)) / bodies[name].mass
            pressed[name] = pressed.get(name, 0.0) + (0.0 if bodies[name].fixed else size)
    for f in verdict.forces:
        at = [_acceleration(bodies, moving, name, f.point, d) for name in (f.a, f.b)]
        opening = float(np.dot(at[1] - at[0], f.normal))
        rounding = 2.0**-48 * (pressed[f.a] + pressed[f.b])
        if opening < -1e-7 * fastest - rounding:
            return f"{f.a} and {f.b} close by {opening / fastest:.1e} of the fastest"
    return ""


def _acceleration(bodies: dict[str, ds.Body], moving: dict, name: str, point: tuple, d: int):
    row = moving.get(name)
    if row is None:
        return np.zeros(d)
    lever = np.array(point) - np.array(bodies[name].centroid)
    if d == 2:
        return row[:2] + row[2] * np.array([-lever[1], lever[0]])
    return row[:3] + np.cross(row[3:], lever)


def _cross(a: list[Fraction], b: list[Fraction]) -> list[Fraction]:
    if len(a) == 2:
        return [a[0] * b[1] - a[1] * b[0]]
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def body_corners(body: ds.Body):
    return body.vertices


def scene_friction(scene: ds.Scene, a: str, b: str) -> float:
    return min(scene.body(a).friction, scene.body(b).friction)
