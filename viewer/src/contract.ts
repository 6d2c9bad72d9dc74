/**
 * What a page is given: a recording, as JSON. Version 2.
 *
 * `python/drystone/recording/contract.py` is the same contract for the side that writes it. Units are
 * SI: metres, kilograms, seconds, radians, newtons. A reader refuses another version; a new version
 * is needed for every change that would make an older page show something wrong.
 */

export const FORMAT = "drystone-recording";
export const VERSION = 2;

export interface Recording {
    format: typeof FORMAT;
    version: typeof VERSION;
    /** An order of removal; a motion in time; small displacements, enlarged. */
    kind: "plan" | "run" | "motion";
    /** Of the space that bodies are in. A vector has so many numbers. */
    dimension: 2 | 3;
    title: string;
    /** What the reader has to know, such as what was left out to bound the page's size. */
    notes: string[];
    /** How much work it took, and what the charts show: for those who ask. */
    details: string[];
    /** m/s^2 */
    gravity: number[];
    /** Everything below names bodies by their index here. */
    bodies: Body[];
    frames: Frames;
    forces: Forces | null;
    /** Permanent loads on bodies. */
    loads: Load[];
    /** One chart each, under the picture. */
    series: Series[];
}

export interface Body {
    name: string;
    /** A fixed body bears any load and never moves. */
    fixed: boolean;
    /** kg */
    mass: number;
    /** kg/m^2, in space kg/m^3 */
    density: number;
    /** The body's own coefficient of friction. */
    friction: number;
    /** In the plane: corners about the centre of mass, m, counter-clockwise. */
    vertices: [number, number][] | null;
    /** In space: convex pieces, which may touch, or one closed surface. */
    pieces: Piece[] | null;
    /**
     * Where the body is without poses. In the plane x, y (m) of the centre of mass and turn (rad,
     * counter-clockwise); in space x, y, z of its frame's origin and a unit quaternion w, x, y, z.
     */
    pose: number[];
}

/** A convex polyhedron, unless it is a closed surface. */
export interface Piece {
    /** Corners in the body's frame, m. */
    vertices: [number, number, number][];
    /** Corners of each face, by index, counter-clockwise from outside. */
    faces: number[][];
    /** Whether it is a closed surface of triangles, which need not be convex. */
    surface: boolean;
}

export interface Frames {
    count: number;
    /** u32 (count): the step each frame shows. Without it, frame k shows step k. */
    steps: Packed | null;
    /** f64 (count), s: when each frame is. Without it the frames are an order, not a motion. */
    times: Packed | null;
    /** f32 (count, bodies, 3 or 7), as `Body.pose`. Without it every body stays at its own pose. */
    poses: Packed | null;
    /** u8 (count, bodies), see `State`. */
    states: Packed;
    /** u8 (count, bodies): 1 for what a hand or a scaffold holds. Without it nothing is held. */
    held: Packed | null;
    /** [frame, text]: what is said from this frame on, frames ascending. */
    captions: [number, string][];
}

/** What a body is in a frame. */
export const State = {
    /** Not there: taken away, or not there yet. */
    absent: 0,
    /** Part of the structure; in a run, moving. */
    present: 1,
    /** In a run: motionless. */
    motionless: 2,
    /** In a plan: the block taken away in the step that follows. */
    next: 3,
    /** Falls, or would fall. */
    falling: 4,
} as const;
export type State = (typeof State)[keyof typeof State];

/** Contact forces, of those frames that have them. Columns, so that equal neighbours deflate well. */
export interface Forces {
    /** u32 (n), ascending: frames whose forces are here. */
    frames: Packed;
    /** u32 (n + 1): those of `frames[k]` are the columns offsets[k] to offsets[k + 1]. */
    offsets: Packed;
    /** u32 (2, m): the body that pushes, and the one that is pushed. */
    bodies: Packed;
    /** f32 (dimension, m), m: x row, y row, z row. */
    points: Packed;
    /** f32 (dimension, m), N, on the second body. */
    vectors: Packed;
}

/** A force that acts on a body all the time. */
export interface Load {
    body: number;
    /** Where, m, while the body is at its own pose; it goes with the body. */
    at: number[];
    /** N, along the axes of the world. */
    force: number[];
}

export interface Series {
    /** As in "pivots": "per step" or the like is part of it. */
    name: string;
    /** "s", or "" for a count. */
    unit: string;
    /** f32 (count): one value a frame, NaN for none. */
    values: Packed;
}

/** A little-endian array in row-major order, deflated (zlib, RFC 1950), in base64. */
export interface Packed {
    dtype: "u8" | "u32" | "f32" | "f64";
    shape: number[];
    data: string;
}
