/** Names on the blocks that are seen, and the ring of a next one that is small. */
import { Ray, type Vector3 } from "three";
import { State } from "../contract.ts";
import type { Film } from "../film.ts";
import type { Palette } from "../palette.ts";
import type { Explode } from "./explode.ts";
import type { Orbit } from "./orbit.ts";
import { middleOf } from "./poses.ts";

const SMALLEST_TEXT = 8;
const LARGEST_TEXT = 13;
/** More blocks than this have no names: whether each is seen takes a look at all. */
const MANY = 300;
const SMALL = 18;

/** Where a body's middle is on a picture so large, pixels. */
export function pixelOf(point: Vector3, orbit: Orbit, width: number, height: number) {
    const at = point.clone().project(orbit.camera);
    return [((at.x + 1) / 2) * width, ((1 - at.y) / 2) * height] as [number, number];
}

export class Labels {
    private readonly film: Film;
    private readonly explode: Explode;
    private readonly middles: Vector3[];

    constructor(film: Film, explode: Explode) {
        this.film = film;
        this.explode = explode;
        this.middles = film.bodies.map((_, body) => middleOf(film, body));
    }

    middle(frame: number, body: number): Vector3 {
        return this.middles[body].clone().applyMatrix4(this.explode.placed(frame, body));
    }

    /** A name where the way from the eye to a block's middle meets no other block before. */
    drawNames(
        context: CanvasRenderingContext2D,
        frame: number,
        orbit: Orbit,
        colours: Palette,
        first: (ray: Ray) => number,
    ): void {
        const { film } = this;
        if (film.bodies.length > MANY) return;
        const { clientWidth: width, clientHeight: height } = context.canvas;
        context.textAlign = "center";
        context.textBaseline = "middle";
        context.lineJoin = "round";
        film.bodies.forEach(({ fixed, name }, body) => {
            if (fixed || film.state(frame, body) === State.absent) return;
            const size = Math.floor(this.fitting(body, orbit, height));
            if (size < SMALLEST_TEXT) return;
            const middle = this.middle(frame, body);
            const eye = orbit.camera.position;
            const ray = new Ray(eye.clone(), middle.clone().sub(eye).normalize());
            if (first(ray) !== body) return;
            context.font = `600 ${size}px system-ui, sans-serif`;
            context.lineWidth = 3;
            context.strokeStyle = colours.page;
            context.fillStyle = colours.ink;
            const at = pixelOf(middle, orbit, width, height);
            context.globalAlpha = 0.75;
            context.strokeText(name, ...at);
            context.globalAlpha = 1;
            context.fillText(name, ...at);
        });
    }

    drawRings(
        context: CanvasRenderingContext2D,
        frame: number,
        orbit: Orbit,
        colours: Palette,
    ): void {
        const { clientWidth: width, clientHeight: height } = context.canvas;
        this.film.bodies.forEach((_, body) => {
            if (this.film.state(frame, body) !== State.next) return;
            const pixels = Math.max(...this.film.sizes[body]) / orbit.metresAPixel(height);
            if (pixels >= SMALL) return;
            context.beginPath();
            const [x, y] = pixelOf(this.middle(frame, body), orbit, width, height);
            context.arc(x, y, pixels / 2 + 8, 0, 2 * Math.PI);
            context.strokeStyle = colours.next;
            context.lineWidth = 3;
            context.stroke();
        });
    }

    /** Pixels of text that fit on the body, whichever way it is turned. */
    private fitting(body: number, orbit: Orbit, height: number): number {
        const pixels = this.film.sizes[body].map((side) => side / orbit.metresAPixel(height));
        const [small, middle] = pixels.sort((a, b) => a - b);
        const long = this.film.bodies[body].name.length;
        return Math.min(
            0.6 * Math.max(small, 0.6 * middle),
            (0.9 * middle) / (0.6 * long),
            LARGEST_TEXT,
        );
    }
}
