"""Small CAD assemblies with known orders and ways out, made by solid modelling in millimetres.

Each shows one thing that parts do to each other: fit without clearance or with a tenth of a
millimetre, slide, screw, lock, nest, mesh. `tests/python/test_cad_assemblies.py` holds every one to
what is said of it here; `cad_gallery.py` draws them.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

import manifold3d
import numpy as np
import trimesh

import drystone as ds

Solid = manifold3d.Manifold
Way = tuple[float, float, float]

UP: Way = (0, 0, 1)
ALONG_X: tuple[Way, ...] = ((1, 0, 0), (-1, 0, 0))
ALONG_Y: tuple[Way, ...] = ((0, 1, 0), (0, -1, 0))
SECTIONS = 32
"""Sides of a cylinder."""

MILLIMETRES = 0.001


@dataclass(frozen=True)
class Assembly:
    """Parts, and what is known of taking them apart along straight ways."""

    title: str
    parts: dict[str, Solid]
    fixed: tuple[str, ...]
    before: tuple[tuple[str, str], ...] = ()
    """Pairs of parts: the first has to leave before the second."""
    ways: dict[str, tuple[Way, ...]] = field(default_factory=dict)
    """The only directions in which a part can leave."""
    options: dict[str, Any] = field(default_factory=dict)
    """What `drystone.plan` is told beside `clear_path=True`."""
    obstacles: dict[str, Solid] = field(default_factory=dict)
    """Bodies that are only in the way."""
    status: str = "found"
    without: str | None = None
    """The status without these options and obstacles, if it differs."""

    def scene(self) -> ds.Scene:
        """Its parts, in metres."""
        return scene_of(self.parts, self.fixed)

    def plan(self, *, asked: bool = True) -> ds.Plan:
        """How it comes apart; with nothing `asked` for, parts leave alone and by one move."""
        if not asked:
            return ds.plan(self.scene(), clear_path=True)
        options = dict(self.options)
        if self.obstacles:
            options["obstacles"] = scene_of(self.obstacles, tuple(self.obstacles))
        return ds.plan(self.scene(), clear_path=True, **options)


def scene_of(
    parts: dict[str, Solid], fixed: Iterable[str], surface: bool | None = None
) -> ds.Scene:
    """Parts in millimetres as bodies in metres, of steel; `surface` as of `Scene.add_mesh`."""
    scene = ds.Scene(dimension=3, friction=0.3, contact_tolerance=1e-6)
    for name, solid in parts.items():
        made = solid.to_mesh64()
        mesh = trimesh.Trimesh(made.vert_properties[:, :3], made.tri_verts, process=False)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ds.meshes.MeshWarning)  # which parts are surfaces
            scene.add_mesh(
                mesh,
                name=name,
                scale=MILLIMETRES,
                fixed=name in fixed,
                density=7800.0,
                surface=surface,
            )
    return scene


def box(x0: float, x1: float, y0: float, y1: float, z0: float, z1: float) -> Solid:
    """A cuboid between two corners."""
    return Solid.cube((x1 - x0, y1 - y0, z1 - z0)).translate((x0, y0, z0))


def cylinder(radius: float, z0: float, z1: float, x: float = 0, y: float = 0) -> Solid:
    """Upright."""
    return Solid.cylinder(z1 - z0, radius, radius, SECTIONS).translate((x, y, z0))


def across(radius: float, y0: float, y1: float, x: float = 0, z: float = 0) -> Solid:
    """A cylinder along y."""
    lying = Solid.cylinder(y1 - y0, radius, radius, SECTIONS).rotate((-90, 0, 0))
    return lying.translate((x, y0, z))


def upright(outline: Any, z0: float, z1: float) -> Solid:
    """A prism over an outline (x, y)."""
    section = manifold3d.CrossSection([np.asarray(outline, dtype=float)])
    return Solid.extrude(section, z1 - z0).translate((0, 0, z0))


def along_x(outline: Any, x0: float, x1: float, inset: float = 0) -> Solid:
    """A prism along x with a section (y, z), smaller by `inset` on all sides and let down by it."""
    section = manifold3d.CrossSection([np.asarray(outline, dtype=float)])
    if inset:
        section = section.offset(-inset, manifold3d.JoinType.Miter).translate((0, -inset))
    turned = Solid.extrude(section, x1 - x0).rotate((90, 0, 90))
    return turned.translate((x0, 0, 0))


def gear(teeth: int, pitch: float, turn: float, z0: float, z1: float) -> Solid:
    """A spur gear with straight flanks; at `pitch` from the middle teeth are as wide as gaps."""
    corners = []
    for tooth in range(teeth):
        for share, radius in ((-0.34, -2.2), (-0.13, 1.8), (0.13, 1.8), (0.34, -2.2)):
            angle = turn + 2 * np.pi * (tooth + share) / teeth
            corners.append(((pitch + radius) * np.cos(angle), (pitch + radius) * np.sin(angle)))
    return upright(corners, z0, z1)


def peg(clearance: float) -> Assembly:
    """A round peg in a blind hole of as many sides."""
    block = box(-20, 20, -20, 20, 0, 30) - cylinder(10, 10, 31)
    return Assembly(
        f"Peg in a blind hole, clearance {clearance:g} mm",
        {"block": block, "peg": cylinder(10 - clearance, 10, 45)},
        fixed=("block",),
        ways={"peg": (UP,)},
    )


def square_peg() -> Assembly:
    """A square peg without clearance, turned by 20 degrees."""
    block = box(-20, 20, -20, 20, 0, 30) - box(-8, 8, -8, 8, 10, 31).rotate((0, 0, 20))
    return Assembly(
        "Square peg, turned, no clearance",
        {"block": block, "peg": box(-8, 8, -8, 8, 10, 45).rotate((0, 0, 20))},
        fixed=("block",),
        ways={"peg": (UP,)},
    )


DOVETAIL = ((-12, 10), (12, 10), (6, 20), (-6, 20))


def dovetail(clearance: float) -> Assembly:
    """A slide that is wider below than above."""
    rail = box(-40, 40, -20, 20, 0, 20) - along_x(DOVETAIL, -41, 41) - box(-41, 41, -6, 6, 19, 21)
    return Assembly(
        f"Dovetail, clearance {clearance:g} mm",
        {"rail": rail, "slide": along_x(DOVETAIL, -15, 15, clearance)},
        fixed=("rail",),
        ways={"slide": ALONG_X},
    )


def screws() -> Assembly:
    """A cover held by four screws, as cylinders with heads."""
    places = [(x, y) for x in (-20, 20) for y in (-12, 12)]
    base, cover = box(-30, 30, -20, 20, 0, 12), box(-30, 30, -20, 20, 12, 16)
    parts = {}
    for number, (x, y) in enumerate(places):
        base -= cylinder(2.5, 3, 13, x, y)
        cover -= cylinder(2.6, 11, 17, x, y)
        parts[f"screw {number}"] = cylinder(2.5, 3, 16, x, y) + cylinder(5, 16, 19, x, y)
    names = tuple(parts)
    return Assembly(
        "Cover and four screws",
        {"base": base, "cover": cover, **parts},
        fixed=("base",),
        before=tuple((name, "cover") for name in names),
        ways=dict.fromkeys((*names, "cover"), (UP,)),
    )


def clevis() -> Assembly:
    """A rod's eye between two lugs, and the pin through all three."""
    fork = box(-12, 12, -20, 20, 0, 40) - box(-13, 13, -8, 8, 10, 41)
    fork -= across(5, -21, 21, 0, 25)
    rod = box(-12, 12, -8, 8, 10, 70) - across(5, -9, 9, 0, 25)
    pin = across(5, -20, 20, 0, 25) + across(8, 20, 25, 0, 25)
    return Assembly(
        "Clevis, rod and headed pin",
        {"fork": fork, "rod": rod, "pin": pin},
        fixed=("fork",),
        before=(("pin", "rod"),),
        ways={"pin": ((0, 1, 0),)},
    )


def snapped() -> Assembly:
    """A lid that has snapped under a lip: rigid, it never comes out."""
    case = (
        box(-25, 25, -20, 20, 0, 20) - box(-22, 22, -17, 17, 5, 15) - box(-19, 19, -14, 14, 14, 21)
    )
    lid = box(-22, 22, -17, 17, 5, 13) + box(-19, 19, -14, 14, 12, 20)
    return Assembly(
        "Lid snapped under a lip", {"case": case, "lid": lid}, fixed=("case",), status="locked"
    )


def shells() -> Assembly:
    """A core in a cup with a lid, in a larger cup with a lid."""

    def cup(radius: float, z0: float, z1: float) -> Solid:
        return cylinder(radius, z0, z1) - cylinder(radius - 3, z0 + 3, z1 + 1)

    def lid(radius: float, z0: float, z1: float) -> Solid:
        return cylinder(radius, z0, z1) - cylinder(radius - 3, z0 - 1, z1 - 3)

    parts = {
        "outer cup": cup(30, 0, 30),
        "outer lid": lid(30, 30, 60),
        "inner cup": cup(20, 3, 28),
        "inner lid": lid(20, 28, 52),
        "core": cylinder(10, 6, 40),
    }
    order = ("outer lid", "inner lid", "core", "inner cup")
    return Assembly(
        "Shells in shells",
        parts,
        fixed=("outer cup",),
        before=(("outer lid", "inner lid"), ("outer lid", "core"), ("inner lid", "inner cup")),
        ways=dict.fromkeys(order[1:], (UP,)),
    )


def gears() -> Assembly:
    """Two gears in mesh on the shafts of a plate."""
    one, other = gear(16, 20, 0.0, 6, 14), gear(16, 20, np.pi / 16, 6, 14).translate((40.4, 0, 0))
    plate = box(-30, 70, -30, 30, 0, 6) + cylinder(5, 6, 20) + cylinder(5, 6, 20, 40.4)
    return Assembly(
        "Two gears in mesh",
        {
            "plate": plate,
            "driver": one - cylinder(5, 5, 15),
            "driven": other - cylinder(5, 5, 15, 40.4),
        },
        fixed=("plate",),
        ways={"driver": (UP,), "driven": (UP,)},
    )


def hinged_box() -> Assembly:
    """A lid on a box, and the pin of its hinge."""
    case = box(-30, 30, -20, 20, 0, 30) - box(-27, 27, -17, 17, 3, 31)
    lid = box(-30, 30, -20, 20, 30, 34)
    for y0, y1 in ((-18, -6), (6, 18)):
        case += box(30, 40, y0, y1, 24, 30) + across(5, y0, y1, 35, 30)
    lid += box(29, 35, -6, 6, 30, 34) + across(5, -6, 6, 35, 30)
    hole = across(2, -21, 21, 35, 30)
    return Assembly(
        "Box, lid and hinge pin",
        {
            "box": case - hole,
            "lid": lid - box(29, 41, -18.01, -6, 29, 36) - box(29, 41, 6, 18.01, 29, 36) - hole,
            "pin": across(2, -20, 20, 35, 30),
        },
        fixed=("box",),
        before=(("pin", "lid"),),
        ways={"pin": ALONG_Y},
    )


def drawers() -> Assembly:
    """Two drawers one above the other in a cabinet, a stop behind a third part."""
    cabinet = (
        box(-30, 30, -20, 20, 0, 40) - box(-27, 31, -17, 17, 3, 18) - box(-27, 31, -17, 17, 21, 37)
    )
    drawer = {}
    for name, z in (("lower drawer", 3), ("upper drawer", 21)):
        drawer[name] = box(-27, 30, -17, 17, z, z + 14) - box(-24, 27, -14, 14, z + 3, z + 15)
    inside = box(-10, 10, -5, 5, 6, 12)
    return Assembly(
        "Two drawers, and what lies in one",
        {"cabinet": cabinet, **drawer, "thing": inside},
        fixed=("cabinet",),
        ways=dict.fromkeys(drawer, ((1, 0, 0),)),
        options={"together": 2},
        without="locked",
    )


def ball_joint() -> Assembly:
    """A ball in a socket that reaches above its middle, which a cap makes."""
    ball = Solid.sphere(15, SECTIONS)
    lower = cylinder(25, -25, 0) - ball
    cap = cylinder(25, 0, 10) - ball
    return Assembly(
        "Ball joint with a cap",
        {"socket": lower, "cap": cap, "ball": ball + cylinder(6, 0, 40)},
        fixed=("socket",),
        before=(("cap", "ball"),),
        ways={"cap": (UP,)},
    )


def tee_slot() -> Assembly:
    """A bolt's head in a slot of a table, with a washer over its shank."""
    section = [(-8, 5), (8, 5), (8, 12), (4, 12), (4, 21), (-4, 21), (-4, 12), (-8, 12)]
    table = box(-40, 40, -20, 20, 0, 20) - along_x(section, -20, 41)
    bolt = box(-8, 8, -8, 8, 5, 12) + cylinder(4, 12, 40)
    stop = box(20, 28, -12, 12, 20, 30)
    return Assembly(
        "Bolt in a T-slot, washer and stop",
        {
            "table": table,
            "bolt": bolt,
            "washer": cylinder(9, 20, 23) - cylinder(4, 19, 24),
            "stop": stop,
        },
        fixed=("table",),
        before=(("washer", "bolt"),),
        ways={"bolt": ((1, 0, 0),)},
    )


def boards() -> Assembly:
    """Three boards, tongue in groove, between a wall and two cheeks."""
    frame = box(-5, 100, -35, 35, -5, 0) + box(-5, 0, -35, 35, -1, 10)
    frame += box(-5, 100, -35, -30, -1, 10) + box(-5, 100, 30, 35, -1, 10)
    groove = box(-1, 5, -31, 31, 3, 7)
    parts = {"frame": frame + box(-1, 5, -30, 30, 3, 7)}
    for number in range(3):
        board = box(0, 30, -30, 30, 0, 10) - groove + box(29, 35, -30, 30, 3, 7)
        parts[f"board {number}"] = board.translate((30 * number, 0, 0))
    return Assembly(
        "Boards, tongue in groove",
        parts,
        fixed=("frame",),
        before=(("board 2", "board 1"), ("board 1", "board 0")),
        ways={f"board {number}": ((1, 0, 0),) for number in range(3)},
    )


def jigsaw() -> Assembly:
    """Two plates with a mushroom of one in the other, on a table."""
    knob = box(-1, 8, -4, 4, 0, 8) + cylinder(7, 0, 8, 12)
    left, right = box(-30, 0, -20, 20, 0, 8) + knob, box(0, 30, -20, 20, 0, 8) - knob
    frame = (
        box(-35, 35, -25, 25, -5, 0) + box(-35, -30, -25, 25, -1, 8) + box(30, 35, -25, 25, -1, 8)
    )
    frame += box(-35, 35, -25, -20, -1, 8) + box(-35, 35, 20, 25, -1, 8)
    return Assembly(
        "Two jigsaw pieces in a tray",
        {"tray": frame, "left": left, "right": right},
        fixed=("tray",),
        ways={"left": (UP,), "right": (UP,)},
    )


def key() -> Assembly:
    """A hub on a shaft, with a key in pockets of both."""
    shaft = cylinder(20, 0, 5) + cylinder(10, 5, 60)
    pocket = box(6, 13, -2, 2, 10, 25)
    hub = cylinder(20, 5, 30) - cylinder(10, 4, 31) - box(6, 13, -2, 2, 4, 25)
    return Assembly(
        "Hub, shaft and key",
        {"shaft": shaft - pocket, "hub": hub, "key": pocket},
        fixed=("shaft",),
        before=(("hub", "key"),),
        ways={"hub": (UP,), "key": ((1, 0, 0),)},
    )


def piston() -> Assembly:
    """Piston, pin and rod in their cylinder: each keeps the next one in; only all three leave."""
    sleeve = box(-20, 20, -20, 20, 0, 60) - cylinder(15, 5, 61)
    bore = across(3, -16, 16, 0, 45)
    head = (cylinder(15, 35, 55) - box(-5, 5, -5, 5, 34, 50)) - bore
    pin = bore ^ cylinder(15, 35, 55)
    rod = box(-5, 5, -5, 5, 5, 50) - bore
    return Assembly(
        "Piston, pin and rod in a cylinder",
        {"cylinder": sleeve, "piston": head, "pin": pin, "rod": rod},
        fixed=("cylinder",),
        ways=dict.fromkeys(("piston", "pin", "rod"), (UP,)),
        options={"together": 3},
        without="locked",
    )


def corner() -> Assembly:
    """A slider in a tunnel that ends below a shaft: back first, then up."""
    case = box(-40, 40, -15, 15, 0, 40) - box(-35, 35, -8, 8, 5, 20) - box(-35, -15, -8, 8, 10, 41)
    return Assembly(
        "Round the corner",
        {"case": case, "slider": box(15, 35, -8, 8, 5, 20)},
        fixed=("case",),
        ways={"slider": ((-1, 0, 0),)},
        options={"moves": 2},
        without="locked",
    )


def tenon() -> Assembly:
    """A tenon through a post, and the wedge that keeps it there."""
    post = box(-10, 10, -15, 15, 0, 80) - box(-11, 11, -6, 6, 40, 60) + box(-20, 90, -20, 20, -5, 0)
    beam = box(10, 80, -10, 10, 36, 64) + box(-30, 10, -6, 6, 40, 60)
    slot = box(-16, -10, -3, 3, 39, 61)
    stand = box(70, 80, -15, 15, 0, 36)
    return Assembly(
        "Tenon and wedge",
        {
            "post": post,
            "beam": beam - slot,
            "wedge": box(-16, -10, -3, 3, 36, 60) + box(-16, -10, -5, 5, 60, 66),
            "stand": stand,
        },
        fixed=("post",),
        before=(("wedge", "beam"), ("beam", "stand")),
        ways={"wedge": (UP,), "beam": ((1, 0, 0),)},
    )


def fixture() -> Assembly:
    """A part between the jaws of a vice, under a clamp's arm that only is in the way."""
    vice = (
        box(-30, 30, -20, 20, 0, 10) + box(-30, -10, -20, 20, 9, 30) + box(10, 30, -20, 20, 9, 30)
    )
    return Assembly(
        "In a vice, below an arm",
        {"vice": vice, "part": box(-10, 10, -10, 10, 10, 25)},
        fixed=("vice",),
        ways={"part": ALONG_Y},
        obstacles={"arm": box(-5, 5, -5, 5, 40, 60)},
    )


def washers() -> Assembly:
    """Rings on a post."""
    parts = {"post": cylinder(25, 0, 5) + cylinder(8, 5, 50)}
    for number in range(5):
        z = 5 + 6 * number
        parts[f"ring {number}"] = cylinder(20 - 2 * number, z, z + 6) - cylinder(8, z - 1, z + 7)
    return Assembly(
        "Rings on a post",
        parts,
        fixed=("post",),
        before=tuple((f"ring {k + 1}", f"ring {k}") for k in range(4)),
        ways={f"ring {k}": (UP,) for k in range(5)},
    )


ASSEMBLIES: dict[str, Callable[[], Assembly]] = {
    "peg": lambda: peg(0),
    "peg-loose": lambda: peg(0.1),
    "peg-square": square_peg,
    "dovetail": lambda: dovetail(0),
    "dovetail-loose": lambda: dovetail(0.1),
    "screws": screws,
    "clevis": clevis,
    "snapped": snapped,
    "shells": shells,
    "gears": gears,
    "hinged-box": hinged_box,
    "drawers": drawers,
    "ball-joint": ball_joint,
    "tee-slot": tee_slot,
    "boards": boards,
    "jigsaw": jigsaw,
    "key": key,
    "piston": piston,
    "corner": corner,
    "tenon": tenon,
    "fixture": fixture,
    "washers": washers,
}
"""Twenty-two, by name."""
