/** The key to the colours: only those that occur. */
import { State } from "./contract.ts";
import type { Film } from "./film.ts";

export function drawLegend(list: HTMLElement, film: Film): void {
    const states = new Set<number>();
    for (let frame = 0; frame < film.count; frame++) {
        film.bodies.forEach(({ fixed }, body) => {
            if (!fixed) states.add(film.state(frame, body));
        });
    }
    const run = film.kind === "run";
    const never = film.bodies.some((_, body) => film.state(0, body) === State.absent);
    const words: [State, string, string][] = [
        [State.present, "present", run ? "moves" : "stands"],
        [State.motionless, "motionless", "motionless"],
        [State.next, "next", "next to be taken away"],
        [State.falling, "falling", "falls"],
        [State.absent, "absent", never ? "not there" : "taken away"],
    ];
    const shown = words.filter(([state]) => states.has(state) && (!run || state !== State.absent));
    const items = shown.map(([, kind, text]) => item(kind, text));
    if (film.holds()) items.push(item("held", "held"));
    if (film.loads.length > 0) items.push(item("load", "load"));
    if (film.bodies.some(({ fixed }) => fixed)) items.push(item("fixed", "fixed"));
    list.replaceChildren(...items);
}

function item(kind: string, text: string): HTMLElement {
    const [line, swatch] = [document.createElement("li"), document.createElement("span")];
    swatch.className = `swatch ${kind}`;
    line.append(swatch, text);
    return line;
}
