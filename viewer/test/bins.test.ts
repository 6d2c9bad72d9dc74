import assert from "node:assert/strict";
import { test } from "node:test";
import { axisOf, largestIn } from "../src/bins.ts";

test("a column shows the largest of its values, and no value is lost", () => {
    assert.deepEqual([...largestIn(Float32Array.of(1, 5, 2, 3), 2)], [5, 3]);
    assert.deepEqual([...largestIn(Float32Array.of(7, 8), 4)], [7, 7, 8, 8]);
    const spike = new Float32Array(10007);
    spike[5003] = 9;
    assert.equal(Math.max(...largestIn(spike, 600)), 9);
});

test("no value is no bar", () => {
    assert.deepEqual([...largestIn(Float32Array.of(Number.NaN, 1), 2)], [Number.NaN, 1]);
});

test("the axis is linear, unless few values dwarf the others", () => {
    const even = axisOf(Float32Array.of(1, 2, 3, 4));
    assert.deepEqual([even.log, even.height(2), even.height(4)], [false, 0.5, 1]);
    const values = new Float32Array(200).fill(2);
    values[7] = 500;
    const steep = axisOf(values);
    assert.ok(steep.log && steep.height(500) === 1);
    assert.ok(steep.height(2) > 0.1 && steep.height(0) === 0);
});

test("an empty series has an axis", () => {
    assert.equal(axisOf(new Float32Array()).top, 1);
});
