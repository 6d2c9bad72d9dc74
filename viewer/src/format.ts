/** Numbers for people. */

/** Four figures, no more. */
export function figures(value: number, digits = 4): string {
    if (!Number.isFinite(value)) return "–";
    return value.toLocaleString("en", { maximumSignificantDigits: digits, useGrouping: true });
}

const PREFIXES = ["n", "µ", "m", "", "k", "M", "G", "T"];
const NONE = PREFIXES.indexOf("");

/** A quantity: newtons and seconds with the prefix that leaves one to three digits, 81.5 kN, 13 µs. */
export function measure(value: number, unit: string): string {
    if (!["N", "s"].includes(unit) || !Number.isFinite(value) || value === 0) {
        return unit ? `${figures(value, 3)} ${unit}` : figures(value, 3);
    }
    // Three digits: 999.96 is 1000 as it will be written.
    const size = Number(Math.abs(value).toPrecision(3));
    const power = Math.floor(Math.log10(size) / 3 + 1e-12);
    const last = unit === "s" ? 0 : PREFIXES.length - 1 - NONE;
    const shown = Math.min(Math.max(power, -NONE), last);
    return `${figures(value / 1000 ** shown, 3)} ${PREFIXES[shown + NONE]}${unit}`;
}

export function counted(number: number, thing: string): string {
    return `${number.toLocaleString("en")} ${thing}${number === 1 ? "" : "s"}`;
}
