/** Recordings for the tests, packed as Python packs them. */
import { deflateSync } from "node:zlib";
import { type Packed, type Recording, State } from "../src/contract.ts";
import type { Film } from "../src/film.ts";
import { unpack } from "../src/unpack.ts";

const CODES = [
    [Uint8Array, "u8"],
    [Uint32Array, "u32"],
    [Float32Array, "f32"],
    [Float64Array, "f64"],
] as const;

export function packed(
    values: Uint8Array | Uint32Array | Float32Array | Float64Array,
    shape: number[] = [values.length],
): Packed {
    const dtype = CODES.find(([type]) => values instanceof type)?.[1] ?? "u8";
    return { dtype, shape, data: deflateSync(values).toString("base64") };
}

const SQUARE: [number, number][] = [
    [-0.5, -0.5],
    [0.5, -0.5],
    [0.5, 0.5],
    [-0.5, 0.5],
];

function body(name: string, y: number, fixed = false) {
    const pose = [0, y, 0];
    const shape = { vertices: SQUARE, pieces: null };
    return { name, fixed, mass: 2, density: 2, friction: 0.5, ...shape, pose };
}

/** Two squares on the ground: "top" is taken away, then "low". Forces of frames 0 and 2 only. */
export function planRecording(): Recording {
    const { present, next, absent } = State;
    return {
        format: "drystone-recording",
        version: 2,
        kind: "plan",
        dimension: 2,
        title: "Two squares",
        notes: [],
        details: [],
        gravity: [0, -9.81],
        bodies: [body("ground", -0.5, true), body("low", 0.5), body("top", 1.5)],
        frames: {
            count: 3,
            steps: null,
            times: null,
            poses: null,
            held: null,
            states: packed(
                Uint8Array.of(present, present, next, present, next, absent, 1, absent, absent),
                [3, 3],
            ),
            captions: [
                [0, "Next: top."],
                [2, "Nothing left."],
            ],
        },
        forces: {
            frames: packed(Uint32Array.of(0, 2)),
            offsets: packed(Uint32Array.of(0, 2, 2)),
            bodies: packed(Uint32Array.of(0, 2, 1, 1), [2, 2]),
            points: packed(Float32Array.of(0, 0.25, 0, 1), [2, 2]),
            vectors: packed(Float32Array.of(0, 3, 40, -4), [2, 2]),
        },
        loads: [],
        series: [{ name: "pivots", unit: "", values: packed(Float32Array.of(Number.NaN, 2, 4)) }],
    };
}

/** One square that falls beside another that rests, in steps of 0.1 s; every second step kept. */
export function runRecording(): Recording {
    const { present, motionless } = State;
    return {
        ...planRecording(),
        kind: "run",
        frames: {
            count: 2,
            steps: packed(Uint32Array.of(0, 2)),
            times: packed(Float64Array.of(0, 0.2)),
            held: null,
            poses: packed(
                Float32Array.of(
                    ...[0, -0.5, 0, 0, 0.5, 0, 0, 1.5, 0],
                    ...[0, -0.5, 0, 0, 0.5, 0, 2, 1, Math.PI / 2],
                ),
                [2, 3, 3],
            ),
            states: packed(
                Uint8Array.of(1, motionless, motionless, 1, motionless, present),
                [2, 3],
            ),
            captions: [],
        },
        forces: null,
        series: [],
    };
}

export async function filmOf(recording: Recording): Promise<Film> {
    return await unpack(JSON.stringify(recording));
}
