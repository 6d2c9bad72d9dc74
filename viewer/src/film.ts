/** A recording in memory: what is where in each frame, and what pushes what. */
import { type Body, type Load, type Recording, State } from "./contract.ts";

export interface FilmForces {
    frames: Uint32Array;
    offsets: Uint32Array;
    bodies: Uint32Array;
    points: Float32Array;
    vectors: Float32Array;
}

export interface FilmArrays {
    states: Uint8Array;
    held: Uint8Array | null;
    poses: Float32Array | null;
    times: Float64Array | null;
    steps: Uint32Array | null;
    forces: FilmForces | null;
    series: Float32Array[];
}

/** One contact force, N, on body `b`. In the plane z and fz are 0. */
export interface Force {
    a: number;
    b: number;
    x: number;
    y: number;
    z: number;
    fx: number;
    fy: number;
    fz: number;
}

export class Film {
    readonly kind: Recording["kind"];
    readonly title: string;
    readonly notes: string[];
    readonly details: string[];
    readonly dimension: 2 | 3;
    readonly gravity: number[];
    readonly bodies: Body[];
    readonly loads: Load[];
    readonly count: number;
    /** Width and height (and depth) of each body in its own frame, m. */
    readonly sizes: number[][];
    readonly series: { name: string; unit: string; values: Float32Array }[];
    /** The median over movable bodies of the mean side (geometric) of the bounding box, m. */
    readonly typicalSize: number;
    private readonly arrays: FilmArrays;
    private readonly captions: [number, string][];

    constructor(recording: Recording, arrays: FilmArrays) {
        this.kind = recording.kind;
        this.title = recording.title;
        this.notes = recording.notes;
        this.details = recording.details ?? [];
        this.dimension = recording.dimension;
        this.gravity = recording.gravity;
        this.bodies = recording.bodies;
        this.loads = recording.loads ?? [];
        this.count = recording.frames.count;
        this.captions = recording.frames.captions;
        this.sizes = this.bodies.map(({ vertices, pieces }) =>
            extent(vertices ?? (pieces ?? []).flatMap((piece) => piece.vertices)),
        );
        const movable = this.sizes.filter((_, body) => !this.bodies[body].fixed);
        const sides = movable.map(meanSide);
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

    /** Whether a hand or a scaffold holds a body. */
    held(frame: number, body: number): boolean {
        return this.arrays.held?.[frame * this.bodies.length + body] === 1;
    }

    /** Whether anything is held in a frame, by default in any. */
    holds(frame?: number): boolean {
        const { held } = this.arrays;
        const n = this.bodies.length;
        const some = frame === undefined ? held : held?.subarray(frame * n, (frame + 1) * n);
        return some?.includes(1) ?? false;
    }

    /** Where a body is, as `Body.pose`. */
    pose(frame: number, body: number): ArrayLike<number> & Iterable<number> {
        const { poses } = this.arrays;
        const own = this.bodies[body].pose;
        if (!poses) return own;
        const at = own.length * (frame * this.bodies.length + body);
        return poses.subarray(at, at + own.length);
    }

    /** Corners of a body in the plane, as x, y, x, y, ... */
    corners(frame: number, body: number): number[] {
        const vertices = this.bodies[body].vertices ?? [];
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

    /**
     * The last frame up to `frame` whose forces are in the recording; -1 for none. Forces from
     * before blocks were held say nothing of what holds.
     */
    forcesFrame(frame: number): number {
        const frames = this.arrays.forces?.frames ?? new Uint32Array();
        const last = frames[lastUpTo(frames, frame)] ?? -1;
        return last !== frame && this.holds(frame) ? -1 : last;
    }

    /** Contact forces of a frame; null if they are not in the recording. */
    forces(frame: number): Force[] | null {
        const { forces } = this.arrays;
        if (!forces || this.forcesFrame(frame) !== frame) return null;
        const k = lastUpTo(forces.frames, frame);
        const { points, vectors } = forces;
        const m = points.length / this.dimension;
        const deep = this.dimension === 3;
        const found: Force[] = [];
        for (let i = forces.offsets[k]; i < forces.offsets[k + 1]; i++) {
            found.push({
                a: forces.bodies[i],
                b: forces.bodies[m + i],
                x: points[i],
                y: points[m + i],
                z: deep ? points[2 * m + i] : 0,
                fx: vectors[i],
                fy: vectors[m + i],
                fz: deep ? vectors[2 * m + i] : 0,
            });
        }
        return found;
    }

    /** The loads of a frame: those on bodies that are there, where these have taken them. */
    loadsOf(frame: number): Load[] {
        const there = this.loads.filter(({ body }) => this.state(frame, body) !== State.absent);
        return there.map((load) => ({ ...load, at: this.carried(frame, load.body, load.at) }));
    }

    /** A point of the world that goes with a body, from where it is at the body's own pose. */
    private carried(frame: number, body: number, at: number[]): number[] {
        const [own, now] = [this.bodies[body].pose, [...this.pose(frame, body)]];
        const arm = at.map((x, k) => x - own[k]);
        const turned =
            this.dimension === 2
                ? inPlane(now[2] - own[2], arm)
                : inSpace(now.slice(3), inSpace(inverse(own.slice(3)), arm));
        return turned.map((x, k) => x + now[k]);
    }

    /** Magnitudes of all forces in the recording, and of its loads, N. */
    magnitudes(): Float32Array {
        const vectors = this.arrays.forces?.vectors ?? new Float32Array();
        const m = vectors.length / this.dimension;
        const z = this.dimension === 3 ? (i: number) => vectors[2 * m + i] : () => 0;
        const forces = Array.from({ length: m }, (_, i) =>
            Math.hypot(vectors[i], vectors[m + i], z(i)),
        );
        return Float32Array.from([...forces, ...this.loads.map(({ force }) => size(force))]);
    }

    /** The most forces that a frame has. */
    mostForces(): number {
        const offsets = this.arrays.forces?.offsets ?? new Uint32Array();
        let most = 0;
        for (let k = 1; k < offsets.length; k++) {
            most = Math.max(most, offsets[k] - offsets[k - 1]);
        }
        return most;
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

function size(vector: number[]): number {
    return Math.hypot(...vector);
}

/** Turned counter-clockwise, rad. */
function inPlane(turn: number, [x, y]: number[]): number[] {
    const [cos, sin] = [Math.cos(turn), Math.sin(turn)];
    return [cos * x - sin * y, sin * x + cos * y];
}

/** Turned by a unit quaternion w, x, y, z: v + 2 w (q x v) + 2 q x (q x v). */
function inSpace([w, ...q]: number[], v: number[]): number[] {
    const once = cross(q, v);
    const twice = cross(q, once);
    return v.map((x, k) => x + 2 * w * once[k] + 2 * twice[k]);
}

function inverse([w, ...q]: number[]): number[] {
    return [w, ...q.map((x) => -x)];
}

function cross([a, b, c]: number[], [x, y, z]: number[]): number[] {
    return [b * z - c * y, c * x - a * z, a * y - b * x];
}

/** Sides of the box around some points. */
function extent(points: number[][]): number[] {
    return (points[0] ?? []).map((_, axis) => {
        const values = points.map((point) => point[axis]);
        return Math.max(...values) - Math.min(...values);
    });
}

function meanSide(sides: number[]): number {
    return sides.reduce((product, side) => product * side, 1) ** (1 / sides.length);
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
