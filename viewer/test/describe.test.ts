import assert from "node:assert/strict";
import { test } from "node:test";
import { caption, facts, forcesShown, place } from "../src/describe.ts";
import { counted, figures, measure } from "../src/format.ts";
import { filmOf, packed, planRecording, runRecording } from "./fixture.ts";

test("a plan's card says when the block goes", async () => {
    const film = await filmOf(planRecording());
    const rows = Object.fromEntries(facts(film, 0, 1));
    assert.deepEqual(rows, {
        state: "stands; taken away in step 2",
        mass: "2 kg (2 kg/m²)",
        friction: "0.5",
        "pushed by": "2 forces, up to 40 N",
    });
    assert.equal(facts(film, 0, 2)[0][1], "next to be taken away");
    assert.equal(facts(film, 1, 2)[0][1], "taken away in step 1");
    assert.deepEqual(facts(film, 0, 0)[0], ["state", "fixed"]);
    assert.equal(place(film, 1), "Step 1 of 2");
});

test("what is held is said, and that it has no forces", async () => {
    const recording = planRecording();
    recording.frames.held = packed(Uint8Array.of(0, 0, 0, 0, 1, 0, 0, 0, 0), [3, 3]);
    const film = await filmOf(recording);
    assert.deepEqual(facts(film, 1, 1)[1], ["held", "by a hand or a scaffold, under any load"]);
    assert.notEqual(facts(film, 0, 1)[1][0], "held");
    assert.deepEqual(
        [0, 1, 2].map((frame) => film.holds(frame)),
        [false, true, false],
    );
    assert.ok(film.holds());
    assert.equal(film.forcesFrame(1), -1, "those of step 0 are of a structure that nobody holds");
    assert.equal(forcesShown(film, 1), " (No forces are shown: blocks are held.)");
    assert.equal(forcesShown(film, 0), "");
    assert.equal(forcesShown(await filmOf(planRecording()), 1), " (Forces: those of step 0.)");
});

test("a run's card says where the body is", async () => {
    const film = await filmOf(runRecording());
    const rows = Object.fromEntries(facts(film, 1, 2));
    assert.equal(rows.state, "moving");
    assert.equal(rows["centre of mass"], "2, 1 m");
    assert.equal(rows.turn, "90°");
    assert.equal(place(film, 1), "0.200 s · step 2 of 2");
    assert.equal(caption(film, 1), "1 of 2 blocks motionless");
});

test("of enlarged displacements it is said how far they have come", async () => {
    const film = await filmOf({ ...runRecording(), kind: "motion" });
    assert.equal(film.count, 2);
    assert.deepEqual([place(film, 0), place(film, 1)], ["0%", "100%"]);
    assert.equal(caption(film, 1), "");
    assert.equal(facts(film, 1, 2)[0][1], "stands");
});

test("numbers for people", () => {
    assert.equal(measure(3.2e-6, "s"), "3.2 µs");
    assert.equal(measure(0.0512, "s"), "51.2 ms");
    assert.equal(measure(0, "s"), "0 s");
    assert.equal(measure(1234, ""), "1,230");
    assert.equal(measure(Number.NaN, ""), "–");
    assert.equal(figures(0.123456), "0.1235");
    assert.equal(counted(1, "block"), "1 block");
});
