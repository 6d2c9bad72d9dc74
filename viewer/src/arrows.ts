/** Contact forces and loads as arrows, all to one scale, and the key that says which. */

import type { Camera } from "./camera.ts";
import type { Load } from "./contract.ts";
import type { Film, Force } from "./film.ts";
import { measure } from "./format.ts";
import type { Palette } from "./palette.ts";

/** Arrows shorter than this (pixels) are not drawn: they would be dots. */
const SHORTEST = 1.5;
/** More arrows than this have no halo, which would cost more than all the rest. */
const MANY = 600;
/** How long the force is that few exceed, in typical block sizes. */
const LENGTH = 1.1;
/** The share of forces that are not longer than that: an impact may be far beyond. */
const FEW = 0.99;

/** Metres a newton, so that blocks and arrows are of a size. */
export function forceScale(film: Film): number {
    const sorted = film.magnitudes().sort();
    const large = sorted[Math.min(Math.floor(FEW * sorted.length), sorted.length - 1)] ?? 0;
    return large > 0 ? (LENGTH * film.typicalSize) / large : 0;
}

/** A force as it acts on the body that is carried: against gravity. */
export function carrying(force: Force, gravity: number[]): [number, number] {
    const down = force.fx * gravity[0] + force.fy * gravity[1] > 0;
    return down ? [-force.fx, -force.fy] : [force.fx, force.fy];
}

export function drawForces(
    context: CanvasRenderingContext2D,
    film: Film,
    forces: Force[],
    camera: Camera,
    metres: number,
    colours: Palette,
): void {
    const path = new Path2D();
    for (const force of forces) {
        const [fx, fy] = carrying(force, film.gravity);
        const pixels = metres * camera.scale;
        arrow(path, camera.screenX(force.x), camera.screenY(force.y), pixels * fx, -pixels * fy);
    }
    paint(context, path, colours, colours.force, forces.length <= MANY);
}

/** Loads: from where they act, whereto they push. */
export function drawLoads(
    context: CanvasRenderingContext2D,
    loads: Load[],
    camera: Camera,
    metres: number,
    colours: Palette,
): void {
    const path = new Path2D();
    const pixels = metres * camera.scale;
    for (const { at, force } of loads) {
        arrow(
            path,
            camera.screenX(at[0]),
            camera.screenY(at[1]),
            pixels * force[0],
            -pixels * force[1],
        );
    }
    paint(context, path, colours, colours.load, true);
}

/** An arrow of a round force in the lower left corner, with its value. */
export function drawKey(
    context: CanvasRenderingContext2D,
    height: number,
    pixelsANewton: number,
    colours: Palette,
): void {
    if (!(pixelsANewton > 0)) return;
    const value = roundBelow(90 / pixelsANewton);
    const [x, y, length] = [14, height - 18, value * pixelsANewton];
    const text = measure(value, "N");
    context.font = "12px system-ui, sans-serif";
    context.textAlign = "left";
    context.textBaseline = "middle";
    context.globalAlpha = 0.85;
    context.fillStyle = colours.page;
    context.fillRect(x - 8, y - 12, length + context.measureText(text).width + 24, 24);
    context.globalAlpha = 1;
    const path = new Path2D();
    arrow(path, x, y, length, 0);
    paint(context, path, colours, colours.force, true);
    context.fillStyle = colours.ink;
    context.fillText(text, x + length + 7, y);
}

/** The largest of 1, 2, 5 times a power of ten that is not above `value`. */
export function roundBelow(value: number): number {
    const power = 10 ** Math.floor(Math.log10(value));
    const factor = [5, 2, 1].find((factor) => factor * power <= value * (1 + 1e-9)) ?? 1;
    return factor * power;
}

function arrow(path: Path2D, x: number, y: number, dx: number, dy: number): void {
    const length = Math.hypot(dx, dy);
    if (!(length >= SHORTEST)) return;
    const [ux, uy] = [dx / length, dy / length];
    const shaft = Math.min(Math.max(0.03 * length, 0.6), 1.4);
    const head = Math.min(9, 0.5 * length);
    const wide = 0.42 * head;
    const neck = length - head;
    const at = (along: number, side: number): [number, number] => [
        x + along * ux - side * uy,
        y + along * uy + side * ux,
    ];
    path.moveTo(...at(0, shaft));
    path.lineTo(...at(neck, shaft));
    path.lineTo(...at(neck, wide));
    path.lineTo(...at(length, 0));
    path.lineTo(...at(neck, -wide));
    path.lineTo(...at(neck, -shaft));
    path.lineTo(...at(0, -shaft));
    path.lineTo(...at(0, shaft)); // not closePath, see blocks.ts
}

function paint(
    context: CanvasRenderingContext2D,
    path: Path2D,
    colours: Palette,
    colour: string,
    halo: boolean,
): void {
    if (halo) {
        context.lineJoin = "round";
        context.strokeStyle = colours.page;
        context.lineWidth = 1.6;
        context.stroke(path);
    }
    context.fillStyle = colour;
    context.fill(path);
}
