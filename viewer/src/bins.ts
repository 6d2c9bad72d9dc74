/** Series for a chart: one value a pixel column, and an axis that shows small values beside large. */

/** The largest value of each of `columns` equal parts; NaN where there is none. */
export function largestIn(values: Float32Array, columns: number): Float32Array {
    const bins = new Float32Array(columns).fill(Number.NaN);
    const n = values.length;
    for (let i = 0; i < n; i++) {
        const first = Math.floor((i * columns) / n);
        const end = Math.max(first + 1, Math.ceil(((i + 1) * columns) / n));
        for (let bin = first; bin < Math.min(end, columns); bin++) {
            if (!(bins[bin] >= values[i])) bins[bin] = values[i];
        }
    }
    return bins;
}

export interface Axis {
    top: number;
    log: boolean;
    /** Height of a value, from 0 to 1. */
    height(value: number): number;
}

/** How many times the usual a value may be before the axis turns logarithmic. */
const SPREAD = 8;

/** Linear from zero; logarithmic if a few values (an impact, the first solve) dwarf the others. */
export function axisOf(values: Float32Array): Axis {
    const sorted = values.filter((value) => value > 0).sort();
    const top = sorted.at(-1) ?? 1;
    const usual = sorted[Math.floor(0.9 * (sorted.length - 1))] ?? 1;
    const log = top > SPREAD * usual;
    const small = (sorted[Math.floor(0.1 * (sorted.length - 1))] ?? 1) / 2;
    const height = log
        ? (value: number) => Math.log1p(value / small) / Math.log1p(top / small)
        : (value: number) => value / top;
    return { top, log, height };
}
