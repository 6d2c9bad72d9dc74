/** Where the bodies of a film are, as matrices. */
import { Matrix4, Quaternion, Vector3 } from "three";
import type { Film } from "../film.ts";

const ONE = new Vector3(1, 1, 1);

/** From a body's frame to the world. */
export function placed(film: Film, frame: number, body: number): Matrix4 {
    const [x, y, z, qw, qx, qy, qz] = film.pose(frame, body);
    const turned = new Quaternion(qx, qy, qz, qw).normalize();
    return new Matrix4().compose(new Vector3(x, y, z), turned, ONE);
}

/** The corners of a body in the world. */
export function placedCorners(film: Film, frame: number, body: number): Vector3[] {
    const matrix = placed(film, frame, body);
    return (film.bodies[body].pieces ?? []).flatMap(({ vertices }) =>
        vertices.map((vertex) => new Vector3(...vertex).applyMatrix4(matrix)),
    );
}

/** The middle of a body's corners in its own frame. */
export function middleOf(film: Film, body: number): Vector3 {
    const points = (film.bodies[body].pieces ?? []).flatMap(({ vertices }) => vertices);
    const sum = new Vector3();
    for (const point of points) sum.add(new Vector3(...point));
    return sum.divideScalar(Math.max(points.length, 1));
}
