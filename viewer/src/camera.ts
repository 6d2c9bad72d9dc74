/** From metres to pixels and back. y points up in the world and down on the screen. */
import { State } from "./contract.ts";
import type { Film } from "./film.ts";

/** left, bottom, right, top in metres. */
export type Box = [number, number, number, number];

/** How far beyond the movable bodies a fixed one may widen the view, in the view's own size. */
const FIXED_REACH = 0.12;
/** How far bodies that move away may widen the view, in the size of the first frame. */
const MOTION_REACH = 0.5;
/** Frames looked at for the view. */
const SAMPLES = 200;
const MARGIN = 0.04;
const LARGEST_ZOOM = 200;

export class Camera {
    /** Pixels a metre. */
    scale = 1;
    private x = 0;
    private y = 0;
    private fitted = 1;

    /** Shows the whole of `box` in a window of this many pixels. */
    fit(box: Box, width: number, height: number): void {
        const [w, h] = [Math.max(box[2] - box[0], 1e-9), Math.max(box[3] - box[1], 1e-9)];
        this.scale = this.fitted = Math.min(width / w, height / h);
        this.x = width / 2 - (this.scale * (box[0] + box[2])) / 2;
        this.y = height / 2 + (this.scale * (box[1] + box[3])) / 2;
    }

    get zoomed(): boolean {
        return this.scale > this.fitted * 1.001;
    }

    screenX(x: number): number {
        return this.x + this.scale * x;
    }

    screenY(y: number): number {
        return this.y - this.scale * y;
    }

    world(px: number, py: number): [number, number] {
        return [(px - this.x) / this.scale, (this.y - py) / this.scale];
    }

    /** Zooms by `factor`; the point under the pixel stays where it is. */
    zoom(factor: number, px: number, py: number): void {
        const scale = Math.min(
            Math.max(this.scale * factor, this.fitted),
            this.fitted * LARGEST_ZOOM,
        );
        const ratio = scale / this.scale;
        this.x = px + (this.x - px) * ratio;
        this.y = py + (this.y - py) * ratio;
        this.scale = scale;
    }

    pan(dx: number, dy: number): void {
        this.x += dx;
        this.y += dy;
    }
}

/** The part of the world that is worth showing: where movable bodies are, and the ground they are on. */
export function viewOf(film: Film): Box {
    const every = film.bodies.map((_, body) => body);
    const movable = every.filter((body) => !film.bodies[body].fixed);
    const shown = movable.length > 0 ? movable : every;
    const first = around(film, 0, shown) ?? [0, 0, 1, 1];
    const fixed = around(film, 0, every) ?? first;
    let swept = first;
    const stride = Math.max(1, Math.floor(film.count / SAMPLES));
    for (let frame = 0; frame < film.count && film.times; frame += stride)
        swept = joined(swept, around(film, frame, shown) ?? swept);
    let box = first;
    // First how far it falls, then as far beside it.
    for (let turn = 0; turn < 2; turn++) {
        const limit = grown(first, MOTION_REACH * sizeOf(box));
        box = joined(first, within(swept, asFarAsItFalls(limit, fixed, film.gravity)));
    }
    if (movable.length > 0) box = joined(box, within(fixed, grown(box, FIXED_REACH * sizeOf(box))));
    return grown(box, MARGIN * sizeOf(box));
}

/** The limit, but down to where fixed bodies are: what falls on them is seen to land. */
function asFarAsItFalls(limit: Box, fixed: Box, [x, y]: number[]): Box {
    return [
        x < 0 ? Math.min(limit[0], fixed[0]) : limit[0],
        y < 0 ? Math.min(limit[1], fixed[1]) : limit[1],
        x > 0 ? Math.max(limit[2], fixed[2]) : limit[2],
        y > 0 ? Math.max(limit[3], fixed[3]) : limit[3],
    ];
}

function around(film: Film, frame: number, bodies: number[]): Box | null {
    const box: Box = [Infinity, Infinity, -Infinity, -Infinity];
    for (const body of bodies) {
        if (film.state(frame, body) === State.absent && film.kind === "run") continue;
        const corners = film.corners(frame, body);
        for (let i = 0; i < corners.length; i += 2) {
            box[0] = Math.min(box[0], corners[i]);
            box[1] = Math.min(box[1], corners[i + 1]);
            box[2] = Math.max(box[2], corners[i]);
            box[3] = Math.max(box[3], corners[i + 1]);
        }
    }
    return box[0] <= box[2] ? box : null;
}

function sizeOf([l, b, r, t]: Box): number {
    return Math.max(r - l, t - b);
}

function grown([l, b, r, t]: Box, by: number): Box {
    return [l - by, b - by, r + by, t + by];
}

function joined(a: Box, b: Box): Box {
    return [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[2], b[2]), Math.max(a[3], b[3])];
}

function within(box: Box, limit: Box): Box {
    return [
        Math.min(Math.max(box[0], limit[0]), limit[2]),
        Math.min(Math.max(box[1], limit[1]), limit[3]),
        Math.max(Math.min(box[2], limit[2]), limit[0]),
        Math.max(Math.min(box[3], limit[3]), limit[1]),
    ];
}
