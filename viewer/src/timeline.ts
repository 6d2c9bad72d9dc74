/** Which frame is shown, and how it moves on: no drawing, no clock of its own. */

/** Seconds that a plan of many steps takes at speed 1. */
const PLAN_SECONDS = 60;
/** Seconds a step of a plan is shown at speed 1, at most. */
const SLOWEST_STEP = 0.8;

export class Timeline {
    readonly count: number;
    speed = 1;
    private readonly times: ArrayLike<number>;
    private readonly changed: () => void;
    private shown = 0;
    private clock: number;
    private running = false;

    /** `times` (ascending, s) says when each frame is due; `changed` is called after every change. */
    constructor(times: ArrayLike<number>, changed: () => void = () => {}) {
        this.times = times;
        this.count = times.length;
        this.clock = this.count > 0 ? times[0] : 0;
        this.changed = changed;
    }

    get frame(): number {
        return this.shown;
    }

    get playing(): boolean {
        return this.running;
    }

    get last(): number {
        return Math.max(this.count - 1, 0);
    }

    /** Shows a frame; numbers beyond the ends are the ends. */
    seek(frame: number): void {
        this.shown = Math.min(Math.max(Math.round(frame), 0), this.last);
        this.clock = this.times[this.shown] ?? 0;
        this.changed();
    }

    /** Goes `frames` on (or back), and stops there. */
    step(frames: number): void {
        this.running = false;
        this.seek(this.shown + frames);
    }

    /** Plays, from the start if the end is shown. */
    play(): void {
        if (this.shown === this.last) this.seek(0);
        this.running = this.last > 0;
        this.changed();
    }

    pause(): void {
        this.running = false;
        this.changed();
    }

    toggle(): void {
        if (this.running) this.pause();
        else this.play();
    }

    /** Lets `seconds` of the watcher's time pass; stops at the last frame. */
    advance(seconds: number): void {
        if (!this.running) return;
        this.clock += seconds * this.speed;
        const before = this.shown;
        while (this.shown < this.last && this.times[this.shown + 1] <= this.clock) this.shown++;
        if (this.shown === this.last) this.running = false;
        if (this.shown !== before) this.changed();
    }
}

/** When the steps of a plan, which has no clock, are shown. */
export function planTimes(count: number): Float64Array {
    const pace = Math.min(SLOWEST_STEP, PLAN_SECONDS / Math.max(count, 1));
    return Float64Array.from({ length: count }, (_, frame) => pace * frame);
}
