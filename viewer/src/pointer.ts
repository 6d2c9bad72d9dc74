/** The pointer on the picture: cards, zoom, drag. */
import type { Camera } from "./camera.ts";
import type { PointerWishes } from "./stage.ts";

/** Pixels a press may slide and still be a click. */
const SLIP = 4;
/** Zoom of a pixel of the wheel. */
const WHEEL = 0.002;

export function bindPointer(
    canvas: HTMLCanvasElement,
    camera: Camera,
    wishes: PointerWishes,
): void {
    let pressed: [number, number] | null = null;
    let slid = 0;
    const at = (event: MouseEvent): [number, number] => [event.offsetX, event.offsetY];
    canvas.addEventListener("pointerdown", (event) => {
        pressed = at(event);
        slid = 0;
        if (camera.zoomed) canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
        const now = at(event);
        if (!pressed) {
            wishes.hover(now);
            return;
        }
        const [dx, dy] = [now[0] - pressed[0], now[1] - pressed[1]];
        slid += Math.hypot(dx, dy);
        if (!camera.zoomed || slid < SLIP) return;
        camera.pan(dx, dy);
        pressed = now;
        wishes.moved();
    });
    canvas.addEventListener("pointerup", (event) => {
        if (pressed && slid < SLIP) wishes.click(at(event));
        pressed = null;
    });
    canvas.addEventListener("pointercancel", () => {
        pressed = null;
    });
    canvas.addEventListener("pointerleave", () => wishes.hover(null));
    canvas.addEventListener(
        "wheel",
        (event) => {
            // Without ctrl the wheel scrolls the page, or the notebook around it.
            if (!event.ctrlKey) return;
            event.preventDefault();
            camera.zoom(Math.exp(-WHEEL * event.deltaY), ...at(event));
            wishes.moved();
        },
        { passive: false },
    );
}
