/** A closed surface of triangles met by a ray. */
import { Box3, type Ray, Sphere, Vector3 } from "three";
import type { Piece } from "../contract.ts";
import type { Half } from "./hull.ts";

export class Triangles {
    private readonly corners: Vector3[];
    private readonly faces: number[][];
    private readonly ball = new Sphere();

    constructor({ vertices, faces }: Piece) {
        this.corners = vertices.map((vertex) => new Vector3(...vertex));
        this.faces = faces;
        new Box3().setFromPoints(this.corners).getBoundingSphere(this.ball);
    }

    /** How far along the ray it first meets the surface within half-spaces; Infinity if nowhere. */
    distance(ray: Ray, kept: Half[]): number {
        if (!ray.intersectsSphere(this.ball)) return Infinity;
        let nearest = Infinity;
        const at = new Vector3();
        for (const face of this.faces) {
            const [a, b, c] = face.map((corner) => this.corners[corner]);
            if (!ray.intersectTriangle(a, b, c, false, at)) continue;
            if (kept.some(({ normal, offset }) => normal.dot(at) > offset)) continue;
            nearest = Math.min(nearest, at.distanceTo(ray.origin));
        }
        return nearest;
    }
}
