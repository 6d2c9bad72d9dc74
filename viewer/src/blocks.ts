/** Draws the bodies of a frame. */
import { State } from "./contract.ts";
import type { Fade } from "./fade.ts";
import type { Film } from "./film.ts";
import { drawNames, drawRing, lineWidth } from "./marks.ts";
import type { Palette } from "./palette.ts";
import type { Scene } from "./scene.ts";

export interface BlockStyle {
    colours: Palette;
    names: boolean;
    /** The body under the pointer, or -1. */
    marked: number;
}

/** Bodies from back to front: what is gone, the ground, the structure, what is special. */
export function drawBlocks(scene: Scene, fade: Fade, style: BlockStyle): void {
    const { context, film, frame } = scene;
    const { colours } = style;
    const groups = grouped(film, frame, fade);
    const width = lineWidth(scene);
    context.lineJoin = context.lineCap = "round";
    outline(scene, groups.ghosts, colours.line, 1);
    drawGround(scene, groups.fixed, colours);
    fill(scene, groups.present, colours.stone);
    fill(scene, groups.motionless, colours.still);
    outline(scene, [...groups.present, ...groups.motionless], colours.ink, width);
    for (const body of groups.fading) {
        const taken = frame > 0 && film.state(frame - 1, body) === State.next;
        context.globalAlpha = fade.of(body);
        fill(scene, [body], taken ? colours.next : colours.stone);
        outline(scene, [body], colours.ink, width);
        context.globalAlpha = 1;
    }
    fill(scene, groups.falling, colours.falling);
    outline(scene, groups.falling, colours.fall, Math.max(width, 1.5));
    fill(scene, groups.next, colours.next);
    outline(scene, groups.next, colours.ink, Math.max(2 * width, 2));
    for (const body of groups.next) drawRing(scene, body, colours.next);
    drawHeld(scene, colours);
    if (style.names) drawNames(scene, colours);
    if (style.marked >= 0) outline(scene, [style.marked], colours.ink, 2.5);
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

/**
 * Makes the outlines of some bodies the current path: one path is far cheaper than one a body. They
 * end where they began and are not closed: closePath looks at the whole path so far, each time.
 */
function trace({ context, film, frame, camera }: Scene, bodies: number[]): void {
    context.beginPath();
    for (const body of bodies) {
        const corners = film.corners(frame, body);
        context.moveTo(camera.screenX(corners[0]), camera.screenY(corners[1]));
        for (let i = 2; i < corners.length; i += 2) {
            context.lineTo(camera.screenX(corners[i]), camera.screenY(corners[i + 1]));
        }
        context.lineTo(camera.screenX(corners[0]), camera.screenY(corners[1]));
    }
}

function fill(scene: Scene, bodies: number[], colour: string): void {
    if (bodies.length === 0) return;
    trace(scene, bodies);
    scene.context.fillStyle = colour;
    scene.context.fill();
}

function outline(scene: Scene, bodies: number[], colour: string, width: number): void {
    if (bodies.length === 0) return;
    trace(scene, bodies);
    scene.context.strokeStyle = colour;
    scene.context.lineWidth = width;
    scene.context.stroke();
}

/** Fixed bodies are hatched, as on an engineer's drawing. */
function drawGround(scene: Scene, bodies: number[], colours: Palette): void {
    if (bodies.length === 0) return;
    const { context } = scene;
    fill(scene, bodies, colours.ground);
    context.lineWidth = 0.75;
    hatch(scene, bodies, colours.hatch, true);
    outline(scene, bodies, colours.hatch, 1);
}

/** Held bodies are hatched the other way, as in the pictures of plans. */
function drawHeld(scene: Scene, colours: Palette): void {
    const { context, film, frame } = scene;
    const there = film.bodies.map((_, body) => body).filter((body) => film.held(frame, body));
    if (there.length === 0) return;
    context.lineWidth = 1.5;
    hatch(scene, there, colours.held, false);
    outline(scene, there, colours.held, Math.max(lineWidth(scene), 2));
}

/** Lines across some bodies that rise to the right, or fall. */
function hatch(scene: Scene, bodies: number[], colour: string, rising: boolean): void {
    const { context } = scene;
    trace(scene, bodies);
    context.save();
    context.clip();
    context.strokeStyle = colour;
    context.beginPath();
    const { clientWidth: w, clientHeight: h } = context.canvas;
    for (let x = -h; x < w; x += 9) {
        context.moveTo(x, rising ? h : 0);
        context.lineTo(x + h, rising ? 0 : h);
    }
    context.stroke();
    context.restore();
}
