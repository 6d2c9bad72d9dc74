/** One series under the picture: a strip with a cursor at the frame shown, on which one can seek. */
import { type Axis, axisOf, largestIn } from "./bins.ts";
import { measure } from "./format.ts";
import type { Palette } from "./palette.ts";
import { Surface } from "./surface.ts";

export interface Series {
    name: string;
    unit: string;
    values: Float32Array;
}

const TOP = 3;

export class Chart {
    readonly element: HTMLElement;
    private readonly series: Series;
    private readonly axis: Axis;
    private readonly surface: Surface;
    private readonly value: HTMLElement;
    private readonly seek: (frame: number) => void;
    /** The strip without its cursor. */
    private drawn: ImageData | null = null;

    constructor(series: Series, seek: (frame: number) => void) {
        this.series = series;
        this.axis = axisOf(series.values);
        this.seek = seek;
        this.element = document.createElement("figure");
        const caption = document.createElement("figcaption");
        const name = document.createElement("span");
        name.textContent = series.name;
        this.value = document.createElement("strong");
        const top = document.createElement("span");
        top.className = "top";
        top.textContent = `max ${measure(this.axis.top, series.unit)}${this.axis.log ? ", log scale" : ""}`;
        caption.append(name, this.value, top);
        const canvas = document.createElement("canvas");
        canvas.setAttribute("aria-hidden", "true");
        this.element.append(caption, canvas);
        this.surface = new Surface(canvas);
        canvas.addEventListener("pointerdown", (event) => {
            canvas.setPointerCapture(event.pointerId);
            this.seek(this.frameAt(event));
        });
        canvas.addEventListener("pointermove", (event) => {
            if (canvas.hasPointerCapture(event.pointerId)) this.seek(this.frameAt(event));
            canvas.title = this.label(this.frameAt(event));
        });
    }

    draw(frame: number, colours: Palette, renew: boolean): void {
        this.value.textContent = measure(this.series.values[frame], this.series.unit);
        if (this.surface.resize() || renew || !this.drawn) this.drawn = this.strip(colours);
        const { context, width, height } = this.surface;
        if (!this.drawn || width === 0) return;
        context.putImageData(this.drawn, 0, 0);
        const n = Math.max(this.series.values.length, 1);
        const x = ((frame + 0.5) / n) * width;
        context.fillStyle = colours.ink;
        context.fillRect(Math.min(Math.max(x - 0.75, 0), width - 1.5), 0, 1.5, height);
    }

    private strip(colours: Palette): ImageData | null {
        const { context, width, height, canvas } = this.surface;
        if (width === 0 || height === 0) return null;
        this.surface.clear(colours.page);
        const values = this.series.values;
        const columns = Math.max(1, Math.min(values.length, Math.floor(width)));
        const bins = largestIn(values, columns);
        const wide = width / columns;
        const gap = wide > 4 ? 1 : 0;
        context.fillStyle = colours.series;
        bins.forEach((value, k) => {
            if (!(value > 0)) return;
            const tall = Math.max(this.axis.height(value) * (height - TOP - 1), 1);
            context.fillRect(k * wide, height - 1 - tall, wide - gap, tall);
        });
        context.fillStyle = colours.line;
        context.fillRect(0, height - 1, width, 1);
        return context.getImageData(0, 0, canvas.width, canvas.height);
    }

    private frameAt(event: PointerEvent): number {
        const { left, width } = this.surface.canvas.getBoundingClientRect();
        const n = this.series.values.length;
        const frame = Math.floor(((event.clientX - left) / width) * n);
        return Math.min(Math.max(frame, 0), Math.max(n - 1, 0));
    }

    private label(frame: number): string {
        return `${frame}: ${measure(this.series.values[frame], this.series.unit)}`;
    }
}
