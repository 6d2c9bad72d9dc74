/** Convex pieces met by a line and by a plane. */
import { type Matrix4, type Plane, type Ray, Vector3 } from "three";
import type { Piece } from "../contract.ts";
import { normalOf } from "./faces.ts";

export interface Half {
    normal: Vector3;
    offset: number;
}

/** A piece as half-spaces normal · x <= offset, one a face. */
export function halvesOf(piece: Piece): Half[] {
    return piece.faces.map((face) => {
        const normal = normalOf(piece, face);
        return { normal, offset: normal.dot(new Vector3(...piece.vertices[face[0]])) };
    });
}

/** The part [from, to] of a ray within half-spaces, as multiples of its direction; null for none. */
export function within(ray: Ray, halves: Half[]): [number, number] | null {
    let [from, to] = [-Infinity, Infinity];
    for (const { normal, offset } of halves) {
        const speed = normal.dot(ray.direction);
        const gap = offset - normal.dot(ray.origin);
        if (speed > 0) to = Math.min(to, gap / speed);
        else if (speed < 0) from = Math.max(from, gap / speed);
        else if (gap < 0) return null;
    }
    return from < to ? [from, to] : null;
}

/** Where a plane cuts a piece: a convex polygon, its corners counter-clockwise about the normal. */
export function cut({ vertices, faces }: Piece, matrix: Matrix4, plane: Plane): Vector3[] {
    const corners = vertices.map((vertex) => new Vector3(...vertex).applyMatrix4(matrix));
    const height = corners.map((corner) => plane.distanceToPoint(corner));
    const found: Vector3[] = [];
    for (const face of faces) {
        face.forEach((a, i) => {
            const b = face[(i + 1) % face.length];
            // Every edge is in two faces, once each way.
            if (a > b || height[a] > 0 === height[b] > 0) return;
            const share = height[a] / (height[a] - height[b]);
            found.push(corners[a].clone().lerp(corners[b], share));
        });
    }
    return aroundMiddle(found, plane.normal);
}

function aroundMiddle(points: Vector3[], normal: Vector3): Vector3[] {
    if (points.length < 3) return [];
    const middle = new Vector3();
    for (const point of points) middle.add(point);
    middle.divideScalar(points.length);
    const east = points[0].clone().sub(middle).normalize();
    const north = new Vector3().crossVectors(normal, east);
    const angle = (point: Vector3) => {
        const arm = point.clone().sub(middle);
        return Math.atan2(arm.dot(north), arm.dot(east));
    };
    return points.sort((a, b) => angle(a) - angle(b));
}
