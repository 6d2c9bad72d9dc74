/** The watcher's eye: it goes round a point, up and down, nearer and farther. */
import { PerspectiveCamera, Vector3 } from "three";
import type { Around } from "./view.ts";

/** Degrees from top to bottom of the picture: narrow, so that right angles look right. */
const FIELD = 28;
/** The eye stays this far (radians) from straight above and straight below. */
const POLE = 0.02;
const MARGIN = 1.06;
/** Each brings a view nearer to its place by far more than a half. */
const ROUNDS = 5;
const [NEAREST, FARTHEST] = [0.02, 12];

export class Orbit {
    readonly camera = new PerspectiveCamera(FIELD);
    private readonly around: Around;
    private readonly target = new Vector3();
    private turn = 0;
    private tilt = 0;
    private distance = 1;
    private fitted = 1;
    /** Whether the watcher has changed distance or middle, which then stay as they are. */
    moved = false;

    constructor(around: Around) {
        this.around = around;
        this.camera.up.copy(around.up);
        this.restore();
    }

    /** The first view. */
    restore(): void {
        this.turn = this.around.turn;
        this.tilt = 0.34;
        this.moved = false;
        this.place();
    }

    /** As near as shows these corners, as the eye is turned now; not if the watcher chose. */
    fit(corners: Vector3[], aspect: number): void {
        this.camera.aspect = aspect;
        this.camera.updateProjectionMatrix();
        if (this.moved || corners.length === 0) return;
        const { right, up, back } = this.axes();
        this.target.set(0, 0, 0);
        for (const axis of [right, up, back]) {
            const { low, high } = span(corners.map((corner) => corner.dot(axis)));
            this.target.addScaledVector(axis, (low + high) / 2);
        }
        const tall = Math.tan((FIELD * Math.PI) / 360);
        const arm = new Vector3();
        this.fitted = corners.reduce((most, corner) => {
            arm.copy(corner).sub(this.target);
            const wide = Math.abs(arm.dot(right)) / (tall * aspect);
            return Math.max(most, Math.max(wide, Math.abs(arm.dot(up)) / tall) + arm.dot(back));
        }, 1e-9);
        this.distance = this.fitted;
        this.place();
        for (let round = 0; round < ROUNDS; round++) this.centre(corners, right, up);
        this.fitted = this.distance *= MARGIN;
        this.place();
    }

    /** Puts what is seen of these corners, near ones larger than far ones, in the picture's middle. */
    private centre(corners: Vector3[], right: Vector3, up: Vector3): void {
        const seen = corners.map((corner) => corner.clone().project(this.camera));
        const [x, y] = [span(seen.map((at) => at.x)), span(seen.map((at) => at.y))];
        const tall = this.distance * Math.tan((FIELD * Math.PI) / 360);
        this.target.addScaledVector(right, ((x.low + x.high) / 2) * tall * this.camera.aspect);
        this.target.addScaledVector(up, ((y.low + y.high) / 2) * tall);
        this.distance *= Math.max(x.high - x.low, y.high - y.low) / 2;
        this.place();
    }

    /** Turns by so many radians about the vertical, and tilts. */
    rotate(turn: number, tilt: number): void {
        const most = Math.PI / 2 - POLE;
        this.turn += turn;
        this.tilt = Math.min(Math.max(this.tilt + tilt, -most), most);
        this.place();
    }

    /** Moves what is seen by a share of the picture's height. */
    pan(right: number, up: number): void {
        const seen = 2 * this.distance * Math.tan((FIELD * Math.PI) / 360);
        const axes = this.axes();
        this.target.addScaledVector(axes.right, -right * seen);
        this.target.addScaledVector(axes.up, -up * seen);
        this.moved = true;
        this.place();
    }

    zoom(factor: number): void {
        const [least, most] = [NEAREST * this.fitted, FARTHEST * this.fitted];
        this.distance = Math.min(Math.max(this.distance / factor, least), most);
        this.moved = true;
        this.place();
    }

    /** Metres that a pixel shows at the middle, in a picture so many pixels high. */
    metresAPixel(height: number): number {
        return (2 * this.distance * Math.tan((FIELD * Math.PI) / 360)) / Math.max(height, 1);
    }

    /** The picture's right and up, and the way back to the eye. */
    private axes(): { right: Vector3; up: Vector3; back: Vector3 } {
        const { up, east, north } = this.around;
        const level = new Vector3()
            .addScaledVector(east, Math.cos(this.turn))
            .addScaledVector(north, Math.sin(this.turn));
        const back = level
            .multiplyScalar(Math.cos(this.tilt))
            .addScaledVector(up, Math.sin(this.tilt));
        const right = new Vector3().crossVectors(up, back).normalize();
        return { right, up: new Vector3().crossVectors(back, right), back };
    }

    private place(): void {
        this.camera.position.copy(this.target).addScaledVector(this.axes().back, this.distance);
        this.camera.near = this.distance / 100;
        this.camera.far = this.distance * 10 + 100 * this.fitted;
        this.camera.lookAt(this.target);
        this.camera.updateProjectionMatrix();
        this.camera.updateMatrixWorld();
    }
}

function span(values: number[]): { low: number; high: number } {
    return values.reduce(
        ({ low, high }, value) => ({ low: Math.min(low, value), high: Math.max(high, value) }),
        { low: Infinity, high: -Infinity },
    );
}
