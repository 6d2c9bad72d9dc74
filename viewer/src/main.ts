/** Starts the page: reads its recording and plays it, or says in one line why not. */
import { element } from "./controls.ts";
import { unpack } from "./unpack.ts";
import { Viewer } from "./viewer.ts";

async function main(): Promise<void> {
    const film = await unpack(element("recording").textContent ?? "");
    element("title").textContent = film.title;
    element("notes").replaceChildren(
        ...film.notes.map((note) => {
            const line = document.createElement("li");
            line.textContent = note;
            return line;
        }),
    );
    new Viewer(film);
}

main()
    .catch((error: unknown) => {
        const line = document.createElement("p");
        line.className = "failed";
        line.setAttribute("role", "alert");
        line.textContent = error instanceof Error ? error.message : String(error);
        element("viewer").replaceChildren(line);
    })
    .finally(() => element("viewer").setAttribute("aria-busy", "false"));
