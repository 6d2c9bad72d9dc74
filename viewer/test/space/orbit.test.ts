import assert from "node:assert/strict";
import { test } from "node:test";
import { Vector3 } from "three";
import { Orbit } from "../../src/space/orbit.ts";
import { aroundOf, boxOf, floorOf, shownOf } from "../../src/space/view.ts";
import { filmOf, packed } from "../fixture.ts";
import { cubes, cubesFilm } from "./fixture.ts";

async function orbit() {
    const film = await cubesFilm();
    const around = aroundOf(film, ...boxOf(film));
    const shown = shownOf(film, around);
    const made = new Orbit(around);
    made.fit(shown, 1.5);
    return { made, shown };
}

/** The largest |x| and |y| of points on the picture; 1 is its edge. */
function reach(made: Orbit, points: Vector3[]): [number, number] {
    const seen = points.map((point) => point.clone().project(made.camera));
    return [
        Math.max(...seen.map(({ x }) => Math.abs(x))),
        Math.max(...seen.map(({ y }) => Math.abs(y))),
    ];
}

test("the first view holds everything, and hardly more", async () => {
    const { made, shown } = await orbit();
    const [x, y] = reach(made, shown);
    assert.ok(x <= 1 && y <= 1);
    assert.ok(Math.max(x, y) > 0.9);
});

test("turning keeps the distance, and up stays up", async () => {
    const { made } = await orbit();
    const before = made.camera.position.clone();
    made.rotate(1, 0.2);
    assert.ok(made.camera.position.distanceTo(before) > 0.5);
    for (const tilt of [9, -18]) {
        made.rotate(0, tilt);
        const up = new Vector3(0, 0, 1).applyQuaternion(made.camera.quaternion.clone().invert());
        assert.ok(up.y > 0, "never over the pole");
    }
});

test("zoom and pan stay until everything is asked for", async () => {
    const { made, shown } = await orbit();
    const first = made.camera.position.clone();
    made.zoom(2);
    made.pan(0.1, 0);
    const chosen = made.camera.position.clone();
    made.fit(shown, 1.5);
    assert.ok(made.camera.position.distanceTo(chosen) < 1e-12);
    made.restore();
    made.fit(shown, 1.5);
    assert.ok(made.camera.position.distanceTo(first) < 1e-9);
});

test("a wide ground does not take the view, and gravity says what is up", async () => {
    const film = await cubesFilm();
    const [low, high] = boxOf(film);
    assert.ok(low.x > -1 && high.x < 1 && low.z < 0);
    assert.equal(floorOf(film, new Vector3(0, 0, 1)), -1);
    const leaning = await filmOf({ ...cubes(), gravity: [-6, 0, -8] });
    const { up, east, north } = aroundOf(leaning, ...boxOf(leaning));
    assert.ok(up.distanceTo(new Vector3(0.6, 0, 0.8)) < 1e-12);
    assert.ok(Math.abs(east.dot(up)) < 1e-12 && Math.abs(north.length() - 1) < 1e-12);
});

test("what falls from high up is in the box where it lands", async () => {
    const plan = cubes();
    const still = [1, 0, 0, 0];
    const at = (z: number) => [0, 0, z, ...still];
    const film = await filmOf({
        ...plan,
        kind: "run",
        frames: {
            ...plan.frames,
            count: 2,
            times: packed(Float64Array.of(0, 2)),
            poses: packed(
                Float32Array.of(
                    ...at(-0.5),
                    ...at(20),
                    ...at(21),
                    ...at(-0.5),
                    ...at(0.5),
                    ...at(1.5),
                ),
                [2, 3, 7],
            ),
            states: packed(new Uint8Array(6).fill(1), [2, 3]),
            captions: [],
        },
        forces: null,
        series: [],
    });
    const [low, high] = boxOf(film);
    assert.ok(low.z < 0 && low.z > -1.5 && high.z > 21);
});
