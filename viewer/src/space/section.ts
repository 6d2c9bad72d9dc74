/** A plane that cuts the picture open, and the faces it lays bare. */
import {
    BufferGeometry,
    Float32BufferAttribute,
    Group,
    Mesh,
    MeshLambertMaterial,
    Plane,
    type Vector2,
    Vector3,
} from "three";
import { State } from "../contract.ts";
import type { Film } from "../film.ts";
import type { Look } from "../stage.ts";
import type { Colours } from "./colours.ts";
import type { Explode } from "./explode.ts";
import { cut } from "./hull.ts";
import { linesOf, replace } from "./lines.ts";

export const AXES = ["off", "x", "y", "z"] as const;
export type Axis = (typeof AXES)[number];

export class Section {
    axis: Axis = "off";
    /** From 0 to 1 through the picture, along the axis. */
    position = 0.5;
    /** Which side is kept: 1 what lies before the plane on its axis, -1 what lies behind. */
    side: 1 | -1 = 1;
    readonly group = new Group();
    private readonly film: Film;
    private readonly explode: Explode;
    private readonly colours: Colours;
    private readonly caps: Mesh<BufferGeometry, MeshLambertMaterial>[];
    private readonly outlines = linesOf([]);

    constructor(film: Film, explode: Explode, colours: Colours) {
        this.film = film;
        this.explode = explode;
        this.colours = colours;
        this.caps = film.bodies.map(() => {
            const material = new MeshLambertMaterial({
                polygonOffset: true,
                polygonOffsetFactor: 1,
                polygonOffsetUnits: 1,
            });
            const cap = new Mesh(new BufferGeometry(), material);
            this.group.add(cap);
            return cap;
        });
        this.group.add(this.outlines);
    }

    /** The plane within a box that reaches from `low` to `high`; its normal points to what is kept. */
    plane(low: Vector3, high: Vector3): Plane | null {
        if (this.axis === "off") return null;
        const { axis, position, side } = this;
        const normal = new Vector3();
        normal[axis] = -side;
        return new Plane(normal, side * (low[axis] + position * (high[axis] - low[axis])));
    }

    /** Keeps what is farther from the eye, which looks along `ahead`. */
    openTowards(ahead: Vector3): void {
        if (this.axis !== "off") this.side = ahead[this.axis] < 0 ? 1 : -1;
    }

    draw(look: Look, plane: Plane | null, size: Vector2, width: number): void {
        const ends: number[] = [];
        this.caps.forEach((cap, body) => {
            cap.visible = plane !== null && this.film.state(look.frame, body) !== State.absent;
            if (!plane || !cap.visible) return;
            const polygons = this.cut(look.frame, body, plane);
            cap.geometry.dispose();
            cap.geometry = filled(polygons, plane.normal.clone().negate());
            ends.push(...polygons.flatMap(outline));
            // A little darker than a face, as on a drawing.
            cap.material.color.copy(this.colours.of(look.frame, body, look.colours));
            cap.material.color.multiplyScalar(0.85);
        });
        this.outlines.visible = plane !== null;
        replace(this.outlines, ends);
        this.outlines.material.resolution.copy(size);
        this.outlines.material.linewidth = 1.3 * width;
        this.outlines.material.color.set(look.colours.ink);
    }

    private cut(frame: number, body: number, plane: Plane): Vector3[][] {
        const matrix = this.explode.placed(frame, body);
        const pieces = this.film.bodies[body].pieces ?? [];
        // A surface is seen into: what of it lies in the plane is not filled.
        const convex = pieces.filter(({ surface }) => !surface);
        return convex.map((piece) => cut(piece, matrix, plane));
    }
}

/** Polygons that are counter-clockwise seen against `normal`, as triangles that face along it. */
function filled(polygons: Vector3[][], normal: Vector3): BufferGeometry {
    const positions: number[] = [];
    for (const corners of polygons) {
        for (let i = 2; i < corners.length; i++) {
            for (const corner of [corners[0], corners[i], corners[i - 1]]) {
                positions.push(...corner.toArray());
            }
        }
    }
    const normals = Array.from({ length: positions.length / 3 }, () => normal.toArray()).flat();
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
    geometry.setAttribute("normal", new Float32BufferAttribute(normals, 3));
    return geometry;
}

/** The ends of a polygon's sides. */
function outline(corners: Vector3[]): number[] {
    return corners.flatMap((corner, i) => [
        ...corner.toArray(),
        ...corners[(i + 1) % corners.length].toArray(),
    ]);
}
