/** Draws the bodies of a frame. */
import type { Camera } from "./camera.ts";
import { State } from "./contract.ts";
import type { Fade } from "./fade.ts";
import type { Film } from "./film.ts";
import type { Palette } from "./palette.ts";

type Context = CanvasRenderingContext2D;

/** The next block, if smaller than this (pixels), gets a ring, so that it is found. */
const SMALL = 18;
const SMALLEST_TEXT = 7;
const LARGEST_TEXT = 13;

export interface BlockStyle {
    colours: Palette;
    names: boolean;
    /** The body under the pointer, or -1. */
    marked: number;
}

/** Bodies from back to front: what is gone, the ground, the structure, what is special. */
export function drawBlocks(
    context: Context,
    film: Film,
    frame: number,
    camera: Camera,
    fade: Fade,
    style: BlockStyle,
): void {
    const { colours } = style;
    const groups = grouped(film, frame, fade);
    const path = (body: number) => outline(film, frame, body, camera);
    context.lineJoin = "round";
    drawGhosts(context, groups.ghosts.map(path), colours);
    drawGround(context, groups.fixed.map(path), colours);
    const width = lineWidth(film, camera);
    const fill = (bodies: number[], colour: string, edge: string, thick = width) => {
        const whole = new Path2D();
        for (const body of bodies) whole.addPath(path(body));
        context.fillStyle = colour;
        context.fill(whole);
        context.strokeStyle = edge;
        context.lineWidth = thick;
        context.stroke(whole);
    };
    fill(groups.present, colours.stone, colours.ink);
    fill(groups.motionless, colours.still, colours.ink);
    for (const body of groups.fading) {
        context.globalAlpha = fade.of(body);
        const taken = frame > 0 && film.state(frame - 1, body) === State.next;
        fill([body], taken ? colours.next : colours.stone, colours.ink);
        context.globalAlpha = 1;
    }
    fill(groups.falling, colours.falling, colours.fall, Math.max(width, 1.5));
    fill(groups.next, colours.next, colours.ink, Math.max(2 * width, 2));
    for (const body of groups.next) drawRing(context, film, frame, body, camera, colours.next);
    if (style.names) drawNames(context, film, frame, camera, colours);
    if (style.marked >= 0) {
        context.strokeStyle = colours.ink;
        context.lineWidth = 2.5;
        context.stroke(path(style.marked));
    }
}

function grouped(film: Film, frame: number, fade: Fade) {
    const groups = {
        fixed: [] as number[],
        ghosts: [] as number[],
        fading: [] as number[],
        present: [] as number[],
        motionless: [] as number[],
        next: [] as number[],
        falling: [] as number[],
    };
    for (let body = 0; body < film.bodies.length; body++) {
        const state = film.state(frame, body);
        if (film.bodies[body].fixed) groups.fixed.push(body);
        else if (state === State.next) groups.next.push(body);
        else if (state === State.falling) groups.falling.push(body);
        else if (state !== State.absent && fade.of(body) >= 1)
            (state === State.motionless ? groups.motionless : groups.present).push(body);
        else {
            if (film.kind === "plan") groups.ghosts.push(body);
            if (fade.of(body) > 0) groups.fading.push(body);
        }
    }
    return groups;
}

function outline(film: Film, frame: number, body: number, camera: Camera): Path2D {
    const corners = film.corners(frame, body);
    const path = new Path2D();
    path.moveTo(camera.screenX(corners[0]), camera.screenY(corners[1]));
    for (let i = 2; i < corners.length; i += 2) {
        path.lineTo(camera.screenX(corners[i]), camera.screenY(corners[i + 1]));
    }
    path.closePath();
    return path;
}

function drawGhosts(context: Context, paths: Path2D[], colours: Palette): void {
    const whole = new Path2D();
    for (const path of paths) whole.addPath(path);
    context.strokeStyle = colours.line;
    context.lineWidth = 1;
    context.stroke(whole);
}

/** Fixed bodies are hatched, as on an engineer's drawing. */
function drawGround(context: Context, paths: Path2D[], colours: Palette): void {
    const whole = new Path2D();
    for (const path of paths) whole.addPath(path);
    context.fillStyle = colours.ground;
    context.fill(whole);
    context.save();
    context.clip(whole);
    context.strokeStyle = colours.hatch;
    context.lineWidth = 0.75;
    context.beginPath();
    const { clientWidth: w, clientHeight: h } = context.canvas;
    for (let x = -h; x < w; x += 9) {
        context.moveTo(x, h);
        context.lineTo(x + h, 0);
    }
    context.stroke();
    context.restore();
    context.strokeStyle = colours.hatch;
    context.lineWidth = 1;
    context.stroke(whole);
}

function drawRing(
    context: Context,
    film: Film,
    frame: number,
    body: number,
    camera: Camera,
    colour: string,
): void {
    const size = pixelSize(film, body, camera);
    if (Math.max(...size) >= SMALL) return;
    const [x, y] = film.pose(frame, body);
    context.beginPath();
    const radius = Math.hypot(...size) / 2 + 6;
    context.arc(camera.screenX(x), camera.screenY(y), radius, 0, 2 * Math.PI);
    context.strokeStyle = colour;
    context.lineWidth = 3;
    context.stroke();
}

function drawNames(
    context: Context,
    film: Film,
    frame: number,
    camera: Camera,
    colours: Palette,
): void {
    context.textAlign = "center";
    context.textBaseline = "middle";
    film.bodies.forEach(({ fixed, name }, body) => {
        const state = film.state(frame, body);
        if (fixed || state === State.absent) return;
        const [width, height] = pixelSize(film, body, camera);
        const size = Math.min(0.6 * height, (0.85 * width) / (0.6 * name.length), LARGEST_TEXT);
        if (size < SMALLEST_TEXT) return;
        const [x, y] = film.pose(frame, body);
        context.font = `${size}px system-ui, sans-serif`;
        context.fillStyle = nameColour(state, colours);
        context.fillText(name, camera.screenX(x), camera.screenY(y));
    });
}

function nameColour(state: State, colours: Palette): string {
    if (state === State.motionless) return colours["still-name"];
    return state === State.next || state === State.falling ? colours["mark-name"] : colours.ink;
}

/** Width and height of a body's outline in its own frame, in pixels. */
function pixelSize(film: Film, body: number, camera: Camera): [number, number] {
    const { vertices } = film.bodies[body];
    const side = (axis: 0 | 1) => {
        const values = vertices.map((vertex) => vertex[axis]);
        return camera.scale * (Math.max(...values) - Math.min(...values));
    };
    return [side(0), side(1)];
}

function lineWidth(film: Film, camera: Camera): number {
    const body = Math.max(
        film.bodies.findIndex(({ fixed }) => !fixed),
        0,
    );
    if (film.bodies.length === 0) return 1;
    return Math.min(Math.max(0.03 * Math.min(...pixelSize(film, body, camera)), 0.4), 1.2);
}
