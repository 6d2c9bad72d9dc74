/** Numbers for people. */

/** Four figures, no more. */
export function figures(value: number, digits = 4): string {
    if (!Number.isFinite(value)) return "–";
    return value.toLocaleString("en", { maximumSignificantDigits: digits, useGrouping: true });
}

/** A value of a chart: seconds as s, ms or µs. */
export function measure(value: number, unit: string): string {
    if (unit !== "s" || !Number.isFinite(value)) {
        return unit ? `${figures(value, 3)} ${unit}` : figures(value, 3);
    }
    const size = Math.abs(value);
    if (size === 0) return "0 s";
    if (size >= 1) return `${figures(value, 3)} s`;
    return size >= 1e-3 ? `${figures(1e3 * value, 3)} ms` : `${figures(1e6 * value, 3)} µs`;
}

export function counted(number: number, thing: string): string {
    return `${number.toLocaleString("en")} ${thing}${number === 1 ? "" : "s"}`;
}
