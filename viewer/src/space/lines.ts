/** Lines some pixels wide: WebGL's own are one pixel. */
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

export type Lines = LineSegments2 & { material: LineMaterial };

/** `ends` are x, y, z of the ends, two a line. */
export function linesOf(ends: ArrayLike<number>): Lines {
    const lines = new LineSegments2(geometryOf(ends), new LineMaterial({ linewidth: 1 }));
    lines.matrixAutoUpdate = false;
    return lines as Lines;
}

/** Other lines in the place of those before. */
export function replace(lines: Lines, ends: ArrayLike<number>): void {
    lines.geometry.dispose();
    lines.geometry = geometryOf(ends);
}

function geometryOf(ends: ArrayLike<number>): LineSegmentsGeometry {
    const geometry = new LineSegmentsGeometry();
    // No line at all is one that has no length.
    geometry.setPositions(Float32Array.from(ends.length > 0 ? ends : [0, 0, 0, 0, 0, 0]));
    return geometry;
}
