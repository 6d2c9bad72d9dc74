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
    readonly series: { name: string; unit: string; values: Float32Array }[];
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
        const [x, y, turn] = this.pose(frame, body);
        const [cos, sin] = [Math.cos(turn), Math.sin(turn)];
        return this.bodies[body].vertices.flatMap(([vx, vy]) => [
            x + cos * vx - sin * vy,
            y + sin * vx + cos * vy,
        ]);
    }

    get hasForces(): boolean {
        return this.arrays.forces !== null;
    }

    /** Contact forces of a frame; null if they are not in the recording. */
    forces(frame: number): Force[] | null {
        const { forces } = this.arrays;
        const k = forces ? position(forces.frames, frame) : -1;
        if (!forces || k < 0) return null;
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

/** Index of `value` in an ascending array, -1 if it is not there. */
export function position(ascending: Uint32Array, value: number): number {
    let [low, high] = [0, ascending.length];
    while (low < high) {
        const middle = (low + high) >> 1;
        if (ascending[middle] < value) low = middle + 1;
        else high = middle;
    }
    return ascending[low] === value ? low : -1;
}
