/** The controls that only space has: section, explode, colours by order. */
import { element } from "../controls.ts";
import { type Colours, orderColour } from "./colours.ts";
import type { Explode } from "./explode.ts";
import { AXES, type Axis, type Section } from "./section.ts";

/** Explode at the slider's end. */
const FARTHEST = 1.5;

export interface Parts {
    section: Section;
    explode: Explode;
    colours: Colours;
    /** Opens the section on the side of the eye. */
    open(): void;
}

export class Panel {
    private readonly parts: Parts;
    private readonly axis = element<HTMLSelectElement>("section");
    private readonly moved: () => void;

    constructor(parts: Parts, moved: () => void) {
        this.parts = parts;
        this.moved = moved;
        for (const axis of AXES) this.axis.add(new Option(axis, axis));
        this.axis.addEventListener("change", () => this.cut(this.axis.value as Axis));
        const { section, explode, colours } = parts;
        slider("depth", (value) => (section.position = value), moved);
        slider("explode", (value) => (explode.factor = FARTHEST * value), moved);
        const turn = element<HTMLButtonElement>("turn");
        turn.addEventListener("click", () => {
            section.side = section.side === 1 ? -1 : 1;
            moved();
        });
        const order = element<HTMLButtonElement>("order");
        order.disabled = colours.count < 2;
        order.addEventListener("click", () => this.toggleOrder());
        drawScale(element("scale"), colours.count);
        this.cut("off");
    }

    /** The next axis, and after the last none. */
    cutNext(): void {
        const { axis } = this.parts.section;
        this.cut(AXES[(AXES.indexOf(axis) + 1) % AXES.length]);
    }

    toggleOrder(): void {
        const { colours } = this.parts;
        colours.byOrder = !colours.byOrder && colours.count > 1;
        element("order").setAttribute("aria-pressed", String(colours.byOrder));
        element("scale").hidden = !colours.byOrder;
        this.moved();
    }

    private cut(axis: Axis): void {
        this.parts.section.axis = axis;
        this.parts.open();
        this.axis.value = axis;
        element("depth-label").hidden = element("turn").hidden = axis === "off";
        this.moved();
    }
}

function slider(id: string, set: (value: number) => void, moved: () => void): void {
    const input = element<HTMLInputElement>(id);
    input.addEventListener("input", () => {
        set(input.valueAsNumber);
        moved();
    });
}

/** The colours from the first taken away to the last, with their numbers. */
function drawScale(line: HTMLElement, count: number): void {
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [120, 12];
    canvas.setAttribute("aria-hidden", "true");
    const context = canvas.getContext("2d");
    for (let x = 0; context && x < canvas.width; x++) {
        context.fillStyle = `#${orderColour(x, canvas.width).getHexString()}`;
        context.fillRect(x, 0, 1, canvas.height);
    }
    line.replaceChildren("taken away first", canvas, `last (${count})`);
}
