import assert from "node:assert/strict";
import { test } from "node:test";
import { Fade } from "../src/fade.ts";

test("bodies begin as they are, fade out, and are gone", () => {
    const fade = new Fade(2, () => false);
    assert.equal(
        fade.advance(0, () => true),
        false,
    );
    assert.equal(fade.of(0), 1);
    assert.equal(
        fade.advance(0.1, (body) => body === 0),
        true,
    );
    assert.ok(fade.of(1) > 0.5 && fade.of(1) < 1);
    assert.equal(
        fade.advance(1, (body) => body === 0),
        false,
    );
    assert.equal(fade.of(1), 0);
});

test("with reduced motion nothing fades", () => {
    const fade = new Fade(1, () => true);
    fade.advance(0, () => true);
    assert.equal(
        fade.advance(0.001, () => false),
        false,
    );
    assert.equal(fade.of(0), 0);
});
