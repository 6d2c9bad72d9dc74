"""The moving pictures of the README and of the site's first page.

    .venv/bin/python website/films.py [folder]

writes them into docs/pictures. The same code gives the same bytes; all of them take a few seconds.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import drystone as ds
from animated_svg import Film, View, arrow
from drystone.pictures import style

FOLDER = Path(__file__).parent.parent / "docs" / "pictures"


def arch_taken_apart() -> Film:
    """A plan with one hold: which block goes, which one is held, and the forces in what is left."""
    scene = ds.scenes.arch(voussoirs=11, thickness=0.3)
    plan = ds.plan(scene, hold=1)
    view = View((-1.75, -0.12, 1.75, 1.6))
    # Two frames a structure: at rest, and while its next block leaves.
    steps = [k // 2 for k in range(2 * len(plan.order) + 2)]
    film = Film(view, len(steps), 0.6 * len(steps), "An arch is taken apart block by block.")
    film.add(film.polygon(_ground(view), style.GROUND))
    for body in scene.bodies:
        if body.fixed:
            continue
        place = plan.order.index(body.name)
        held = [step < len(plan.holds) and body.name in plan.holds[step] for step in steps]
        fills = [style.NEXT if step == place else style.STONE for step in steps]
        block = film.steps("fill", fills, film.polygon(body.vertices, style.STONE))
        if any(held):
            x, y = view.at(np.array([body.centroid]))[0]
            hand = f'<circle cx="{x:.1f}" cy="{y:.1f}" r="9" fill="{style.HELD}"/>'
            block += film.shown(held, hand)
        film.add(_leaving(film, body, block, 2 * place + 2))
    verdicts = [_held_verdict(plan, step) for step in range(len(plan.order))]
    for step, line in enumerate(_thrust_lines(view, verdicts)):
        shown = [s == step and k % 2 == 0 for k, s in enumerate(steps)]
        film.add(film.shown(shown, line))
    film.say([_plan_line(plan, step) for step in steps])
    return film


def _leaving(film: Film, body: ds.Body, block: str, gone: int) -> str:
    """The block, and how it goes away from the middle of the arch until frame `gone`."""
    x, y = 0.4 * film.view.scale * np.asarray(body.centroid) / np.hypot(*body.centroid)
    before, after = gone, film.frames - gone
    moves = ["translate(0px,0px)"] * before + [f"translate({x:.0f}px,{-y:.0f}px)"] * after
    seen = film.moving(["1"] * before + ["0"] * after, f"<g>{block}</g>", "opacity")
    return film.moving(moves, f"<g>{seen}</g>")


def _held_verdict(plan: ds.Plan, step: int) -> ds.Verdict:
    """The structure on the way, with what is held as fixed as the hand that holds it."""
    scene = ds.Scene(friction=plan.scene.bodies[1].friction)
    held = plan.holds[step]
    for body in plan.scene.bodies:
        if body.fixed or body.name in plan.order[step:]:
            fixed = body.fixed or body.name in held
            scene.add_polygon(body.vertices, name=body.name, fixed=fixed)
    return ds.check(scene)


def _plan_line(plan: ds.Plan, step: int) -> str:
    if step == len(plan.order):
        return "Taken apart. Read backwards, this is how to build it."
    line = f"{len(plan.order) - step} blocks stand"
    if plan.holds[step]:
        line += ", one of them because a hand holds it (red)"
    return f"{line}. Next to go: orange."


def wall_falls() -> Film:
    """A thrown block breaks a dry wall; blocks that have not moved yet are dark."""
    wall = ds.scenes.wall(rows=8, columns=3, friction=0.5)
    world = ds.World(wall, dt=1 / 240)
    for name, x in (("left", -10.5), ("right", 13.5)):  # the wall's own ground ends beside it
        world.add_box((x, -0.25), (20, 0.5), name=name, fixed=True, friction=0.5)
    world.add_box((-2.2, 1.7), (0.6, 0.6), name="thrown", density=15.0)
    world.set_velocity("thrown", (10, 2.5, -3))
    run = world.run(420)
    every = 6
    poses, still = run.poses[::every], run.motionless[::every]
    still = np.concatenate([still, still[-1:]])[: len(poses)]
    view = View((-2.7, -0.3, 6.8, 4.6))
    film = Film(view, len(poses), 3.2, "A thrown block breaks a wall of bricks.")
    film.add(film.polygon(_ground(view), style.GROUND))
    frame = {body.name: body for body in world.scene.bodies}
    for column, name in enumerate(run.names):
        if frame[name].fixed:
            continue
        fills = [style.STILL if rests else style.STONE for rests in still[:, column]]
        if name == "thrown":
            fills = [style.NEXT] * len(fills)
        shape = film.steps("fill", fills, _centred(film, frame[name], poses[-1, column]))
        moves = [_placed(view, pose) for pose in poses[:, column]]
        film.add(film.moving(moves, f"<g>{shape}</g>"))
    film.say([f"{run.dt * every * k:.1f} s. Dark: motionless." for k in range(len(poses))])
    return film


def _centred(film: Film, body: ds.Body, pose: NDArray[np.float64]) -> str:
    """The body's polygon about its centre of mass, not turned."""
    cos, sin = np.cos(pose[2]), np.sin(pose[2])
    arm = (body.vertices - pose[:2]) @ np.array([[cos, -sin], [sin, cos]])
    points = " ".join(f"{x:.1f},{-y:.1f}" for x, y in film.view.scale * arm)
    return f'<polygon points="{points}"/>'


def _placed(view: View, pose: NDArray[np.float64]) -> str:
    x, y = view.at(pose[None, :2])[0]
    return f"translate({x:.1f}px,{y:.1f}px) rotate({-np.degrees(pose[2]):.1f}deg)"


def load_walks_over_an_arch() -> Film:
    """Contact forces while a load walks over an arch, and how much more it would bear."""
    arch = ds.scenes.arch(voussoirs=15, thickness=0.22, friction=0.8)
    weight = sum(body.mass for body in arch.bodies if not body.fixed) * 9.81
    there = list(range(3, 14))
    places = there + there[-2:0:-1]
    load = 0.1 * weight
    view = View((-1.6, -0.12, 1.6, 1.75))
    film = Film(view, len(places), 0.55 * len(places), "The forces in an arch under a moving load.")
    film.add(film.polygon(_ground(view), style.GROUND))
    for body in arch.bodies:
        if not body.fixed:
            film.add(film.polygon(body.vertices, style.STONE))
    lines = {}
    verdicts = []
    for block in there:
        loaded = ds.Scene.from_json(arch.to_json())
        top = max(loaded.body(str(block)).vertices, key=lambda corner: np.hypot(*corner))
        loaded.add_load(str(block), force=(0, -load), at=tuple(top))
        factor = ds.limit(arch, push={str(block): (0, -load)}).factor
        verdicts.append(ds.check(loaded))
        lines[block] = (
            f"A tenth of its weight, on block {block}. It falls under {factor:.1f} times as much."
        )
        shown = [place == block for place in places]
        falls = arrow(view, top + np.array([0, 0.3]), np.array([0, -0.3]), 4.0)
        paint = f'fill="{style.LOAD}" stroke="{style.LOAD}" stroke-width="4"'
        film.add(film.shown(shown, f'<path d="{falls}" {paint}/>'))
    for block, line in zip(there, _thrust_lines(view, verdicts), strict=True):
        film.add(film.shown([place == block for place in places], line))
    film.say([lines[place] for place in places])
    return film


def _thrust_lines(view: View, verdicts: Sequence[ds.Verdict]) -> list[str]:
    """For each verdict the way of the forces through its blocks, thicker where they are larger."""
    answers = [_joints(verdict) for verdict in verdicts]
    strongest = max(force for joints in answers for _, _, force in joints)
    lines = []
    for verdict, joints in zip(verdicts, answers, strict=True):
        line = []
        for body in verdict.scene.bodies:
            met = [(point, force) for pair, point, force in joints if body.name in pair]
            if body.fixed or not met:
                continue
            ends = [point for point, _ in met] + [np.asarray(body.centroid)] * (len(met) < 2)
            (x, y), (u, v) = view.at(np.array(ends[:2]))
            width = 1.5 + 6.5 * max(force for _, force in met) / strongest
            line.append(f'<path d="M{x:.1f} {y:.1f}L{u:.1f} {v:.1f}" stroke-width="{width:.1f}"/>')
        paint = f'stroke="{style.FORCE}" stroke-linecap="round"'
        lines.append(f"<g {paint}>{''.join(line)}</g>")
    return lines


def _joints(verdict: ds.Verdict) -> list[tuple[tuple[str, str], NDArray[np.float64], float]]:
    """Of each pair of bodies that press: their names, where the resultant acts, and its size, N."""
    pairs: dict[tuple[str, str], list[ds.ContactForce]] = {}
    for force in verdict.forces:
        pairs.setdefault((force.a, force.b), []).append(force)
    joints = []
    for pair, forces in pairs.items():
        normal = np.array([force.normal_force for force in forces])
        if normal.sum() > 0:
            point = normal @ np.array([force.point for force in forces]) / normal.sum()
            size = np.linalg.norm(sum(np.asarray(force.force) for force in forces))
            joints.append((pair, point, float(size)))
    return joints


def _ground(view: View) -> NDArray[np.float64]:
    left, bottom, right, _ = view.box
    return np.array([(left, bottom), (right, bottom), (right, 0.0), (left, 0.0)])


FILMS = {
    "arch-taken-apart": arch_taken_apart,
    "wall-falls": wall_falls,
    "load-walks": load_walks_over_an_arch,
}

if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER
    for name, film in FILMS.items():
        path = folder / f"{name}.svg"
        path.write_text(film().svg())
        print(f"{path}: {path.stat().st_size / 1000:.0f} kB")
