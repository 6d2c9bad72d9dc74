/** Where an edge is none: along a face of another piece of the body that goes on in the same plane. */
import { Vector3 } from "three";
import type { Face } from "./faces.ts";

/** The part [t0, t1] of the way from `a` to `b` that lies on a face in whose plane both are. */
export function along(face: Face, a: Vector3, b: Vector3, near: number): [number, number] | null {
    let [t0, t1] = [0, 1];
    face.corners.forEach((corner, i) => {
        const side = face.corners[(i + 1) % face.corners.length].clone().sub(corner);
        const inward = new Vector3().crossVectors(face.normal, side).normalize();
        const [start, end] = [a, b].map((point) => inward.dot(point.clone().sub(corner)) + near);
        if (start < 0 && end < 0) [t0, t1] = [1, 0];
        else if (start < 0) t0 = Math.max(t0, start / (start - end));
        else if (end < 0) t1 = Math.min(t1, start / (start - end));
    });
    return (t1 - t0) * a.distanceTo(b) > 4 * near ? [t0, t1] : null;
}

/** What is left of [0, 1] without some parts. */
export function without(parts: [number, number][]): [number, number][] {
    const left: [number, number][] = [];
    let from = 0;
    for (const [t0, t1] of parts.sort((a, b) => a[0] - b[0])) {
        if (t0 > from) left.push([from, t0]);
        from = Math.max(from, t1);
    }
    if (from < 1) left.push([from, 1]);
    return left;
}
