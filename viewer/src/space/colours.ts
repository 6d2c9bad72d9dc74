/** The colour of a body: by its state, as in the plane, or by its place in the order. */
import { Color } from "three";
import { State } from "../contract.ts";
import type { Film } from "../film.ts";
import type { Palette } from "../palette.ts";

/** viridis (van der Walt and Smith), at equal steps: ordered also without colour vision. */
const VIRIDIS = ["#440154", "#414487", "#2a788e", "#22a884", "#7ad151", "#fde725"].map(
    (colour) => new Color(colour),
);

/** The first to be taken away is yellow, the last is violet, as in the pictures of plans. */
export function orderColour(place: number, count: number): Color {
    const at = (1 - place / Math.max(count - 1, 1)) * (VIRIDIS.length - 1);
    const below = Math.min(Math.floor(at), VIRIDIS.length - 2);
    return VIRIDIS[below].clone().lerp(VIRIDIS[below + 1], at - below);
}

export class Colours {
    byOrder = false;
    /** Of each body: its place in the order, -1 if it stays. */
    readonly places: number[];
    readonly count: number;
    private readonly film: Film;

    constructor(film: Film) {
        this.film = film;
        const removed = film.bodies.map((_, body) => film.removedIn(body));
        const steps = [...new Set(removed.filter((frame) => frame >= 0))].sort((a, b) => a - b);
        this.places = removed.map((frame) => steps.indexOf(frame));
        this.count = film.kind === "plan" ? steps.length : 0;
    }

    of(frame: number, body: number, palette: Palette): Color {
        if (this.film.bodies[body].fixed) return new Color(palette.ground);
        const place = this.places[body];
        if (this.byOrder && place >= 0) return orderColour(place, this.count);
        return new Color(palette[this.kind(frame, body)]);
    }

    private kind(frame: number, body: number): keyof Palette {
        switch (this.film.state(frame, body)) {
            case State.next:
                return "next";
            case State.falling:
                return "falling";
            case State.motionless:
                return "still";
            case State.absent:
                return this.wasNext(frame, body) ? "next" : "stone";
            default:
                return "stone";
        }
    }

    /** What fades out keeps the colour it had. */
    private wasNext(frame: number, body: number): boolean {
        return frame > 0 && this.film.state(frame - 1, body) === State.next;
    }
}
