import assert from "node:assert/strict";
import { test } from "node:test";
import { measure } from "../src/format.ts";

test("quantities have units that people read", () => {
    assert.equal(measure(81_500, "N"), "81.5 kN");
    assert.equal(measure(1e6, "N"), "1 MN");
    assert.equal(measure(999.96, "N"), "1 kN");
    assert.equal(measure(0.886, "N"), "886 mN");
    assert.equal(measure(0, "N"), "0 N");
    assert.equal(measure(1.3e-5, "s"), "13 µs");
    assert.equal(measure(4000, "s"), "4,000 s");
    assert.equal(measure(1234, ""), "1,230");
    assert.equal(measure(Number.NaN, "s"), "– s");
});
