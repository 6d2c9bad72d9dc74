/** Buttons, sliders and keys: what the watcher asks for, and the state of the things to ask with. */
import type { Timeline } from "./timeline.ts";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8, 16];
const MANY = 10;

/** What can be asked for besides time. */
export interface Wishes {
    toggleForces(): void;
    toggleNames(): void;
    /** Force arrows so many times as long. */
    stretch(factor: number): void;
    zoom(factor: number): void;
    showAll(): void;
    /** The card of the block `by` further on in the list of blocks. */
    select(by: number): void;
    deselect(): void;
    /** Keys beside those below. */
    keys: Record<string, () => void>;
}

export function element<T extends HTMLElement>(id: string): T {
    const found = document.getElementById(id);
    if (!found) throw new Error(`This page has no element ${id}.`);
    return found as T;
}

export class Controls {
    private readonly timeline: Timeline;
    private readonly scrub = element<HTMLInputElement>("scrub");
    private readonly play = element<HTMLButtonElement>("play");
    private readonly backward = [element("first"), element("back")] as HTMLButtonElement[];
    private readonly forward = [element("forward"), element("last")] as HTMLButtonElement[];

    constructor(timeline: Timeline, wishes: Wishes) {
        this.timeline = timeline;
        this.scrub.max = String(timeline.last);
        this.play.disabled = this.scrub.disabled = timeline.last === 0;
        this.bindButtons(wishes);
        this.bindSpeed();
        document.addEventListener("keydown", (event) => {
            const wish = this.keys(wishes)[event.key] ?? this.keys(wishes)[event.key.toLowerCase()];
            if (!wish || event.ctrlKey || event.metaKey || event.altKey) return;
            if (ownsKey(event)) return;
            event.preventDefault();
            wish(event.shiftKey ? MANY : 1);
        });
    }

    /** Shows where the timeline is; `text` says it to those who do not see the slider. */
    update(text: string): void {
        const { frame, last, playing } = this.timeline;
        this.scrub.value = String(frame);
        this.scrub.setAttribute("aria-valuetext", text);
        for (const button of this.backward) button.disabled = frame === 0;
        for (const button of this.forward) button.disabled = frame === last;
        this.play.setAttribute("aria-label", playing ? "Pause" : "Play");
        this.play.classList.toggle("playing", playing);
    }

    private bindButtons(wishes: Wishes): void {
        const { timeline } = this;
        const on = (id: string, wish: () => void) => element(id).addEventListener("click", wish);
        on("first", () => timeline.step(-Infinity));
        on("back", () => timeline.step(-1));
        on("play", () => timeline.toggle());
        on("forward", () => timeline.step(1));
        on("last", () => timeline.step(Infinity));
        on("forces", () => wishes.toggleForces());
        on("names", () => wishes.toggleNames());
        this.scrub.addEventListener("input", () => {
            timeline.pause();
            timeline.seek(this.scrub.valueAsNumber);
        });
        const length = element<HTMLInputElement>("length");
        length.addEventListener("input", () => wishes.stretch(2 ** length.valueAsNumber));
    }

    private bindSpeed(): void {
        const select = element<HTMLSelectElement>("speed");
        for (const speed of SPEEDS) {
            select.add(new Option(`${speed}×`, String(speed), speed === 1, speed === 1));
        }
        select.addEventListener("change", () => {
            this.timeline.speed = Number(select.value);
        });
    }

    private keys(wishes: Wishes): Record<string, (steps: number) => void> {
        const { timeline } = this;
        return {
            " ": () => timeline.toggle(),
            ArrowLeft: (steps) => timeline.step(-steps),
            ArrowRight: (steps) => timeline.step(steps),
            Home: () => timeline.step(-Infinity),
            End: () => timeline.step(Infinity),
            f: () => wishes.toggleForces(),
            n: () => wishes.toggleNames(),
            "[": () => wishes.select(-1),
            "]": () => wishes.select(1),
            Escape: () => wishes.deselect(),
            "+": () => wishes.zoom(1.25),
            "=": () => wishes.zoom(1.25),
            "-": () => wishes.zoom(0.8),
            "0": () => wishes.showAll(),
            ...wishes.keys,
        };
    }
}

/** Whether the key means something else where it was struck: space on a button, arrows on a slider. */
function ownsKey({ key, target }: KeyboardEvent): boolean {
    if (target instanceof HTMLButtonElement || (target as Element).tagName === "SUMMARY") {
        return key === " ";
    }
    if (target instanceof HTMLSelectElement) return key !== "Escape";
    const moves = ["ArrowLeft", "ArrowRight", "Home", "End"].includes(key);
    return target instanceof HTMLInputElement && moves && target.id !== "scrub";
}
