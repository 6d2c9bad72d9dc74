/** What is drawn on blocks beside their outlines: names, the ring of the next one, line widths. */
import type { Camera } from "./camera.ts";
import { State } from "./contract.ts";
import type { Film } from "./film.ts";
import type { Palette } from "./palette.ts";
import type { Scene } from "./scene.ts";

/** The next block, if smaller than this (pixels), gets a ring, so that it is found. */
const SMALL = 18;
const SMALLEST_TEXT = 7;
const LARGEST_TEXT = 13;

export function drawRing({ context, film, frame, camera }: Scene, body: number, colour: string) {
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

/** A name on every block that is wide and high enough on the screen. */
export function drawNames({ context, film, frame, camera }: Scene, colours: Palette): void {
    context.textAlign = "center";
    context.textBaseline = "middle";
    let font = 0;
    film.bodies.forEach(({ fixed, name }, body) => {
        const state = film.state(frame, body);
        if (fixed || state === State.absent) return;
        const [width, height] = pixelSize(film, body, camera);
        const fits = Math.min(0.6 * height, (0.85 * width) / (0.6 * name.length), LARGEST_TEXT);
        if (fits < SMALLEST_TEXT) return;
        const size = Math.floor(fits);
        if (size !== font) context.font = `${size}px system-ui, sans-serif`;
        font = size;
        const [x, y] = film.pose(frame, body);
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
    const [width, height] = film.sizes[body];
    return [camera.scale * width, camera.scale * height];
}

/** Thinner where blocks are small. */
export function lineWidth({ film, camera }: Scene): number {
    return Math.min(Math.max(0.03 * film.typicalSize * camera.scale, 0.4), 1.2);
}
