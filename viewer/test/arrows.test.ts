import assert from "node:assert/strict";
import { test } from "node:test";
import { carrying, forceScale, roundBelow } from "../src/arrows.ts";
import { filmOf, planRecording, runRecording } from "./fixture.ts";

test("forces are drawn as they act on the body that is carried", () => {
    const force = { a: 0, b: 1, x: 0, y: 0, z: 0, fx: 1, fy: -2, fz: 0 };
    assert.deepEqual(carrying(force, [0, -9.81]), [-1, 2]);
    assert.deepEqual(carrying({ ...force, fy: 2 }, [0, -9.81]), [1, 2]);
});

test("large forces are about as long as a block", async () => {
    const film = await filmOf(planRecording());
    assert.equal(film.typicalSize, 1);
    assert.ok(Math.abs(40 * forceScale(film) - 1.1) < 1e-6);
    assert.equal(forceScale(await filmOf(runRecording())), 0, "no forces, no scale");
});

test("the key has a round number", () => {
    const cases = [
        [9.9, 5],
        [10, 10],
        [0.23, 0.2],
        [4999, 2000],
    ];
    for (const [value, round] of cases) assert.ok(Math.abs(roundBelow(value) - round) < 1e-9);
});
