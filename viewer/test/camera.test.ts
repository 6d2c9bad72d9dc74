import assert from "node:assert/strict";
import { test } from "node:test";
import { Camera, viewOf } from "../src/camera.ts";
import { filmOf, packed, planRecording, runRecording } from "./fixture.ts";

test("the box fits the window, the right way up", () => {
    const camera = new Camera();
    camera.fit([0, 0, 4, 2], 100, 100);
    assert.equal(camera.scale, 25);
    assert.deepEqual([camera.screenX(0), camera.screenX(4)], [0, 100]);
    assert.deepEqual([camera.screenY(0), camera.screenY(2)], [75, 25]);
    assert.deepEqual(camera.world(100, 25), [4, 2]);
});

test("zooming keeps the point under the pointer, and never shows less than everything", () => {
    const camera = new Camera();
    camera.fit([0, 0, 4, 2], 100, 100);
    const before = camera.world(30, 60);
    camera.zoom(3, 30, 60);
    assert.ok(camera.zoomed);
    const after = camera.world(30, 60);
    assert.ok(Math.hypot(after[0] - before[0], after[1] - before[1]) < 1e-12);
    camera.zoom(1e-6, 50, 50);
    assert.ok(!camera.zoomed);
});

test("the view holds the movable bodies and a strip of the ground", async () => {
    const [left, bottom, right, top] = viewOf(await filmOf(planRecording()));
    assert.ok(left < -0.5 && right > 0.5 && top > 2);
    assert.ok(bottom < 0 && bottom > -1);
});

test("a body that flies away does not take the view with it", async () => {
    const run = runRecording();
    const poses = new Float32Array(18);
    poses.set([0, -0.5, 0, 0, 0.5, 0, 0, 1.5, 0, 0, -0.5, 0, 0, 0.5, 0, 1e4, 1, 0]);
    run.frames.poses = packed(poses, [2, 3, 3]);
    const [, , right] = viewOf(await filmOf(run));
    assert.ok(right > 1 && right < 4);
});

test("what falls from high up is seen to land", async () => {
    const run = runRecording();
    const [ground, far] = [
        [0, -0.5, 0],
        [0, 20, 0],
    ];
    const first = [...ground, ...far, ...[0, 21, 0]];
    const then = [...ground, ...[0, 0.5, 0], ...[0, 1.5, 0]];
    run.frames.poses = packed(Float32Array.of(...first, ...then), [2, 3, 3]);
    const [, bottom, , top] = viewOf(await filmOf(run));
    assert.ok(bottom < 0 && bottom > -5 && top > 21);
});
