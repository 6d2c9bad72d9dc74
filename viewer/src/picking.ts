/** Which body is at a point. */
import { State } from "./contract.ts";
import type { Film } from "./film.ts";

/** The body at a point of the world: one that is there before one that is gone; -1 for none. */
export function bodyAt(film: Film, frame: number, x: number, y: number): number {
    let gone = -1;
    for (let body = film.bodies.length - 1; body >= 0; body--) {
        const absent = film.state(frame, body) === State.absent;
        if (absent && (film.kind === "run" || gone >= 0)) continue;
        if (!inside(film.corners(frame, body), x, y)) continue;
        if (!absent) return body;
        gone = body;
    }
    return gone;
}

/** Whether a point is in a convex polygon, its corners counter-clockwise. */
export function inside(corners: number[], x: number, y: number): boolean {
    const n = corners.length;
    for (let i = 0; i < n; i += 2) {
        const [ax, ay] = [corners[i], corners[i + 1]];
        const [bx, by] = [corners[(i + 2) % n], corners[(i + 3) % n]];
        if ((bx - ax) * (y - ay) - (by - ay) * (x - ax) < 0) return false;
    }
    return n > 0;
}
