/** A recording in memory: what is where in each frame, and what pushes what. */
import { type Body, type Recording, State } from "./contract.ts";

export interface FilmForces {
    frames: Uint32Array;
    offsets: Uint32Array;
    bodies: Uint32Array;
    points: Float32Array;
    vectors: Float32Array;
}

export interface FilmArrays {
    states: Uint8Array;
    poses: Float32Array | null;
    times: Float64Array | null;
    steps: Uint32Array | null;
    forces: FilmForces | null;
    series: Float32Array[];
}

/** One contact force, N, on body `b`. */
export interface Force {
    a: number;
    b: number;
    x: number;
    y: number;
    fx: number;
    fy: number;
}

export class Film {
    readonly kind: Recording["kind"];
    readonly title: string;
    readonly notes: string[];
    readonly gravity: [number, number];
    readonly bodies: Body[];
    readonly count: number;
    /** Width and height of each body in its own frame, m. */
    readonly sizes: [number, number][];
    readonly series: { name: string; unit: string; values: Float32Array }[];
    /** The median over movable bodies of the square root of the area of the bounding box, m. */
    readonly typicalSize: number;
    private readonly arrays: FilmArrays;
    private readonly captions: [number, string][];

    constructor(recording: Recording, arrays: FilmArrays) {
        this.kind = recording.kind;
        this.title = recording.title;
        this.notes = recording.notes;
        this.gravity = recording.gravity;
        this.bodies = recording.bodies;
        this.count = recording.frames.count;
        this.captions = recording.frames.captions;
        this.sizes = this.bodies.map(({ vertices }) => [spread(vertices, 0), spread(vertices, 1)]);
        const movable = this.sizes.filter((_, body) => !this.bodies[body].fixed);
        const sides = movable.map(([width, height]) => Math.sqrt(width * height));
        this.typicalSize = sides.sort((a, b) => a - b)[sides.length >> 1] ?? 1;
        this.arrays = arrays;
        this.series = recording.series.map(({ name, unit }, k) => ({
            name,
            unit,
            values: arrays.series[k],
        }));
    }

    get times(): Float64Array | null {
        return this.arrays.times;
    }

    /** The number of the step that a frame shows. */
    step(frame: number): number {
        return this.arrays.steps?.[frame] ?? frame;
    }

    state(frame: number, body: number): State {
        return this.arrays.states[frame * this.bodies.length + body] as State;
    }

    /** x, y and turn of a body. */
    pose(frame: number, body: number): [number, number, number] {
        const { poses } = this.arrays;
        if (!poses) return this.bodies[body].pose;
        const at = 3 * (frame * this.bodies.length + body);
        return [poses[at], poses[at + 1], poses[at + 2]];
    }

    /** Corners of a body in the world, as x, y, x, y, ... */
    corners(frame: number, body: number): number[] {
        const { vertices } = this.bodies[body];
        const [x, y, turn] = this.pose(frame, body);
        const [cos, sin] = [Math.cos(turn), Math.sin(turn)];
        const corners = new Array<number>(2 * vertices.length);
        for (let i = 0; i < vertices.length; i++) {
            const [vx, vy] = vertices[i];
            corners[2 * i] = x + cos * vx - sin * vy;
            corners[2 * i + 1] = y + sin * vx + cos * vy;
        }
        return corners;
    }

    get hasForces(): boolean {
        return this.arrays.forces !== null;
    }

    /** The last frame up to `frame` whose forces are in the recording; -1 for none. */
    forcesFrame(frame: number): number {
        const frames = this.arrays.forces?.frames ?? new Uint32Array();
        return frames[lastUpTo(frames, frame)] ?? -1;
    }

    /** Contact forces of a frame; null if they are not in the recording. */
    forces(frame: number): Force[] | null {
        const { forces } = this.arrays;
        if (!forces || this.forcesFrame(frame) !== frame) return null;
        const k = lastUpTo(forces.frames, frame);
        const m = forces.points.length / 2;
        const found: Force[] = [];
        for (let i = forces.offsets[k]; i < forces.offsets[k + 1]; i++) {
            found.push({
                a: forces.bodies[i],
                b: forces.bodies[m + i],
                x: forces.points[i],
                y: forces.points[m + i],
                fx: forces.vectors[i],
                fy: forces.vectors[m + i],
            });
        }
        return found;
    }

    /** Magnitudes of all forces in the recording, N. */
    magnitudes(): Float32Array {
        const vectors = this.arrays.forces?.vectors ?? new Float32Array();
        const m = vectors.length / 2;
        return Float32Array.from({ length: m }, (_, i) => Math.hypot(vectors[i], vectors[m + i]));
    }

    /** What is said about a frame, if the recording says anything. */
    caption(frame: number): string {
        let said = "";
        for (const [from, text] of this.captions) {
            if (from > frame) break;
            said = text;
        }
        return said;
    }

    /** The last frame, before which a body was there, in which it is not; -1 if it stays. */
    removedIn(body: number): number {
        for (let frame = 1; frame < this.count; frame++) {
            const gone = this.state(frame, body) === State.absent;
            if (gone && this.state(frame - 1, body) !== State.absent) return frame;
        }
        return -1;
    }
}

function spread(vertices: [number, number][], axis: 0 | 1): number {
    const values = vertices.map((vertex) => vertex[axis]);
    return Math.max(...values) - Math.min(...values);
}

/** Index of the last of some ascending numbers that is not above `value`, -1 for none. */
export function lastUpTo(ascending: Uint32Array, value: number): number {
    let [low, high] = [0, ascending.length];
    while (low < high) {
        const middle = (low + high) >> 1;
        if (ascending[middle] <= value) low = middle + 1;
        else high = middle;
    }
    return low - 1;
}
