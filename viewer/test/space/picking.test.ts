import assert from "node:assert/strict";
import { test } from "node:test";
import { Matrix4, Plane, Ray, Vector3 } from "three";
import { Explode } from "../../src/space/explode.ts";
import { cut, halvesOf, within } from "../../src/space/hull.ts";
import { Picking } from "../../src/space/picking.ts";
import { Triangles } from "../../src/space/triangles.ts";
import { aroundOf, boxOf } from "../../src/space/view.ts";
import { boxPiece, cubesFilm, surfacePiece } from "./fixture.ts";

const ray = (from: number[], way: number[]) =>
    new Ray(new Vector3(...from), new Vector3(...way).normalize());

async function picking() {
    const film = await cubesFilm();
    const explode = new Explode(film, aroundOf(film, ...boxOf(film)));
    return { film, explode, picking: new Picking(film, explode) };
}

test("a line enters and leaves a box where it should, or misses it", () => {
    const halves = halvesOf(boxPiece([2, 2, 2]));
    assert.deepEqual(within(ray([-5, 0, 0], [1, 0, 0]), halves), [4, 6]);
    assert.equal(within(ray([-5, 3, 0], [1, 0, 0]), halves), null);
});

test("the first body on the way is found, of those that are there", async () => {
    const { picking: picks } = await picking();
    const down = ray([0.2, 0.1, 9], [0, 0, -1]);
    assert.equal(picks.bodyAt(0, down, null), 2);
    assert.equal(picks.bodyAt(1, down, null), 1, "what was taken away is not in the way");
    assert.equal(picks.bodyAt(2, down, null), 0);
    assert.equal(picks.bodyAt(0, ray([0, 0, 9], [0, 0, 1]), null), -1, "not behind the eye");
    const past = ray([-9, 0, 1.5], [1, 0, 0]);
    assert.equal(picks.bodyAt(1, past, null), 2, "nothing else is there: the outline of what was");
});

test("what the section takes away is not found", async () => {
    const { picking: picks } = await picking();
    const along = ray([-9, 0, 1.5], [1, 0, 0]);
    assert.equal(picks.bodyAt(0, along, new Plane(new Vector3(1, 0, 0), 0)), 2, "half is left");
    assert.equal(picks.bodyAt(0, along, new Plane(new Vector3(0, 0, -1), 0.9)), -1);
});

test("bodies drawn apart are found where they are drawn", async () => {
    const { picking: picks, explode } = await picking();
    const along = ray([-9, 0, 1.5], [1, 0, 0]);
    assert.equal(picks.bodyAt(0, along, null), 2);
    explode.factor = 1;
    assert.equal(explode.of(0).length(), 0, "the ground stays");
    const gap = explode.of(2).z - explode.of(1).z;
    assert.ok(Math.abs(gap - 1) < 1e-6, "twice as far from each other");
    assert.equal(picks.bodyAt(0, along, null), 1, "low has gone up to where top was");
});

test("a surface is met where its triangles are, not in its hull", () => {
    const two = new Triangles(surfacePiece([boxPiece([1, 1, 1]), boxPiece([1, 1, 1], [3, 0, 0])]));
    assert.equal(two.distance(ray([0, 0, 9], [0, 0, -1]), []), 8.5);
    assert.equal(two.distance(ray([1.5, 0.1, 9], [0, 0, -1]), []), Infinity, "between the boxes");
    const kept = [{ normal: new Vector3(0, 0, 1), offset: 0 }];
    assert.equal(two.distance(ray([0.1, 0, 9], [0, 0, -1]), kept), 9.5, "its floor, cut open");
    assert.equal(two.distance(ray([0, 9, 9], [0, 0, -1]), []), Infinity);
});

test("a plane cuts a turned box in a polygon of the right area", () => {
    const turned = new Matrix4().makeRotationZ(Math.PI / 4).setPosition(3, 0, 0);
    const corners = cut(boxPiece([2, 2, 1]), turned, new Plane(new Vector3(1, 0, 0), -3));
    assert.equal(corners.length, 4, "through two opposite edges of it");
    const area = new Vector3();
    corners.forEach((corner, i) => {
        area.add(corner.clone().cross(corners[(i + 1) % corners.length]));
    });
    assert.ok(Math.abs(area.length() / 2 - 2 * Math.SQRT2) < 1e-9);
    assert.ok(area.x > 0, "counter-clockwise about the plane's normal");
    assert.deepEqual(cut(boxPiece([2, 2, 1]), turned, new Plane(new Vector3(1, 0, 0), 9)), []);
});
