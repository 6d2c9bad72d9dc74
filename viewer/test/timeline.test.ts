import assert from "node:assert/strict";
import { test } from "node:test";
import { planTimes, Timeline } from "../src/timeline.ts";

const TIMES = [0, 0.1, 0.2, 0.3];

test("seeking stays within the ends", () => {
    const line = new Timeline(TIMES);
    line.seek(2);
    assert.equal(line.frame, 2);
    line.seek(99);
    assert.equal(line.frame, 3);
    line.step(-Infinity);
    assert.equal(line.frame, 0);
});

test("playing follows the recorded times, whatever the intervals", () => {
    const line = new Timeline(TIMES);
    line.play();
    line.advance(0.05);
    assert.equal(line.frame, 0);
    line.advance(0.16);
    assert.equal(line.frame, 2);
    line.advance(10);
    assert.equal(line.frame, 3);
    assert.equal(line.playing, false, "stops at the end");
    line.play();
    assert.deepEqual([line.frame, line.playing], [0, true], "and begins again");
});

test("speed is a factor", () => {
    const line = new Timeline(TIMES);
    line.speed = 0.5;
    line.play();
    line.advance(0.21);
    assert.equal(line.frame, 1);
});

test("a step stops, and nothing moves while stopped", () => {
    const line = new Timeline(TIMES);
    line.play();
    line.step(1);
    assert.deepEqual([line.frame, line.playing], [1, false]);
    line.advance(1);
    assert.equal(line.frame, 1);
});

test("seeking while playing goes on from there", () => {
    const line = new Timeline(TIMES);
    line.play();
    line.seek(2);
    line.advance(0.05);
    assert.equal(line.frame, 2);
    line.advance(0.06);
    assert.equal(line.frame, 3);
});

test("changes are told", () => {
    let told = 0;
    const line = new Timeline(TIMES, () => told++);
    line.seek(1);
    line.play();
    assert.equal(told, 2);
    line.advance(0.01);
    assert.equal(told, 2, "the same frame");
    line.advance(0.1);
    assert.equal(told, 3);
});

test("one frame cannot be played", () => {
    const line = new Timeline([0]);
    line.play();
    assert.equal(line.playing, false);
});

test("plans of any length play in about a minute at most", () => {
    assert.equal(planTimes(3)[2], 1.6);
    assert.ok(Math.abs(planTimes(1000)[999] - 60) < 0.1);
});
