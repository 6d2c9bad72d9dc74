/** What is worth showing, and from where: the box around the movable bodies, and the way up. */
import { Vector3 } from "three";
import { State } from "../contract.ts";
import type { Film } from "../film.ts";
import { placedCorners } from "./poses.ts";

/** Frames looked at for the view. */
const SAMPLES = 60;
/** How far bodies that move away may widen the view, in the size of the first frame. */
const MOTION_REACH = 0.5;
/** How far beyond the movable bodies a fixed one may widen the view. */
const FIXED_REACH = 0.12;
/** The eye looks past the broad side by so many radians, to show a second one. */
const ASIDE = 0.55;

export interface Around {
    low: Vector3;
    high: Vector3;
    /** Against gravity, and two unit vectors that lie level. */
    up: Vector3;
    east: Vector3;
    north: Vector3;
    /** Where the eye is first, radians from east to north. */
    turn: number;
}

export function aroundOf(film: Film, low: Vector3, high: Vector3): Around {
    const up = new Vector3(...film.gravity).negate();
    if (up.length() === 0) up.set(0, 0, 1);
    up.normalize();
    const level = Math.abs(up.x) < 0.9 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
    const east = level.addScaledVector(up, -level.dot(up)).normalize();
    const north = new Vector3().crossVectors(up, east);
    const size = high.clone().sub(low);
    const along = (axis: Vector3) =>
        Math.abs(axis.x) * size.x + Math.abs(axis.y) * size.y + Math.abs(axis.z) * size.z;
    const turn = along(east) >= along(north) ? -Math.PI / 2 + ASIDE : -ASIDE;
    return { low, high, up, east, north, turn };
}

function cornersOf(low: Vector3, high: Vector3): Vector3[] {
    const pick = (bit: number, axis: "x" | "y" | "z") => (bit ? high[axis] : low[axis]);
    return Array.from(
        { length: 8 },
        (_, k) => new Vector3(pick(k & 1, "x"), pick(k & 2, "y"), pick(k & 4, "z")),
    );
}

/** Points that the first view shows: of a plan the corners of its blocks, of a run all its box. */
export function shownOf(film: Film, { low, high }: Around): Vector3[] {
    if (film.times) return cornersOf(low, high);
    return film.bodies.flatMap((_, body) =>
        placedCorners(film, 0, body).map((corner) => corner.clamp(low, high)),
    );
}

/** The lowest that anything reaches in the first frame, m along `up`. */
export function floorOf(film: Film, up: Vector3): number {
    let lowest = Infinity;
    for (let body = 0; body < film.bodies.length; body++) {
        for (const corner of placedCorners(film, 0, body))
            lowest = Math.min(lowest, corner.dot(up));
    }
    return Number.isFinite(lowest) ? lowest : 0;
}

/** The box that holds the movable bodies in all frames, and a strip of the fixed ones. */
export function boxOf(film: Film): [Vector3, Vector3] {
    const every = film.bodies.map((_, body) => body);
    const movable = every.filter((body) => !film.bodies[body].fixed);
    const shown = movable.length > 0 ? movable : every;
    if (shown.length === 0) return [new Vector3(0, 0, 0), new Vector3(1, 1, 1)];
    const [low, high] = boxIn(film, 0, shown);
    const fixed = boxIn(film, 0, every);
    const swept: [Vector3, Vector3] = [low.clone(), high.clone()];
    const stride = Math.max(1, Math.floor(film.count / SAMPLES));
    for (let frame = stride; frame < film.count && film.times; frame += stride) {
        const there = shown.filter((body) => film.state(frame, body) !== State.absent);
        const now = boxIn(film, frame, there);
        swept[0].min(now[0]);
        swept[1].max(now[1]);
    }
    let box: [Vector3, Vector3] = [low, high];
    // First how far it falls, then as far beside it.
    for (let turn = 0; turn < 2; turn++) {
        const limit = asFarAsItFalls(grown([low, high], MOTION_REACH * sizeOf(box)), fixed, film);
        box = joined([low, high], swept, limit);
    }
    return movable.length > 0 ? joined(box, fixed, grown(box, FIXED_REACH * sizeOf(box))) : box;
}

function sizeOf([low, high]: [Vector3, Vector3]): number {
    return Math.max(...high.clone().sub(low).toArray());
}

function grown([low, high]: [Vector3, Vector3], by: number): [Vector3, Vector3] {
    return [low.clone().subScalar(by), high.clone().addScalar(by)];
}

/** The limit, but down to where fixed bodies are: what falls on them is seen to land. */
function asFarAsItFalls(
    [low, high]: [Vector3, Vector3],
    fixed: [Vector3, Vector3],
    film: Film,
): [Vector3, Vector3] {
    const pull = new Vector3(...film.gravity);
    for (const axis of ["x", "y", "z"] as const) {
        if (pull[axis] < 0) low[axis] = Math.min(low[axis], fixed[0][axis]);
        if (pull[axis] > 0) high[axis] = Math.max(high[axis], fixed[1][axis]);
    }
    return [low, high];
}

/** A box that holds one, and of another what is within the limit. */
function joined(
    one: [Vector3, Vector3],
    other: [Vector3, Vector3],
    limit: [Vector3, Vector3],
): [Vector3, Vector3] {
    return [
        one[0].clone().min(other[0].clone().max(limit[0])),
        one[1].clone().max(other[1].clone().min(limit[1])),
    ];
}

function boxIn(film: Film, frame: number, bodies: number[]): [Vector3, Vector3] {
    const low = new Vector3(Infinity, Infinity, Infinity);
    const high = low.clone().negate();
    for (const body of bodies) {
        for (const corner of placedCorners(film, frame, body)) {
            low.min(corner);
            high.max(corner);
        }
    }
    return [low, high];
}
