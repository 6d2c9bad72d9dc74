/** What is drawn on, and of what. */
import type { Camera } from "./camera.ts";
import type { Film } from "./film.ts";

export interface Scene {
    context: CanvasRenderingContext2D;
    film: Film;
    frame: number;
    camera: Camera;
}
