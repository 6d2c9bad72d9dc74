import assert from "node:assert/strict";
import { test } from "node:test";
import { bodyAt, inside } from "../src/picking.ts";
import { filmOf, planRecording, runRecording } from "./fixture.ts";

test("points in and out of a convex polygon", () => {
    const triangle = [0, 0, 2, 0, 0, 2];
    assert.ok(inside(triangle, 0.5, 0.5));
    assert.ok(!inside(triangle, 1.5, 1.5));
    assert.ok(!inside([], 0, 0));
});

test("bodies are found where they are, also where one was", async () => {
    const film = await filmOf(planRecording());
    assert.equal(bodyAt(film, 0, 0.2, 1.7), 2);
    assert.equal(bodyAt(film, 1, 0.2, 1.7), 2, "its outline is still there");
    assert.equal(bodyAt(film, 0, 0.2, -0.3), 0);
    assert.equal(bodyAt(film, 0, 5, 5), -1);
});

test("a moving body is found where it has moved to", async () => {
    const film = await filmOf(runRecording());
    assert.equal(bodyAt(film, 1, 2, 1), 2);
    assert.equal(bodyAt(film, 1, 0, 1.5), -1);
});
