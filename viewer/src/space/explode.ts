/** Bodies drawn apart, so that one sees between them: each goes away from the middle of the foot. */
import { type Matrix4, Vector3 } from "three";
import type { Film } from "../film.ts";
import { middleOf, placed } from "./poses.ts";
import type { Around } from "./view.ts";

export class Explode {
    /** 0: as they are; 1: twice as far from each other. */
    factor = 0;
    private readonly film: Film;
    private readonly foot: Vector3;
    /** Of each body at factor 1, m. */
    private readonly ways: Vector3[];

    constructor(film: Film, { low, high, up }: Around) {
        this.film = film;
        const foot = low.clone().add(high).multiplyScalar(0.5);
        const size = high.clone().sub(low);
        const tall = Math.abs(up.x) * size.x + Math.abs(up.y) * size.y + Math.abs(up.z) * size.z;
        foot.addScaledVector(up, -tall / 2);
        this.foot = foot;
        this.ways = film.bodies.map(({ fixed }, body) =>
            fixed
                ? new Vector3()
                : middleOf(film, body)
                      .applyMatrix4(placed(film, 0, body))
                      .sub(foot),
        );
    }

    /** How far a body is drawn from where it is, m. */
    of(body: number): Vector3 {
        return this.ways[body].clone().multiplyScalar(this.factor);
    }

    /** Where a point of a movable body would be drawn, were it the body's middle. */
    moved(point: Vector3): Vector3 {
        return point.clone().addScaledVector(point.clone().sub(this.foot), this.factor);
    }

    /** From a body's frame to where it is drawn. */
    placed(frame: number, body: number): Matrix4 {
        const matrix = placed(this.film, frame, body);
        const at = new Vector3().setFromMatrixPosition(matrix);
        return matrix.setPosition(at.add(this.of(body)));
    }
}
