/** The bodies of a frame as meshes with edges. */
import {
    Color,
    Group,
    type Material,
    Mesh,
    MeshLambertMaterial,
    type Plane,
    type Vector2,
} from "three";
import { State } from "../contract.ts";
import type { Film } from "../film.ts";
import type { Palette } from "../palette.ts";
import type { Look } from "../stage.ts";
import type { Colours } from "./colours.ts";
import type { Explode } from "./explode.ts";
import { type Lines, linesOf } from "./lines.ts";
import { edgesOf, facesOf } from "./solid.ts";

/** How much of the ink is in the faces of the body that is marked. */
const MARKED = 0.22;

/** How much of the colour of held bodies is in their faces. */
const HELD = 0.35;

interface Block {
    faces: Mesh<ReturnType<typeof facesOf>, MeshLambertMaterial>;
    edges: Lines;
}

export class Blocks {
    readonly group = new Group();
    private readonly film: Film;
    private readonly explode: Explode;
    private readonly colours: Colours;
    private readonly blocks: Block[];

    constructor(film: Film, explode: Explode, colours: Colours) {
        this.film = film;
        this.explode = explode;
        this.colours = colours;
        this.blocks = film.bodies.map((body) => {
            const solid = new MeshLambertMaterial({
                clipShadows: true,
                polygonOffset: true,
                polygonOffsetFactor: 1,
                polygonOffsetUnits: 1,
            });
            const faces = new Mesh(facesOf(body), solid);
            const edges = linesOf(edgesOf(body));
            faces.matrixAutoUpdate = false;
            faces.castShadow = !body.fixed;
            faces.receiveShadow = true;
            this.group.add(faces, edges);
            return { faces, edges };
        });
    }

    /** `width` is the picture's, in pixels; `planes` cut away what is behind them. */
    draw(look: Look, size: Vector2, width: number, planes: Plane[]): void {
        this.blocks.forEach((block, body) => {
            const matrix = this.explode.placed(look.frame, body);
            block.faces.matrix.copy(matrix);
            block.edges.matrix.copy(matrix);
            block.edges.material.resolution.copy(size);
            block.faces.material.clippingPlanes = block.edges.material.clippingPlanes = planes;
            this.paintFaces(block, body, look);
            this.paintEdges(block, body, look, width);
        });
    }

    private paintFaces({ faces }: Block, body: number, look: Look): void {
        const { film } = this;
        const shown = this.shown(body, look);
        faces.visible = shown > 0;
        see(faces.material, shown);
        faces.material.color.copy(this.colours.of(look.frame, body, look.colours));
        if (film.held(look.frame, body))
            faces.material.color.lerp(new Color(look.colours.held), HELD);
        if (body === look.marked) faces.material.color.lerp(new Color(look.colours.ink), MARKED);
    }

    private paintEdges({ edges }: Block, body: number, look: Look, width: number): void {
        const { film } = this;
        const state = film.state(look.frame, body);
        const ghost = this.shown(body, look) === 0;
        edges.visible = !ghost || film.kind === "plan";
        const held = film.held(look.frame, body);
        const striking = state === State.next || state === State.falling || held;
        const special = striking || body === look.marked;
        edges.material.color.set(
            look.colours[edgeColour(film.bodies[body].fixed, state, held, ghost)],
        );
        edges.material.linewidth = special ? Math.max(2 * width, 2) : width;
    }

    /** From 0 (gone) to 1. */
    private shown(body: number, { fade }: Look): number {
        return this.film.bodies[body].fixed ? 1 : Math.max(fade.of(body), 0);
    }
}

function edgeColour(fixed: boolean, state: State, held: boolean, ghost: boolean): keyof Palette {
    if (ghost) return "line";
    if (fixed) return "hatch";
    if (held) return "held";
    return state === State.falling ? "fall" : "ink";
}

function see(material: Material, opacity: number): void {
    const clear = opacity < 1;
    if (material.transparent !== clear) material.needsUpdate = true;
    material.transparent = clear;
    material.opacity = opacity;
}
