/** The picture in space: puts eye, light, blocks, section and arrows into one scene of meshes. */
import { Fog, PCFShadowMap, type Plane, Ray, Scene, Vector2, Vector3, WebGLRenderer } from "three";
import { drawKey, forceScale } from "../arrows.ts";
import type { Film } from "../film.ts";
import type { Look, PointerWishes, Stage } from "../stage.ts";
import { Surface } from "../surface.ts";
import { Arrows } from "./arrows.ts";
import { Blocks } from "./blocks.ts";
import { Colours } from "./colours.ts";
import { Explode } from "./explode.ts";
import { bindGestures } from "./gestures.ts";
import { Labels, pixelOf } from "./labels.ts";
import { Light } from "./light.ts";
import { Orbit } from "./orbit.ts";
import { Panel } from "./panel.ts";
import { Picking } from "./picking.ts";
import { Section } from "./section.ts";
import { type Around, aroundOf, boxOf, floorOf, shownOf } from "./view.ts";

/** Radians and shares of the picture that a key turns and moves. */
const [TURN, MOVE] = [0.12, 0.06];

export class SpaceStage implements Stage {
    readonly canvas: HTMLCanvasElement;
    readonly keys: Record<string, () => void>;
    private readonly around: Around;
    private readonly orbit: Orbit;
    private readonly explode: Explode;
    private readonly section: Section;
    private readonly blocks: Blocks;
    private readonly arrows: Arrows;
    private readonly labels: Labels;
    private readonly picking: Picking;
    private readonly metres: number;
    private readonly renderer: WebGLRenderer;
    private readonly scene = new Scene();
    /** Names and the key of the forces, over the picture. */
    private readonly over: Surface;
    private readonly colours: Colours;
    private readonly film: Film;
    private panel: Panel | null = null;
    private moved: () => void = () => {};
    /** The explode factor that the view was fitted for. */
    private fitted = 0;

    constructor(film: Film, canvas: HTMLCanvasElement) {
        this.film = film;
        this.canvas = canvas;
        this.renderer = rendererOn(canvas);
        this.over = new Surface(overlayOf(canvas));
        this.around = aroundOf(film, ...boxOf(film));
        this.orbit = new Orbit(this.around);
        this.explode = new Explode(film, this.around);
        this.colours = new Colours(film);
        this.section = new Section(film, this.explode, this.colours);
        this.blocks = new Blocks(film, this.explode, this.colours);
        this.metres = forceScale(film);
        this.arrows = new Arrows(film, this.explode, this.metres);
        this.labels = new Labels(film, this.explode);
        this.picking = new Picking(film, this.explode);
        const light = new Light(this.around, floorOf(film, this.around.up));
        for (const part of [light, this.blocks, this.section, this.arrows]) {
            this.scene.add(part.group);
        }
        this.keys = this.bindKeys();
    }

    bind(wishes: PointerWishes): void {
        this.moved = wishes.moved;
        const { section, explode, colours } = this;
        const open = () => section.openTowards(this.ahead());
        this.panel = new Panel({ section, explode, colours, open }, () => this.moved());
        bindGestures(this.canvas, this.orbit, wishes);
    }

    draw(look: Look): void {
        if (this.over.resize()) this.resize();
        if (this.fitted !== this.explode.factor) this.fit();
        const { width, height } = this.over;
        const plane = this.plane();
        const planes = plane ? [plane] : [];
        const [size, line] = [new Vector2(width, height), this.lineWidth()];
        this.blocks.draw(look, size, line, planes);
        this.section.draw(look, plane, size, line);
        this.arrows.draw(look, planes);
        this.paintAir(look.colours.page);
        this.renderer.render(this.scene, this.orbit.camera);
        this.drawOver(look, plane);
    }

    bodyAt(frame: number, [x, y]: [number, number]): number {
        const at = new Vector3((2 * x) / this.over.width - 1, 1 - (2 * y) / this.over.height, 0.5);
        const eye = this.orbit.camera.position.clone();
        const ray = new Ray(eye, at.unproject(this.orbit.camera).sub(eye).normalize());
        return this.picking.bodyAt(frame, ray, this.plane());
    }

    placeOf(frame: number, body: number): [number, number] {
        const { width, height } = this.over;
        return pixelOf(this.labels.middle(frame, body), this.orbit, width, height);
    }

    zoom(factor: number): void {
        this.orbit.zoom(factor);
    }

    showAll(): void {
        this.orbit.restore();
        this.fit();
    }

    private drawOver(look: Look, plane: Plane | null): void {
        const { context, width, height } = this.over;
        context.clearRect(0, 0, width, height);
        const { frame, colours } = look;
        this.labels.drawRings(context, frame, this.orbit, colours);
        const first = (ray: Ray) => this.picking.bodyAt(frame, ray, plane);
        if (look.names) this.labels.drawNames(context, frame, this.orbit, colours, first);
        const metres = this.metres * look.stretch;
        const pixels = metres / this.orbit.metresAPixel(height);
        if (look.forces) drawKey(context, height, pixels, colours);
    }

    /** Far things fade into the page: a ground without end has no hard edge. */
    private paintAir(page: string): void {
        this.renderer.setClearColor(page);
        const size = this.around.high.distanceTo(this.around.low) || 1;
        const near = this.orbit.camera.position.distanceTo(this.middle()) + size;
        this.scene.fog = new Fog(page, near, near + 4 * size);
    }

    private resize(): void {
        const { width, height } = this.over;
        this.renderer.setPixelRatio(globalThis.devicePixelRatio || 1);
        this.renderer.setSize(width, height, false);
        this.fit();
    }

    private fit(): void {
        const { width, height } = this.over;
        this.fitted = this.explode.factor;
        const shown = shownOf(this.film, this.around).map((point) => this.explode.moved(point));
        this.orbit.fit(shown, width / Math.max(height, 1));
    }

    /** What is shown, with what is drawn apart. */
    private box(): [Vector3, Vector3] {
        const { low, high } = this.around;
        return [this.explode.moved(low), this.explode.moved(high)];
    }

    private plane(): Plane | null {
        return this.section.plane(...this.box());
    }

    private middle(): Vector3 {
        return this.around.low.clone().add(this.around.high).multiplyScalar(0.5);
    }

    private ahead(): Vector3 {
        return this.orbit.camera.getWorldDirection(new Vector3());
    }

    /** Thinner where blocks are small. */
    private lineWidth(): number {
        const pixels = this.film.typicalSize / this.orbit.metresAPixel(this.over.height);
        return Math.min(Math.max(0.025 * pixels, 0.5), 1.3);
    }

    private bindKeys(): Record<string, () => void> {
        const orbit = (how: () => void) => () => {
            how();
            this.moved();
        };
        return {
            a: orbit(() => this.orbit.rotate(-TURN, 0)),
            d: orbit(() => this.orbit.rotate(TURN, 0)),
            w: orbit(() => this.orbit.rotate(0, TURN)),
            s: orbit(() => this.orbit.rotate(0, -TURN)),
            A: orbit(() => this.orbit.pan(MOVE, 0)),
            D: orbit(() => this.orbit.pan(-MOVE, 0)),
            W: orbit(() => this.orbit.pan(0, -MOVE)),
            S: orbit(() => this.orbit.pan(0, MOVE)),
            o: () => this.panel?.toggleOrder(),
            x: () => this.panel?.cutNext(),
        };
    }
}

function rendererOn(canvas: HTMLCanvasElement): WebGLRenderer {
    const context = canvas.getContext("webgl2", { antialias: true });
    if (!context) {
        throw new Error(
            "This page shows a structure in space and needs WebGL 2, which this browser lacks or has switched off.",
        );
    }
    const renderer = new WebGLRenderer({ canvas, context, antialias: true });
    // Asking waits for every shader to be ready.
    renderer.debug.checkShaderErrors = false;
    renderer.localClippingEnabled = true;
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = PCFShadowMap;
    return renderer;
}

/** A canvas just over another, which lets the pointer through. */
function overlayOf(canvas: HTMLCanvasElement): HTMLCanvasElement {
    const over = document.createElement("canvas");
    over.id = "over";
    over.setAttribute("aria-hidden", "true");
    canvas.after(over);
    document.documentElement.classList.add("space");
    return over;
}
