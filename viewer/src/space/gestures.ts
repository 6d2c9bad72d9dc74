/** Mouse, pen and fingers on the picture: orbit, pan, zoom, cards. */
import type { PointerWishes } from "../stage.ts";
import type { Orbit } from "./orbit.ts";

/** Pixels a press may slide and still be a click. */
const SLIP = 4;
/** Zoom of a pixel of the wheel, radians of a pixel of dragging. */
const [WHEEL, TURN] = [0.002, 0.008];

type Spot = { x: number; y: number };

export function bindGestures(canvas: HTMLCanvasElement, orbit: Orbit, wishes: PointerWishes): void {
    const down = new Map<number, Spot>();
    let slid = 0;
    let panning = false;
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => {
        down.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
        canvas.setPointerCapture(event.pointerId);
        panning = event.button !== 0 || event.shiftKey;
        if (down.size === 1) slid = 0;
    });
    canvas.addEventListener("pointermove", (event) => {
        const now = { x: event.offsetX, y: event.offsetY };
        const before = down.get(event.pointerId);
        if (!before) {
            wishes.hover([now.x, now.y]);
            return;
        }
        slid += Math.hypot(now.x - before.x, now.y - before.y);
        const other = [...down].find(([id]) => id !== event.pointerId)?.[1];
        if (slid < SLIP && !other) return;
        if (other) pinch(orbit, before, now, other, canvas.clientHeight);
        else drag(orbit, before, now, panning, canvas.clientHeight);
        down.set(event.pointerId, now);
        wishes.moved();
    });
    canvas.addEventListener("pointerup", (event) => {
        if (down.size === 1 && slid < SLIP) wishes.click([event.offsetX, event.offsetY]);
        down.delete(event.pointerId);
    });
    canvas.addEventListener("pointercancel", (event) => down.delete(event.pointerId));
    canvas.addEventListener("pointerleave", () => wishes.hover(null));
    canvas.addEventListener("wheel", (event) => turnWheel(event, canvas, orbit, wishes), {
        passive: false,
    });
}

function drag(orbit: Orbit, from: Spot, to: Spot, panning: boolean, height: number): void {
    const [dx, dy] = [to.x - from.x, to.y - from.y];
    if (panning) orbit.pan(dx / height, -dy / height);
    else orbit.rotate(-TURN * dx, TURN * dy);
}

/** Two fingers: their distance zooms, their middle moves the picture. */
function pinch(orbit: Orbit, from: Spot, to: Spot, other: Spot, height: number): void {
    const apart = (spot: Spot) => Math.max(Math.hypot(spot.x - other.x, spot.y - other.y), 1);
    orbit.zoom(apart(to) / apart(from));
    orbit.pan((to.x - from.x) / 2 / height, -(to.y - from.y) / 2 / height);
}

function turnWheel(
    event: WheelEvent,
    canvas: HTMLCanvasElement,
    orbit: Orbit,
    wishes: PointerWishes,
): void {
    // Else it scrolls the page, or the notebook around it.
    if (!event.ctrlKey && document.activeElement !== canvas) return;
    event.preventDefault();
    orbit.zoom(Math.exp(-WHEEL * event.deltaY));
    wishes.moved();
}
