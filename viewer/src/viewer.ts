/** Puts the parts together: one film, one picture, its charts and controls. */
import { Card } from "./card.ts";
import { Chart } from "./chart.ts";
import { State } from "./contract.ts";
import { Controls, element } from "./controls.ts";
import { caption, facts, forcesShown, place } from "./describe.ts";
import { Fade } from "./fade.ts";
import type { Film } from "./film.ts";
import { drawLegend } from "./legend.ts";
import { type Palette, palette } from "./palette.ts";
import type { Stage } from "./stage.ts";
import { planTimes, Timeline } from "./timeline.ts";

export class Viewer {
    private readonly film: Film;
    private readonly timeline: Timeline;
    private readonly stage: Stage;
    private readonly card = new Card(element("card"));
    private readonly charts: Chart[];
    private readonly controls: Controls;
    private readonly fade: Fade;
    private colours: Palette;
    private showsForces: boolean;
    private showsNames = true;
    private stretch = 1;
    private pointer: [number, number] | null = null;
    /** The body whose card is kept, or -1. */
    private selected = -1;
    /** When the last picture was drawn, ms; NaN while nothing moves. */
    private before = Number.NaN;
    private requested = false;
    private renewCharts = false;

    constructor(film: Film, stage: Stage) {
        this.film = film;
        this.stage = stage;
        this.timeline = new Timeline(film.times ?? planTimes(film.count), () => this.request());
        this.charts = film.series.map((series) => new Chart(series, (frame) => this.goTo(frame)));
        element("charts").append(...this.charts.map((chart) => chart.element));
        const calm = matchMedia("(prefers-reduced-motion: reduce)");
        this.fade = new Fade(film.bodies.length, () => calm.matches);
        this.showsForces = film.hasForces;
        this.colours = palette(document.documentElement);
        this.controls = new Controls(this.timeline, {
            toggleForces: () => this.setForces(!this.showsForces),
            toggleNames: () => this.setNames(!this.showsNames),
            stretch: (factor) => this.change(() => (this.stretch = factor)),
            zoom: (factor) => this.change(() => stage.zoom(factor)),
            showAll: () => this.change(() => stage.showAll()),
            select: (by) => this.select(by),
            deselect: () => this.change(() => (this.selected = -1)),
            keys: stage.keys,
        });
        drawLegend(element("legend"), film);
        this.setForces(this.showsForces);
        this.bind();
        this.request();
    }

    private bind(): void {
        this.stage.bind({
            hover: (at) => this.change(() => (this.pointer = at)),
            click: (at) => this.change(() => (this.selected = this.bodyAt(at))),
            moved: () => this.request(),
        });
        element("work").addEventListener("toggle", () => this.request());
        new ResizeObserver(() => this.request()).observe(this.stage.canvas);
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () =>
            this.change(() => {
                this.colours = palette(document.documentElement);
                this.renewCharts = true;
            }),
        );
    }

    private change(how: () => void): void {
        how();
        this.request();
    }

    private request(): void {
        if (this.requested) return;
        this.requested = true;
        requestAnimationFrame((now) => this.tick(now));
    }

    /** One picture; asks for the next one as long as something moves. */
    private tick(now: number): void {
        this.requested = false;
        const { film, timeline } = this;
        const seconds = Number.isNaN(this.before) ? 0 : Math.min((now - this.before) / 1000, 0.25);
        timeline.advance(seconds);
        const there = (body: number) => film.state(timeline.frame, body) !== State.absent;
        const fading = this.fade.advance(seconds, there);
        this.draw();
        const moving = timeline.playing || fading;
        this.before = moving ? now : Number.NaN;
        if (moving) this.request();
    }

    private draw(): void {
        const { stage, fade, colours } = this;
        const { frame } = this.timeline;
        const marked = this.pointer ? this.bodyAt(this.pointer) : this.selected;
        const [names, forces] = [this.showsNames, this.showsForces];
        stage.draw({ frame, fade, colours, names, forces, stretch: this.stretch, marked });
        this.showCard(frame, marked);
        this.say(frame);
        for (const chart of this.charts) chart.draw(frame, colours, this.renewCharts);
        this.renewCharts = false;
    }

    private showCard(frame: number, body: number): void {
        if (body < 0) {
            this.card.hide();
            return;
        }
        const at = this.pointer ?? this.stage.placeOf(frame, body);
        this.card.show(this.film.bodies[body].name, facts(this.film, frame, body), ...at);
    }

    private say(frame: number): void {
        const { film, timeline } = this;
        const where = place(film, frame);
        const what = caption(film, frame) + (this.showsForces ? forcesShown(film, frame) : "");
        element("place").textContent = where;
        const said = element("caption");
        // Read aloud where the watcher stops, not sixty times a second.
        said.setAttribute("aria-live", timeline.playing ? "off" : "polite");
        if (said.textContent !== what) said.textContent = what;
        this.controls.update([where, what].filter(Boolean).join(". "));
    }

    private goTo(frame: number): void {
        this.timeline.pause();
        this.timeline.seek(frame);
    }

    private bodyAt(at: [number, number]): number {
        return this.stage.bodyAt(this.timeline.frame, at);
    }

    private select(by: number): void {
        const n = this.film.bodies.length;
        if (n === 0) return;
        this.pointer = null;
        this.selected = this.selected < 0 ? (by > 0 ? 0 : n - 1) : (this.selected + by + n) % n;
        this.request();
    }

    private setForces(on: boolean): void {
        this.showsForces = on && this.film.hasForces;
        const button = element<HTMLButtonElement>("forces");
        button.disabled = !this.film.hasForces;
        button.setAttribute("aria-pressed", String(this.showsForces));
        element("length-label").hidden = !this.showsForces;
        this.request();
    }

    private setNames(on: boolean): void {
        this.showsNames = on;
        element("names").setAttribute("aria-pressed", String(on));
        this.request();
    }
}
