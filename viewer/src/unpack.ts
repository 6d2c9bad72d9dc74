/** From the JSON of a recording to arrays, with a clear error for what cannot be read. */
import { FORMAT, type Packed, type Recording, VERSION } from "./contract.ts";
import { Film, type FilmForces } from "./film.ts";

const ARRAYS = {
    u8: Uint8Array,
    u32: Uint32Array,
    f32: Float32Array,
    f64: Float64Array,
} as const;
type Arrays = { [K in keyof typeof ARRAYS]: InstanceType<(typeof ARRAYS)[K]> };

/** Reads a recording; throws an Error with one line for people. */
export async function unpack(text: string): Promise<Film> {
    const recording = parsed(text);
    const { frames, bodies } = recording;
    const per = (...shape: number[]) => shape;
    const pose = recording.dimension === 3 ? 7 : 3;
    const [states, held, poses, times, steps, forces, ...series] = await Promise.all([
        array(frames.states, "u8", per(frames.count, bodies.length)),
        optional(frames.held, "u8", per(frames.count, bodies.length)),
        optional(frames.poses, "f32", per(frames.count, bodies.length, pose)),
        optional(frames.times, "f64", per(frames.count)),
        optional(frames.steps, "u32", per(frames.count)),
        recording.forces && forcesOf(recording.forces),
        ...recording.series.map((one) => array(one.values, "f32", per(frames.count))),
    ]);
    return new Film(recording, { states, held, poses, times, steps, forces, series });
}

function parsed(text: string): Recording {
    const recording = JSON.parse(text) as Partial<Recording>;
    if (recording.format !== FORMAT) {
        throw new Error("This page holds no recording of drystone.");
    }
    if (recording.version !== VERSION) {
        throw new Error(
            `The recording has version ${recording.version}; this page reads version ${VERSION}.`,
        );
    }
    return recording as Recording;
}

async function forcesOf(packed: NonNullable<Recording["forces"]>): Promise<FilmForces> {
    const [frames, offsets, bodies, points, vectors] = await Promise.all([
        array(packed.frames, "u32"),
        array(packed.offsets, "u32"),
        array(packed.bodies, "u32"),
        array(packed.points, "f32"),
        array(packed.vectors, "f32"),
    ]);
    return { frames, offsets, bodies, points, vectors };
}

function optional<K extends keyof Arrays>(packed: Packed | null, dtype: K, shape: number[]) {
    return packed && array(packed, dtype, shape);
}

/** One array, of the type and (if given) the shape that the contract says. */
export async function array<K extends keyof Arrays>(
    packed: Packed,
    dtype: K,
    shape: number[] = packed.shape,
): Promise<Arrays[K]> {
    if (packed.dtype !== dtype || packed.shape.join() !== shape.join()) {
        throw new Error(
            `The recording is damaged: ${packed.dtype} (${packed.shape}) where ${dtype} (${shape}) is due.`,
        );
    }
    const values = new ARRAYS[dtype](await inflated(packed.data)) as Arrays[K];
    if (values.length !== shape.reduce((size, side) => size * side, 1)) {
        throw new Error("The recording is damaged: an array is cut short.");
    }
    return values;
}

async function inflated(base64: string): Promise<ArrayBuffer> {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return await new Response(stream).arrayBuffer();
}
