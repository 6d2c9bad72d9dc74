/** Faces of convex pieces, their normals and planes. */
import { Vector3 } from "three";
import type { Piece } from "../contract.ts";

export interface Face {
    corners: Vector3[];
    normal: Vector3;
}

export function facesOfPiece(piece: Piece): Face[] {
    return piece.faces.map((face) => ({
        corners: face.map((corner) => new Vector3(...piece.vertices[corner])),
        normal: normalOf(piece, face),
    }));
}

/** Whether two faces look the same way in one plane, up to `near` metres. */
export function inOnePlane(a: Face, b: Face, near: number): boolean {
    if (a.normal.distanceTo(b.normal) > 1e-5) return false;
    return Math.abs(a.normal.dot(b.corners[0].clone().sub(a.corners[0]))) < near;
}

/** The unit normal of a face, outward (Newell: right for every convex loop). */
export function normalOf({ vertices }: Piece, face: number[]): Vector3 {
    const normal = new Vector3();
    face.forEach((corner, i) => {
        const a = new Vector3(...vertices[corner]);
        normal.add(a.cross(new Vector3(...vertices[face[(i + 1) % face.length]])));
    });
    return normal.normalize();
}
