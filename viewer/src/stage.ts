/** What the viewer asks of a picture, in the plane as in space. */
import type { Fade } from "./fade.ts";
import type { Palette } from "./palette.ts";

/** What is to be seen. */
export interface Look {
    frame: number;
    fade: Fade;
    colours: Palette;
    names: boolean;
    forces: boolean;
    /** Force arrows so many times as long. */
    stretch: number;
    /** The body under the pointer, or -1. */
    marked: number;
}

export interface PointerWishes {
    /** The pointer rests here (pixels), or has left. */
    hover(at: [number, number] | null): void;
    click(at: [number, number]): void;
    /** The camera has moved, or something else of the picture: it has to be drawn again. */
    moved(): void;
}

export interface Stage {
    readonly canvas: HTMLCanvasElement;
    /** Keys beside those that every page has. */
    readonly keys: Record<string, () => void>;
    bind(wishes: PointerWishes): void;
    draw(look: Look): void;
    /** The body at a pixel, -1 for none. */
    bodyAt(frame: number, at: [number, number]): number;
    /** The pixel a body's card is put beside. */
    placeOf(frame: number, body: number): [number, number];
    zoom(factor: number): void;
    showAll(): void;
}
