/** Which body a ray meets first. */
import { type Matrix4, type Plane, Ray } from "three";
import { State } from "../contract.ts";
import type { Film } from "../film.ts";
import type { Explode } from "./explode.ts";
import { type Half, halvesOf, within } from "./hull.ts";
import { Triangles } from "./triangles.ts";

export class Picking {
    private readonly film: Film;
    private readonly explode: Explode;
    /** The half-spaces of the convex pieces of each body, in its own frame. */
    private readonly halves: Half[][][];
    private readonly surfaces: Triangles[][];
    /** From the world to each body's frame, as drawn in `at`: names ask for all of them, often. */
    private inverses: Matrix4[] = [];
    private at = "";

    constructor(film: Film, explode: Explode) {
        this.film = film;
        this.explode = explode;
        const pieces = film.bodies.map((body) => body.pieces ?? []);
        this.halves = pieces.map((all) => all.filter(({ surface }) => !surface).map(halvesOf));
        this.surfaces = pieces.map((all) =>
            all.filter(({ surface }) => surface).map((piece) => new Triangles(piece)),
        );
    }

    /**
     * The body seen first, of what the section keeps: one that is there before one of a plan that
     * is gone, whose outline is still there; -1 for none.
     */
    bodyAt(frame: number, ray: Ray, section: Plane | null): number {
        this.renew(frame);
        const there = this.nearest(ray, section, (body) => this.isThere(frame, body));
        if (there >= 0 || this.film.kind === "run") return there;
        return this.nearest(ray, section, (body) => !this.isThere(frame, body));
    }

    private isThere(frame: number, body: number): boolean {
        return this.film.state(frame, body) !== State.absent;
    }

    private nearest(ray: Ray, section: Plane | null, of: (body: number) => boolean): number {
        let [nearest, found] = [Infinity, -1];
        for (let body = 0; body < this.film.bodies.length; body++) {
            if (!of(body)) continue;
            const distance = this.distance(body, ray, section);
            if (distance < nearest) [nearest, found] = [distance, body];
        }
        return found;
    }

    /** How far along the ray a body begins, in lengths of its direction; Infinity if it is missed. */
    private distance(body: number, ray: Ray, section: Plane | null): number {
        const inverse = this.inverses[body];
        const own = new Ray().copy(ray).applyMatrix4(inverse);
        const kept = section ? [keptBy(section.clone().applyMatrix4(inverse))] : [];
        const spans = this.halves[body].map((piece) => within(own, [...piece, ...kept]));
        return Math.min(
            ...spans.map((span) => (span && span[1] > 0 ? span[0] : Infinity)),
            ...this.surfaces[body].map((surface) => surface.distance(own, kept)),
        );
    }

    private renew(frame: number): void {
        const at = `${frame} ${this.explode.factor}`;
        if (at === this.at) return;
        this.at = at;
        this.inverses = this.film.bodies.map((_, body) =>
            this.explode.placed(frame, body).invert(),
        );
    }
}

/** The side of a plane that three.js keeps when it clips: where the normal points. */
function keptBy({ normal, constant }: Plane): Half {
    return { normal: normal.clone().negate(), offset: constant };
}
