import assert from "node:assert/strict";
import { test } from "node:test";
import { Vector3 } from "three";
import { normalOf } from "../../src/space/faces.ts";
import { edgesOf, facesOf } from "../../src/space/solid.ts";
import { boxPiece, solid, surfacePiece } from "./fixture.ts";

const lines = (ends: number[]) => ends.length / 6;

test("a box has twelve edges and twelve triangles, with normals outward", () => {
    const box = solid("box", [0, 0, 0], [boxPiece([1, 2, 3])]);
    assert.equal(lines(edgesOf(box)), 12);
    const faces = facesOf(box);
    assert.equal(faces.getAttribute("position").count, 3 * 12);
    const [positions, normals] = [faces.getAttribute("position"), faces.getAttribute("normal")];
    for (let i = 0; i < positions.count; i++) {
        const corner = new Vector3().fromBufferAttribute(positions, i);
        assert.ok(corner.dot(new Vector3().fromBufferAttribute(normals, i)) > 0.4);
    }
});

test("a surface has edges where it turns, none across its faces", () => {
    const box = solid("box", [0, 0, 0], [surfacePiece([boxPiece([1, 2, 3])])]);
    assert.equal(lines(edgesOf(box)), 12);
});

test("no edge where two pieces go on in one plane", () => {
    const pieces = [boxPiece([1, 1, 1], [0, 0, -0.5]), boxPiece([1, 1, 1], [0, 0, 0.5])];
    // Eight at the two ends, and four uprights in two parts each.
    assert.equal(lines(edgesOf(solid("tall", [0, 0, 0], pieces))), 16);
});

test("an edge ends where another piece goes on in its plane", () => {
    // An L, its foot twice as long as its post.
    const pieces = [boxPiece([2, 1, 1], [0, 0, 0]), boxPiece([1, 1, 1], [-0.5, 0, 1])];
    const ends = edgesOf(solid("L", [0, 0, 0], pieces));
    const total = Array.from({ length: lines(ends) }, (_, i) =>
        new Vector3(...ends.slice(6 * i, 6 * i + 3)).distanceTo(
            new Vector3(...ends.slice(6 * i + 3, 6 * i + 6)),
        ),
    ).reduce((sum, length) => sum + length, 0);
    // Twice the outline of 8, and six edges across of 1.
    assert.ok(Math.abs(total - 22) < 1e-3, `${total}`);
});

test("the normal of a face does not hang on its first corners", () => {
    const vertices: [number, number, number][] = [
        [0, 0, 5],
        [1, 0, 5],
        [2, 0, 5],
        [2, 2, 5],
    ];
    const normal = normalOf({ vertices, faces: [], surface: false }, [0, 1, 2, 3]);
    assert.ok(normal.distanceTo(new Vector3(0, 0, 1)) < 1e-12);
});
