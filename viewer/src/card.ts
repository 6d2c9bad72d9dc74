/** The card about a body, beside the pointer. */

export class Card {
    private readonly element: HTMLElement;

    constructor(element: HTMLElement) {
        this.element = element;
    }

    show(name: string, rows: [string, string][], x: number, y: number): void {
        const title = document.createElement("strong");
        title.textContent = name;
        const list = document.createElement("dl");
        for (const [what, value] of rows) {
            const [term, text] = [document.createElement("dt"), document.createElement("dd")];
            term.textContent = what;
            text.textContent = value;
            list.append(term, text);
        }
        this.element.replaceChildren(title, list);
        this.element.hidden = false;
        this.place(x, y);
    }

    hide(): void {
        this.element.hidden = true;
    }

    /** Beside a point of the picture, and within it. */
    private place(x: number, y: number): void {
        const { offsetWidth: w, offsetHeight: h } = this.element;
        const frame = this.element.parentElement;
        const [W, H] = [frame?.clientWidth ?? 0, frame?.clientHeight ?? 0];
        const left = x + 16 + w <= W ? x + 16 : Math.max(x - 16 - w, 4);
        const top = Math.min(Math.max(y - h / 2, 4), Math.max(H - h - 4, 4));
        this.element.style.transform = `translate(${left}px, ${top}px)`;
    }
}
