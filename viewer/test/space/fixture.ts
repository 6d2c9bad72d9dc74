/** Recordings in space for the tests. */
import { type Body, type Piece, type Recording, State } from "../../src/contract.ts";
import type { Film } from "../../src/film.ts";
import { filmOf, packed, planRecording } from "../fixture.ts";

/** A box about a point of its body's frame. */
export function boxPiece(size: number[], at = [0, 0, 0]): Piece {
    const corner = (k: number): [number, number, number] => {
        const side = (axis: number, bit: number) => at[axis] + (k & bit ? 0.5 : -0.5) * size[axis];
        return [side(0, 1), side(1, 2), side(2, 4)];
    };
    const faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    const vertices = Array.from({ length: 8 }, (_, k) => corner(k));
    return { vertices, faces, surface: false };
}

/** Convex pieces apart from each other as one surface of triangles. */
export function surfacePiece(pieces: Piece[]): Piece {
    const vertices = pieces.flatMap((piece) => piece.vertices);
    const faces = pieces.flatMap((piece, i) => {
        const start = pieces.slice(0, i).reduce((sum, { vertices }) => sum + vertices.length, 0);
        const triangles = piece.faces.flatMap(([a, ...rest]) =>
            rest.slice(1).map((c, k) => [a, rest[k], c]),
        );
        return triangles.map((face) => face.map((corner) => corner + start));
    });
    return { vertices, faces, surface: true };
}

export function solid(name: string, at: number[], pieces: Piece[], fixed = false): Body {
    const rest = { mass: 2, density: 2, friction: 0.5, vertices: null };
    return { name, fixed, ...rest, pieces, pose: [...at, 1, 0, 0, 0] };
}

/** Two unit cubes on the ground: "top" is taken away, then "low". One force, in the first frame. */
export function cubes(): Recording {
    const { present, next, absent } = State;
    const plan = planRecording();
    return {
        ...plan,
        dimension: 3,
        gravity: [0, 0, -10],
        bodies: [
            solid("ground", [0, 0, -0.5], [boxPiece([6, 6, 1])], true),
            solid("low", [0, 0, 0.5], [boxPiece([1, 1, 1])]),
            solid("top", [0, 0, 1.5], [boxPiece([1, 1, 1])]),
        ],
        frames: {
            ...plan.frames,
            states: packed(
                Uint8Array.of(present, present, next, present, next, absent, 1, absent, absent),
                [3, 3],
            ),
        },
        forces: {
            frames: packed(Uint32Array.of(0, 1, 2)),
            offsets: packed(Uint32Array.of(0, 1, 1, 1)),
            bodies: packed(Uint32Array.of(0, 1), [2, 1]),
            points: packed(Float32Array.of(0.5, 0.25, 0), [3, 1]),
            vectors: packed(Float32Array.of(1, 2, 2), [3, 1]),
        },
    };
}

export async function cubesFilm(): Promise<Film> {
    return await filmOf(cubes());
}
