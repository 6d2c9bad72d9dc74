import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { facts } from "../../src/describe.ts";
import type { palette } from "../../src/palette.ts";
import { Colours, orderColour } from "../../src/space/colours.ts";
import { unpack } from "../../src/unpack.ts";
import { filmOf, packed } from "../fixture.ts";
import { cubes, cubesFilm } from "./fixture.ts";

test("forces in space have three numbers", async () => {
    const film = await cubesFilm();
    assert.deepEqual(film.forces(0), [{ a: 0, b: 1, x: 0.5, y: 0.25, z: 0, fx: 1, fy: 2, fz: 2 }]);
    assert.deepEqual([...film.magnitudes()], [3]);
    assert.equal(film.mostForces(), 1);
    assert.equal(film.typicalSize, 1);
});

test("what Python writes of a plan in space is read", async () => {
    const film = await unpack(readFileSync(new URL("plan.json", import.meta.url), "utf8"));
    assert.equal(film.dimension, 3);
    assert.equal(film.bodies[1].pieces?.[0].faces.length, 6);
    assert.equal([...film.pose(0, 1)].length, 7);
    const weight = 9.81 * film.bodies[1].mass;
    const lifted = film.forces(0)?.filter(({ b }) => b === film.bodies.length - 1) ?? [];
    const sum = lifted.reduce((total, { fz }) => total + fz, 0);
    assert.ok(lifted.length > 0 && Math.abs(sum / weight - 1) < 1e-5);
});

test("a card in space says kilograms a cubic metre, and how far a body is turned", async () => {
    const film = await filmOf(tumbling());
    const rows = Object.fromEntries(facts(film, 1, 2));
    assert.equal(rows.mass, "2 kg (2 kg/m³)");
    assert.equal(rows["centre of mass"], "0, 2, 1 m");
    assert.equal(rows.turn, "90°");
});

test("loads go with bodies that turn in space", async () => {
    const loads = [{ body: 2, at: [0, 0, 2], force: [1, 0, -8] }];
    const [before, after] = [0, 1].map(async (frame) =>
        (await filmOf({ ...tumbling(), loads })).loadsOf(frame),
    );
    assert.deepEqual(await before, loads);
    // From (0, 0, 1.5) to (0, 2, 1), and a quarter turn about x, which takes z to -y.
    const [load] = await after;
    const [x, y, z] = load.at;
    assert.ok(Math.hypot(x, y - 1.5, z - 1) < 1e-6, `${load.at}`);
    assert.deepEqual(load.force, [1, 0, -8]);
});

test("the first taken away is yellow, the last violet", async () => {
    assert.equal(orderColour(0, 5).getHexString(), "fde725");
    assert.equal(orderColour(4, 5).getHexString(), "440154");
    const colours = new Colours(await cubesFilm());
    assert.deepEqual(colours.places, [-1, 1, 0]);
    const page = new Proxy({}, { get: () => "#123456" }) as ReturnType<typeof palette>;
    assert.equal(colours.of(0, 2, page).getHexString(), "123456");
    colours.byOrder = true;
    assert.equal(colours.of(0, 2, page).getHexString(), "fde725");
    assert.equal(colours.of(0, 0, page).getHexString(), "123456", "what is fixed has no place");
});

/** "top" falls and is turned a quarter about x. */
function tumbling() {
    const plan = cubes();
    const [still, turned] = [
        [1, 0, 0, 0],
        [Math.SQRT1_2, Math.SQRT1_2, 0, 0],
    ];
    const first = [0, 0, -0.5, ...still, 0, 0, 0.5, ...still, 0, 0, 1.5, ...still];
    const then = [0, 0, -0.5, ...still, 0, 0, 0.5, ...still, 0, 2, 1, ...turned];
    return {
        ...plan,
        kind: "run" as const,
        frames: {
            ...plan.frames,
            count: 2,
            times: packed(Float64Array.of(0, 0.2)),
            poses: packed(Float32Array.of(...first, ...then), [2, 3, 7]),
            states: packed(Uint8Array.of(1, 2, 2, 1, 2, 1), [2, 3]),
            captions: [],
        },
        forces: null,
        series: [],
    };
}
