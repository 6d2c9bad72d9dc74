"""The commands. Anything heavy is imported inside the command that needs it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from drystone.cli.errors import InputError
from drystone.cli.flags import App
from drystone.cli.options import (
    AsJson,
    Block,
    Blocks,
    Cone,
    ConeOfCheck,
    Facets,
    File,
    Picture,
    Pyramid,
)
from drystone.cli.scene import scene_app
from drystone.common.choices import Joints, Split, Up
from drystone.equilibrium.contact_force import WhichForces
from drystone.equilibrium.margins import LoadsUnder
from drystone.many.engines import EngineName
from drystone.motion.modes import Formulation, Reuse
from drystone.planning.answer import MOST_HELD
from drystone.planning.search import OrderOfPlan, StabilityTest

app = App(
    help="Does it stand, how does it move, and in which order can it be taken apart? "
    "Exact contact dynamics of stacked rigid bodies.",
    no_args_is_help=True,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.add_typer(scene_app, name="scene")


@app.callback(invoke_without_command=True)
def root(
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> int:
    """The options that belong to no command."""
    if version:
        from drystone import _core

        print(_core.__version__)
        raise typer.Exit
    return 0


@app.command()
def check(
    scene: File,
    blocks: Blocks = None,
    block: Block = None,
    as_json: AsJson = False,
    output: Picture = None,
    facets: Facets = 8,
    cone: ConeOfCheck = "round",
    forces: Annotated[
        WhichForces | None,
        typer.Option(
            help="Which of many possible forces: those of least norm (the default up to 20,000 "
            "contact points), or any, which takes less time."
        ),
    ] = None,
    strong: Annotated[
        bool,
        typer.Option("--strong", help="Must it stand? Looks for another motion than rest as well."),
    ] = False,
    strong_budget: Annotated[
        int | None,
        typer.Option(
            min=1,
            metavar="NODES",
            help="Most nodes of that search, however long they take. By default it ends after some "
            "20 seconds' work.",
        ),
    ] = None,
    settle: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SUPPORT:X,Y[,TURN]",
            help="Let a support settle by so many metres and radians, beside what the scene says. "
            "May be repeated. In space SUPPORT:X,Y,Z[,RX,RY,RZ].",
        ),
    ] = None,
) -> int:
    """Does it stand? With which contact forces; if not, how does it begin to fall?"""
    from drystone.cli import check as command

    return command.run(
        scene, blocks, block, as_json, output, facets, cone, forces, strong, strong_budget, settle
    )


@app.command()
def limit(
    scene: File,
    push: Annotated[
        list[str] | None,
        typer.Option(
            metavar="BLOCK:FX,FY[,M]",
            help="Push a block with this force, N, and moment, N m. May be repeated. "
            "In space BLOCK:FX,FY,FZ[,MX,MY,MZ].",
        ),
    ] = None,
    gravity: Annotated[
        str | None, typer.Option(metavar="X,Y[,Z]", help="An acceleration added to gravity, m/s².")
    ] = None,
    blocks: Blocks = None,
    block: Block = None,
    as_json: AsJson = False,
    output: Picture = None,
    facets: Facets = 8,
    cone: Cone = "round",
) -> int:
    """How much of a push does it bear, and how does it collapse then?"""
    from drystone.cli import limit as command

    return command.run(scene, push, gravity, blocks, block, as_json, output, facets, cone)


@app.command()
def margin(
    scene: File,
    blocks: Blocks = None,
    block: Block = None,
    loads: Annotated[
        LoadsUnder,
        typer.Option(
            help="Whether permanent loads stay as they are, or turn and accelerate as weights do."
        ),
    ] = "stay",
    tolerance: Annotated[
        float, typer.Option(help="In space: how exact the answer has to be, in parts of g.")
    ] = 1e-3,
    as_json: AsJson = False,
    output: Picture = None,
    facets: Facets = 8,
    cone: Cone = "round",
) -> int:
    """Which horizontal acceleration or tilt brings it down, and how much friction does it need?"""
    from drystone.cli import margin as command

    return command.run(scene, blocks, block, loads, tolerance, as_json, output, facets, cone)


@app.command()
def plan(
    scene: File,
    test: Annotated[
        StabilityTest, typer.Option(help="How to decide whether a structure stands.")
    ] = "reuse",
    node_limit: Annotated[int | None, typer.Option(min=0, help="Stop after so many tests.")] = None,
    time_limit: Annotated[
        float | None, typer.Option(min=0.0, help="Stop after so many seconds.")
    ] = None,
    shortcuts: Annotated[
        bool, typer.Option(help="Learn from each collapse, and leave out what must fall too.")
    ] = True,
    threads: Annotated[
        int | None, typer.Option(min=1, help="Threads for one scene; by default one for each core.")
    ] = None,
    hold: Annotated[
        int,
        typer.Option(
            min=0,
            max=MOST_HELD,
            help="Blocks that may be held at a time if there is no order without.",
        ),
    ] = 0,
    clear_path: Annotated[
        bool,
        typer.Option(
            "--clear-path", help="Every block must be able to leave along a straight line."
        ),
    ] = False,
    margin: Annotated[
        float,
        typer.Option(min=0.0, metavar="G", help="Every structure bears this acceleration, in g."),
    ] = 0.0,
    order: Annotated[
        OrderOfPlan, typer.Option(help="The first found, or that with the largest smallest margin.")
    ] = "any",
    strong: Annotated[
        bool, typer.Option("--strong", help="Every structure must stand, not only can.")
    ] = False,
    moves: Annotated[
        int, typer.Option(min=1, max=2, help="With --clear-path: by so many straight moves.")
    ] = 1,
    together: Annotated[
        int, typer.Option(min=1, help="With --clear-path: so many as one where they lock.")
    ] = 1,
    obstacles: Annotated[
        str | None,
        typer.Option(help="With --clear-path: a scene whose bodies are only in the way."),
    ] = None,
    facets: Facets = 8,
    cone: Pyramid = "inscribed",
    as_json: AsJson = False,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            help="Write a picture (.svg, .pdf, .png), a page to step through (.html), a film "
            "(.gif, .mp4) or what --json prints (.json). For a folder of scenes: where its plans "
            "are kept.",
        ),
    ] = None,
    engine: Annotated[
        EngineName | None, typer.Option(help="For a folder: where its scenes are planned.")
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(
            min=1, help="For a folder: how many scenes at a time; by default one for each core."
        ),
    ] = None,
    address: Annotated[
        str | None,
        typer.Option(
            help="With --engine ray: the cluster; [bold]auto[/]: the one on this machine."
        ),
    ] = None,
) -> int:
    """In which order can it be taken apart so that it never collapses?

    SCENE may be a folder of scene files. Each of them is planned; what is finished is not repeated.
    """
    if not clear_path and (moves > 1 or together > 1 or obstacles is not None):
        raise InputError("--moves, --together and --obstacles are for --clear-path")
    if Path(scene).is_dir():
        from drystone.cli import plan_many

        if threads is not None:
            raise InputError(f"{scene} is a folder: --threads is for one scene, --workers for many")
        if strong:
            raise InputError(f"{scene} is a folder: --strong is for one scene")
        where = engine or "threads"
        limits = (node_limit, time_limit)
        return plan_many.run(
            Path(scene),
            where,
            output,
            test,
            *limits,
            workers,
            address,
            as_json,
            shortcuts=shortcuts,
            hold=hold,
            clear_path=clear_path,
            margin=margin,
            order=order,
            moves=moves,
            together=together,
            obstacles=obstacles,
            facets=facets,
            cone=cone,
        )
    if engine is not None or workers is not None or address is not None:
        raise InputError(f"{scene} is no folder: --engine, --workers and --address are for folders")
    from drystone.cli import plan as command

    limits = (node_limit, time_limit)
    return command.run(
        scene,
        test,
        *limits,
        shortcuts,
        threads,
        hold,
        clear_path,
        margin,
        order,
        strong,
        facets,
        cone,
        as_json,
        output,
        moves,
        together,
        obstacles,
    )


@app.command()
def simulate(
    scene: File,
    dt: Annotated[float, typer.Option(help="Length of a step, seconds.")] = 1 / 240,
    steps: Annotated[int, typer.Option(min=0, help="How many steps.")] = 1200,
    reuse: Annotated[
        Reuse,
        typer.Option(help="What a step takes over from the one before. The motion is the same."),
    ] = "full",
    restitution: Annotated[
        float, typer.Option(help="With which share of their speed colliding blocks part, 0 to 1.")
    ] = 0.0,
    formulation: Annotated[
        Formulation,
        typer.Option(help="Solve for impulses and velocities, or for forces and accelerations."),
    ] = "velocity",
    coulomb_tolerance: Annotated[
        float,
        typer.Option(help="Count steps further from Coulomb's law, as a share of the speeds."),
    ] = 1e-8,
    facets: Facets = 8,
    cone: Pyramid = "inscribed",
    forces: Annotated[
        bool, typer.Option("--forces", help="Record the contact forces of every step.")
    ] = False,
    every: Annotated[
        int,
        typer.Option(
            min=1, help="Keep the bodies, and forces, of every so many steps: for long runs."
        ),
    ] = 1,
    as_json: AsJson = False,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            help="Write the run (.npz), a page that plays it (.html), a film (.gif, .mp4) or a "
            "picture of its end (.svg, .pdf, .png).",
        ),
    ] = None,
) -> int:
    """How does it move? From rest, step by step, with exact contact and friction."""
    from drystone.cli import simulate as command

    return command.run(
        scene,
        dt,
        steps,
        reuse,
        restitution,
        formulation,
        coulomb_tolerance,
        facets,
        cone,
        forces,
        every,
        as_json,
        output,
    )


@app.command("import")
def import_(
    file: Annotated[
        str,
        typer.Argument(
            metavar="FILE",
            help="A COMPAS assembly (.json), a folder of meshes or its manifest.json, MJCF (.xml), "
            "URDF, or a mesh file (.obj, .stl, .ply, .off, .gltf, .glb, .3mf, .msh, .step).",
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="The scene file to write; - for standard output."),
    ] = None,
    scale: Annotated[
        float | None,
        typer.Option(
            help="How many metres the file's unit of length has: 0.001 for millimetres. "
            "By default what the file says, or 1."
        ),
    ] = None,
    up: Annotated[Up, typer.Option(help="The axis that points up in the file.")] = "z",
    friction: Annotated[
        float, typer.Option(help="Coefficient of friction of bodies without their own.")
    ] = 0.5,
    density: Annotated[
        float | None, typer.Option(help="Density of all bodies, kg/m³; else the file's, or 1000.")
    ] = None,
    gravity: Annotated[
        str | None, typer.Option(help="Gravity as x,y,z in m/s²; else the file's, or 0,0,-9.81.")
    ] = None,
    fixed: Annotated[
        str | None, typer.Option(help="Bodies that never move, names separated by commas.")
    ] = None,
    fix: Annotated[
        list[str] | None,
        typer.Option(help="The same for one name, which may hold commas; may be repeated."),
    ] = None,
    ground: Annotated[
        bool, typer.Option("--ground", help="Lay a fixed box under everything.")
    ] = False,
    tolerance: Annotated[
        str | None,
        typer.Option(
            help="How far bodies may be apart, or overlap, and still touch, metres; auto: the "
            "least with which none overlap."
        ),
    ] = None,
    max_pieces: Annotated[
        int | None,
        typer.Option(min=1, help="Take convex pieces only, at most so many for each body."),
    ] = None,
    surface: Annotated[
        bool | None,
        typer.Option(
            "--surface/--pieces",
            help="Keep all meshes as surfaces, or cut all into convex pieces (256 at most). By "
            "default only curved ones, and those of many pieces, are kept as surfaces.",
        ),
    ] = None,
    simplify: Annotated[
        float | None,
        typer.Option(help="Simplify scanned meshes: how far a surface may move, metres."),
    ] = None,
    split: Annotated[
        Split | None,
        typer.Option(
            help="What becomes a body: each object of a mesh file (each group if it has no "
            "objects), each group, or the whole file (none)."
        ),
    ] = None,
    hull: Annotated[
        bool, typer.Option("--hull", help="Take the convex hull of each mesh.")
    ] = False,
    joints: Annotated[
        Joints,
        typer.Option(
            help="What to do with joints that turn or slide (MJCF, URDF): stop with an error, or "
            "weld them (fixed)."
        ),
    ] = "error",
    as_json: AsJson = False,
) -> int:
    """Make a scene of another tool's assembly, and say what was taken and what was left out."""
    from drystone.cli import import_ as command

    return command.run(
        file,
        output,
        as_json,
        scale=scale,
        up=up,
        friction=friction,
        density=density,
        gravity=gravity,
        fixed=fixed,
        fix=fix,
        ground=ground,
        tolerance=tolerance,
        max_pieces=max_pieces,
        simplify=simplify,
        split=split,
        hull=hull,
        joints=joints,
        surface=surface,
    )


bench_app = App(help="Repeat published measurements.", no_args_is_help=True)
app.add_typer(bench_app, name="bench")


@bench_app.command()
def paper(
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Folder for the table and the figures.")
    ] = Path("out/paper"),
) -> int:
    """Table I and Figs. 1 and 4 to 7 of Loomis and Balkcom (2006)."""
    from drystone.cli import bench as command

    return command.paper(output)


@bench_app.command()
def methods(
    scenes: Annotated[
        list[str] | None,
        typer.Argument(metavar="[SCENE]...", help="Scenes; by default the paper's structures."),
    ] = None,
    repeats: Annotated[
        int, typer.Option(min=1, help="Repeat what takes under a second; the least time counts.")
    ] = 5,
    as_json: AsJson = False,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Folder for the table as CSV.")
    ] = None,
) -> int:
    """What reuse gives to other methods: Dantzig's, block pivoting, Lemke's, linear programs.

    The stability tests of one search, by each method, from scratch and with reuse (section VI of
    the paper). On the paper's structures it takes about a minute, most of it for Lemke's method.
    """
    from drystone.cli import bench as command

    return command.methods(scenes or (), repeats, output, as_json)


@bench_app.callback()
def bench_root() -> None:
    """Repeat published measurements."""
