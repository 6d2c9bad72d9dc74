/** How much of each body is to be seen: blocks taken away fade out, and in again on the way back. */

/** Seconds from there to gone. */
const DURATION = 0.3;

export class Fade {
    private readonly shown: Float32Array;
    private readonly instant: () => boolean;

    /** `instant` says whether the watcher wants no motion that is not part of the recording. */
    constructor(bodies: number, instant: () => boolean) {
        this.shown = new Float32Array(bodies).fill(-1);
        this.instant = instant;
    }

    /** From 0 (gone) to 1 (there). */
    of(body: number): number {
        return this.shown[body];
    }

    /** Lets time pass towards what is `there`; true while something is still on its way. */
    advance(seconds: number, there: (body: number) => boolean): boolean {
        let moving = false;
        const step = this.instant() ? 1 : seconds / DURATION;
        for (let body = 0; body < this.shown.length; body++) {
            const [now, goal] = [this.shown[body], there(body) ? 1 : 0];
            if (now === goal) continue;
            const gap = goal - now;
            this.shown[body] =
                now < 0 || Math.abs(gap) <= step ? goal : now + Math.sign(gap) * step;
            moving ||= this.shown[body] !== goal;
        }
        return moving;
    }
}
