/** Contact forces and loads as arrows in space: plain where they are seen, faint where blocks hide them. */
import {
    ConeGeometry,
    CylinderGeometry,
    DynamicDrawUsage,
    GreaterDepth,
    Group,
    InstancedMesh,
    LessEqualDepth,
    Matrix4,
    MeshBasicMaterial,
    type Plane,
    Quaternion,
    Vector3,
} from "three";
import { State } from "../contract.ts";
import type { Film, Force } from "../film.ts";
import type { Look } from "../stage.ts";
import type { Explode } from "./explode.ts";

/** Of what is behind blocks. */
const FAINT = 0.38;
/** Shaft and head in typical block sizes, and how much of an arrow its head is at most. */
const [SHAFT, HEAD, SHARE] = [0.012, 0.11, 0.45];
const UP = new Vector3(0, 1, 0);

type Layers = { shafts: InstancedMesh; heads: InstancedMesh }[];

/** From a point in the world, m, along a force, N. */
interface Arrow {
    tail: Vector3;
    way: Vector3;
}

export class Arrows {
    readonly group = new Group();
    private readonly film: Film;
    private readonly explode: Explode;
    /** Metres a newton. */
    private readonly metres: number;
    private readonly forces: Layers;
    private readonly loads: Layers;

    constructor(film: Film, explode: Explode, metres: number) {
        this.film = film;
        this.explode = explode;
        this.metres = metres;
        this.forces = this.layersOf(film.mostForces());
        this.loads = this.layersOf(film.loads.length);
    }

    private layersOf(most: number): Layers {
        return [LessEqualDepth, GreaterDepth].map((depthFunc) => {
            const hidden = depthFunc === GreaterDepth;
            const material = new MeshBasicMaterial({
                depthFunc,
                depthWrite: !hidden,
                transparent: hidden,
                opacity: hidden ? FAINT : 1,
            });
            const shafts = new InstancedMesh(new CylinderGeometry(1, 1, 1, 8), material, most);
            const heads = new InstancedMesh(new ConeGeometry(1, 1, 14), material, most);
            for (const mesh of [shafts, heads]) {
                mesh.instanceMatrix.setUsage(DynamicDrawUsage);
                mesh.frustumCulled = false;
                mesh.renderOrder = hidden ? 2 : 1;
            }
            this.group.add(shafts, heads);
            return { shafts, heads };
        });
    }

    draw(look: Look, planes: Plane[]): void {
        const { film, explode } = this;
        const there = (body: number) => film.state(look.frame, body) !== State.absent;
        const known = look.forces ? (film.forces(film.forcesFrame(look.frame)) ?? []) : [];
        const forces = known.filter(({ a, b }) => there(a) && there(b)).map(this.carrying);
        const loads = film.loadsOf(look.frame).map(({ body, at, force }) => ({
            tail: vector(at).add(explode.of(body)),
            way: vector(force),
        }));
        this.show(this.forces, forces, look, look.colours.force, planes);
        this.show(this.loads, loads, look, look.colours.load, planes);
    }

    /** A contact force as it acts on the body that is carried: against gravity. */
    private readonly carrying = (force: Force): Arrow => {
        const way = new Vector3(force.fx, force.fy, force.fz);
        const lifted = way.dot(vector(this.film.gravity)) <= 0;
        if (!lifted) way.negate();
        const tail = new Vector3(force.x, force.y, force.z);
        return { tail: tail.add(this.explode.of(lifted ? force.b : force.a)), way };
    };

    private show(
        layers: Layers,
        arrows: Arrow[],
        look: Look,
        colour: string,
        planes: Plane[],
    ): void {
        for (const { shafts, heads } of layers) {
            shafts.count = heads.count = arrows.length;
            const material = shafts.material as MeshBasicMaterial;
            material.color.set(colour);
            material.clippingPlanes = planes;
        }
        for (const [i, arrow] of arrows.entries()) this.place(layers, i, arrow, look.stretch);
        for (const { shafts, heads } of layers) {
            shafts.instanceMatrix.needsUpdate = heads.instanceMatrix.needsUpdate = true;
        }
    }

    private place(layers: Layers, index: number, { tail, way }: Arrow, stretch: number): void {
        const { film } = this;
        const length = way.length() * this.metres * stretch;
        const head = Math.min(HEAD * film.typicalSize, SHARE * length);
        const wide = Math.min(SHAFT * film.typicalSize, 0.12 * length);
        const turned = new Quaternion().setFromUnitVectors(UP, way.normalize());
        const part = (from: number, to: number, radius: number) =>
            new Matrix4().compose(
                tail.clone().addScaledVector(way, (from + to) / 2),
                turned,
                new Vector3(radius, Math.max(to - from, 1e-12), radius),
            );
        for (const { shafts, heads } of layers) {
            shafts.setMatrixAt(index, part(0, length - head, wide));
            heads.setMatrixAt(index, part(length - head, length, 0.36 * head));
        }
    }
}

function vector([x, y, z]: number[]): Vector3 {
    return new Vector3(x, y, z);
}
