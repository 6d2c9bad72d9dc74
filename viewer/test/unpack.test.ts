import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { State } from "../src/contract.ts";
import { lastUpTo } from "../src/film.ts";
import { array, unpack } from "../src/unpack.ts";
import { filmOf, packed, planRecording, runRecording } from "./fixture.ts";

test("states, forces and captions of a plan arrive", async () => {
    const film = await filmOf(planRecording());
    assert.equal(film.count, 3);
    assert.equal(film.state(0, 2), State.next);
    assert.equal(film.state(1, 2), State.absent);
    assert.deepEqual(film.forces(0)?.[1], {
        ...{ a: 2, b: 1, x: 0.25, y: 1, z: 0 },
        ...{ fx: 3, fy: -4, fz: 0 },
    });
    assert.equal(film.forces(1), null, "not kept");
    assert.equal(film.forcesFrame(1), 0, "but those of the frame before are");
    assert.deepEqual(film.forces(2), [], "none there");
    assert.deepEqual([...film.magnitudes()], [40, 5]);
    assert.deepEqual(
        [0, 1, 2].map((frame) => film.caption(frame)),
        ["Next: top.", "Next: top.", "Nothing left."],
    );
    assert.deepEqual(
        [0, 1, 2].map((body) => film.removedIn(body)),
        [-1, 2, 1],
    );
});

test("poses of a run move and turn corners", async () => {
    const film = await filmOf(runRecording());
    assert.equal(film.step(1), 2);
    assert.equal(film.times?.[1], 0.2);
    const corners = film.corners(1, 2);
    // The lower left corner of a square turned a quarter is the lower right one of the picture.
    assert.ok(Math.hypot(corners[0] - 2.5, corners[1] - 0.5) < 1e-6);
});

test("what Python writes is read", async () => {
    const text = readFileSync(new URL("plan.json", import.meta.url), "utf8");
    const film = await unpack(text);
    assert.equal(film.title, "Order found for 5 blocks");
    assert.equal(film.count, 6);
    assert.equal(film.bodies.length, 6);
    assert.ok(film.magnitudes().length > 10);
    assert.equal(film.series[0].values[1], 2);
});

test("another version, another format and damage are refused in words", async () => {
    const plan = planRecording();
    const bad = (change: object) => unpack(JSON.stringify({ ...plan, ...change }));
    await assert.rejects(bad({ version: 1 }), /version 1; this page reads version 2/);
    await assert.rejects(bad({ format: "other" }), /no recording/);
    const short = { ...plan.frames, states: packed(new Uint8Array(8), [3, 3]) };
    await assert.rejects(bad({ frames: short }), /cut short/);
    await assert.rejects(
        array(packed(new Uint8Array(3)), "f32"),
        /u8 \(3\) where f32 \(3\) is due/,
    );
});

test("positions in ascending numbers", () => {
    const numbers = Uint32Array.of(1, 3, 7);
    assert.deepEqual(
        [0, 1, 2, 3, 7, 8].map((value) => lastUpTo(numbers, value)),
        [-1, 0, 0, 1, 2, 2],
    );
    assert.equal(lastUpTo(new Uint32Array(), 0), -1);
});

test("loads go with their bodies, and leave with them", async () => {
    const loads = [{ body: 2, at: [0.5, 2], force: [0, -8] }];
    const plan = await filmOf({ ...planRecording(), loads });
    assert.deepEqual(plan.loadsOf(0), loads);
    assert.deepEqual(plan.loadsOf(1), [], "its body is taken away");
    assert.deepEqual([...plan.magnitudes()], [40, 5, 8], "arrows have one scale");
    // From (0, 1.5) to (2, 1), and a quarter turn; the force keeps its direction.
    const [load] = (await filmOf({ ...runRecording(), loads })).loadsOf(1);
    for (const x of load.at) assert.ok(Math.abs(x - 1.5) < 1e-6, `${load.at}`);
    assert.deepEqual(load.force, [0, -8]);
});
