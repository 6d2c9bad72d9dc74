/** Starts a page: reads its recording and plays it, or says in one line why not. */
import { element } from "./controls.ts";
import type { Film } from "./film.ts";
import type { Stage } from "./stage.ts";
import { unpack } from "./unpack.ts";
import { Viewer } from "./viewer.ts";

/** `stage` makes the picture of a film on the page's canvas. */
export async function start(
    stage: (film: Film, canvas: HTMLCanvasElement) => Stage,
): Promise<void> {
    try {
        await play(stage);
    } catch (error) {
        const line = document.createElement("p");
        line.className = "failed";
        line.setAttribute("role", "alert");
        line.textContent = error instanceof Error ? error.message : String(error);
        element("viewer").replaceChildren(line);
    }
    element("viewer").setAttribute("aria-busy", "false");
}

async function play(stage: (film: Film, canvas: HTMLCanvasElement) => Stage): Promise<void> {
    const film = await unpack(element("recording").textContent ?? "");
    element("title").textContent = film.title;
    element("notes").replaceChildren(...film.notes.map(line));
    element("details").replaceChildren(...film.details.map(line));
    element("work").hidden = film.details.length + film.series.length === 0;
    new Viewer(film, stage(film, element<HTMLCanvasElement>("scene")));
}

function line(text: string): HTMLLIElement {
    const made = document.createElement("li");
    made.textContent = text;
    return made;
}
