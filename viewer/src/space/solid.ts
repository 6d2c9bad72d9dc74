/** A body's surface as triangles, and its edges as lines. */
import { BufferGeometry, Float32BufferAttribute, type Vector3 } from "three";
import type { Body, Piece } from "../contract.ts";
import { type Face, facesOfPiece, inOnePlane, normalOf } from "./faces.ts";
import { along, without } from "./seams.ts";

/** Corners closer than this share of the body's size are one. */
const SAME = 1e-5;

/** Cosine of the angle by which a surface turns at an edge that is drawn: 0.35 radians. */
const SHARP = 0.94;

/** All faces, fanned into triangles, each with the normal of its face. */
export function facesOf({ pieces }: Body): BufferGeometry {
    const positions: number[] = [];
    const normals: number[] = [];
    for (const piece of pieces ?? []) {
        for (const face of piece.faces) {
            const corners = face.map((at) => piece.vertices[at]);
            const normal = normalOf(piece, face).toArray();
            for (let i = 2; i < corners.length; i++) {
                positions.push(...corners[0], ...corners[i - 1], ...corners[i]);
                normals.push(...normal, ...normal, ...normal);
            }
        }
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
    geometry.setAttribute("normal", new Float32BufferAttribute(normals, 3));
    return geometry;
}

/** Every edge once, as x, y, z of its two ends; none between two faces that lie in one plane. */
export function edgesOf({ pieces }: Body): number[] {
    const near = SAME * sizeOf(pieces ?? []);
    const faces = (pieces ?? []).map(facesOfPiece);
    const seen = new Map<string, Vector3[]>();
    faces.forEach((own, at) => {
        const others = faces.filter((_, piece) => piece !== at).flat();
        const curved = pieces?.[at].surface ?? false;
        for (const [a, b, beside] of edgesOfPiece(own, near)) {
            if (curved && isSeam(beside)) continue;
            const seams = others
                .filter((face) => beside.some((one) => inOnePlane(one, face, near)))
                .map((face) => along(face, a, b, near))
                .filter((part) => part !== null);
            for (const [t0, t1] of without(seams)) {
                const ends = [a.clone().lerp(b, t0), a.clone().lerp(b, t1)];
                seen.set(nameOf(ends, near), ends);
            }
        }
    });
    return [...seen.values()].flatMap((ends) => ends.flatMap((end) => end.toArray()));
}

/** The edges of a convex piece, each with the two faces beside it; none within a plane. */
function edgesOfPiece(faces: Face[], near: number): [Vector3, Vector3, Face[]][] {
    const found = new Map<string, [Vector3, Vector3, Face[]]>();
    for (const face of faces) {
        face.corners.forEach((a, i) => {
            const b = face.corners[(i + 1) % face.corners.length];
            const name = nameOf([a, b], near);
            const edge = found.get(name) ?? [a, b, []];
            edge[2].push(face);
            found.set(name, edge);
        });
    }
    return [...found.values()].filter(
        ([, , [one, other]]) => !other || !inOnePlane(one, other, near),
    );
}

/** Whether an edge is one between facets of a curved surface. */
function isSeam([one, other]: Face[]): boolean {
    return other !== undefined && one.normal.dot(other.normal) > SHARP;
}

/** The same for ends in the same places, in whichever order. */
function nameOf(ends: Vector3[], near: number): string {
    const names = ends.map((end) => end.toArray().map((value) => Math.round(value / (2 * near))));
    return names
        .map((name) => name.join())
        .sort()
        .join(" ");
}

/** The largest distance of a corner from the frame's origin along an axis. */
function sizeOf(pieces: Piece[]): number {
    return Math.max(...pieces.flatMap(({ vertices }) => vertices.flat().map(Math.abs)), 1e-300);
}
