/** What the page says in words: about a frame, and about a body in it. */
import { State } from "./contract.ts";
import type { Film } from "./film.ts";
import { counted, figures, measure } from "./format.ts";

/** "Step 3 of 84", "1.25 s · step 300 of 1,200", "40%" of a motion that is enlarged; nothing where there is but one. */
export function place(film: Film, frame: number): string {
    if (film.count <= 1) return "";
    if (film.kind === "motion") return `${Math.round((100 * frame) / (film.count - 1))}%`;
    const step = film.step(frame).toLocaleString("en");
    const of = `${step} of ${film.step(Math.max(film.count - 1, 0)).toLocaleString("en")}`;
    if (!film.times) return `Step ${of}`;
    return `${film.times[frame].toFixed(3)} s · step ${of}`;
}

/** The recording's caption, or for a run how much of it is motionless. */
export function caption(film: Film, frame: number): string {
    const said = film.caption(frame);
    if (said || film.kind !== "run" || film.count === 0) return said;
    const movable = film.bodies.filter(({ fixed }) => !fixed).length;
    return `${tally(film, frame, State.motionless)} of ${counted(movable, "block")} motionless`;
}

/** Whose forces are shown, where they are not the frame's own. */
export function forcesShown(film: Film, frame: number): string {
    const shown = film.forcesFrame(frame);
    if (shown === frame) return "";
    if (shown >= 0) return ` (Forces: those of step ${film.step(shown)}.)`;
    return film.holds(frame) ? " (No forces are shown: blocks are held.)" : " (Forces: none.)";
}

function tally(film: Film, frame: number, state: State): number {
    const is = (fixed: boolean, body: number) => !fixed && film.state(frame, body) === state;
    return film.bodies.filter(({ fixed }, body) => is(fixed, body)).length;
}

/** Rows of the card about a body. */
export function facts(film: Film, frame: number, body: number): [string, string][] {
    const { fixed, mass, density, friction } = film.bodies[body];
    const rows: [string, string][] = [["state", stateOf(film, frame, body)]];
    if (film.held(frame, body)) rows.push(["held", "by a hand or a scaffold, under any load"]);
    const power = film.dimension === 3 ? "³" : "²";
    if (!fixed) rows.push(["mass", `${figures(mass)} kg (${figures(density)} kg/m${power})`]);
    rows.push(["friction", figures(friction)]);
    if (film.kind === "run" && film.state(frame, body) !== State.absent) {
        const pose = [...film.pose(frame, body)];
        const at = pose.slice(0, film.dimension).map((value) => figures(value));
        rows.push(["centre of mass", `${at.join(", ")} m`]);
        rows.push(["turn", `${figures((turn(pose) * 180) / Math.PI, 3)}°`]);
    }
    const forces = film.forces(frame)?.filter(({ a, b }) => a === body || b === body) ?? [];
    if (forces.length > 0) {
        const largest = Math.max(...forces.map(({ fx, fy, fz }) => Math.hypot(fx, fy, fz)));
        rows.push([
            "pushed by",
            `${counted(forces.length, "force")}, up to ${measure(largest, "N")}`,
        ]);
    }
    return rows;
}

/** How far a body is turned, radians; in space about whichever axis that is. */
function turn(pose: number[]): number {
    if (pose.length === 3) return pose[2];
    const [w, ...axis] = pose.slice(3);
    return 2 * Math.atan2(Math.hypot(...axis), Math.abs(w));
}

function stateOf(film: Film, frame: number, body: number): string {
    if (film.bodies[body].fixed) return "fixed";
    const removed = film.kind === "plan" ? film.removedIn(body) : -1;
    const when = removed >= 0 ? film.step(removed) : 0;
    switch (film.state(frame, body)) {
        case State.absent:
            return when ? `taken away in step ${when}` : "not there";
        case State.next:
            return "next to be taken away";
        case State.falling:
            return "falls";
        case State.motionless:
            return "motionless";
        default:
            if (film.kind === "run") return "moving";
            return when ? `stands; taken away in step ${when}` : "stands";
    }
}
