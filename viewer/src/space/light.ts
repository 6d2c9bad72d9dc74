/** Light from above one shoulder, with soft shadows, and a floor that catches them. */
import {
    CircleGeometry,
    DirectionalLight,
    Group,
    HemisphereLight,
    Mesh,
    ShadowMaterial,
    Vector3,
} from "three";
import type { Around } from "./view.ts";

const SHADOW_PIXELS = 2048;

export class Light {
    readonly group = new Group();

    constructor({ low, high, up, east, north, turn }: Around, floor: number) {
        const middle = low.clone().add(high).multiplyScalar(0.5);
        const radius = 0.5 * high.distanceTo(low) || 1;
        const sky = new HemisphereLight("#ffffff", "#b9b4ab", 1.9);
        sky.position.copy(up);
        this.group.add(sky);
        // To the left of the first eye, and high.
        const side = new Vector3()
            .addScaledVector(east, Math.cos(turn - 0.75))
            .addScaledVector(north, Math.sin(turn - 0.75));
        this.group.add(...sun(middle, side.addScaledVector(up, 1.5).normalize(), radius));
        const ground = new Mesh(new CircleGeometry(8 * radius, 48), new ShadowMaterial());
        ground.material.opacity = 0.16;
        ground.receiveShadow = true;
        ground.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), up);
        ground.position.copy(middle).addScaledVector(up, floor - middle.dot(up) - 0.002 * radius);
        this.group.add(ground);
    }
}

/** A light far away whose shadows cover a ball, and what it points at. */
function sun(middle: Vector3, towards: Vector3, radius: number) {
    const light = new DirectionalLight("#fff8ee", 2);
    light.position.copy(middle).addScaledVector(towards, 4 * radius);
    light.target.position.copy(middle);
    light.castShadow = true;
    light.shadow.mapSize.set(SHADOW_PIXELS, SHADOW_PIXELS);
    light.shadow.radius = 4;
    light.shadow.normalBias = 0.004 * radius;
    const { camera } = light.shadow;
    // Twice as wide, so that what is drawn apart has shadows too.
    camera.left = camera.bottom = -2 * radius;
    camera.right = camera.top = 2 * radius;
    [camera.near, camera.far] = [radius, 8 * radius];
    return [light, light.target] as const;
}
