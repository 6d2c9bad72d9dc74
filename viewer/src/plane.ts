/** The picture in the plane. */
import { drawForces, drawKey, drawLoads, forceScale } from "./arrows.ts";
import { drawBlocks } from "./blocks.ts";
import { Camera, viewOf } from "./camera.ts";
import { State } from "./contract.ts";
import type { Film } from "./film.ts";
import { bodyAt } from "./picking.ts";
import { bindPointer } from "./pointer.ts";
import type { Look, PointerWishes, Stage } from "./stage.ts";
import { Surface } from "./surface.ts";

export class PlaneStage implements Stage {
    readonly canvas: HTMLCanvasElement;
    readonly keys = {};
    private readonly film: Film;
    private readonly camera = new Camera();
    private readonly surface: Surface;
    private readonly metres: number;

    constructor(film: Film, canvas: HTMLCanvasElement) {
        this.film = film;
        this.canvas = canvas;
        this.surface = new Surface(canvas);
        this.metres = forceScale(film);
    }

    bind(wishes: PointerWishes): void {
        bindPointer(this.canvas, this.camera, wishes);
    }

    draw(look: Look): void {
        const { film, surface, camera } = this;
        const { frame, colours, names, marked } = look;
        if (surface.resize()) this.showAll();
        this.canvas.classList.toggle("zoomed", camera.zoomed);
        surface.clear(colours.page);
        const scene = { context: surface.context, film, frame, camera };
        drawBlocks(scene, look.fade, { colours, names, marked });
        if (look.forces) this.drawForces(look);
        const metres = this.metres * look.stretch;
        drawLoads(surface.context, film.loadsOf(frame), camera, metres, colours);
    }

    private drawForces({ frame, colours, stretch }: Look): void {
        const { film, surface, camera } = this;
        const metres = this.metres * stretch;
        const there = (body: number) => film.state(frame, body) !== State.absent;
        const known = film.forces(film.forcesFrame(frame)) ?? [];
        const forces = known.filter(({ a, b }) => there(a) && there(b));
        drawForces(surface.context, film, forces, camera, metres, colours);
        drawKey(surface.context, surface.height, metres * camera.scale, colours);
    }

    bodyAt(frame: number, at: [number, number]): number {
        return bodyAt(this.film, frame, ...this.camera.world(...at));
    }

    placeOf(frame: number, body: number): [number, number] {
        const [x, y] = this.film.pose(frame, body);
        return [this.camera.screenX(x), this.camera.screenY(y)];
    }

    zoom(factor: number): void {
        this.camera.zoom(factor, this.surface.width / 2, this.surface.height / 2);
    }

    showAll(): void {
        this.camera.fit(viewOf(this.film), this.surface.width, this.surface.height);
    }
}
