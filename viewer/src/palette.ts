/** The page's colours, as the style sheet has them for light or dark. */

const NAMES = [
    "page",
    "ink",
    "faint",
    "line",
    "ground",
    "hatch",
    "stone",
    "still",
    "next",
    "falling",
    "fall",
    "force",
    "load",
    "held",
    "still-name",
    "mark-name",
    "series",
] as const;

export type Palette = Record<(typeof NAMES)[number], string>;

export function palette(element: Element): Palette {
    const style = getComputedStyle(element);
    const colour = (name: string) => style.getPropertyValue(`--${name}`).trim();
    return Object.fromEntries(NAMES.map((name) => [name, colour(name)])) as Palette;
}
