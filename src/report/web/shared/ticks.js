// Ticks of axes: where they are, and how they are written.

/// Round numbers at even steps from about `low` to about `high`.
export function even_ticks(low, high, given_step = null) {
    const least_step = Math.max((high - low) / 8, Math.abs(high) * 1e-3, 1e-30);
    const power = 10 ** Math.floor(Math.log10(least_step));
    const round_step = [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= least_step);
    const step = given_step ?? round_step;
    const first = Math.floor(low / step);
    return Array.from({ length: Math.ceil(high / step) - first + 1 }, (_, i) => (first + i) * step);
}

/// Ticks of a logarithmic axis from `low` to `high`: powers of two; or round numbers, evenly spaced within half a
/// decade, at some of 1, 2, 3, 5, 7 times powers of ten beyond.
export function log_ticks(low, high, binary) {
    const ticks = [];
    const decades = Math.log10(high / low);
    if (binary) {
        for (let tick = 2 ** Math.floor(Math.log2(low)); tick < high * 2; tick *= 2) ticks.push(tick);
    } else if (decades < 0.5) {
        ticks.push(...even_ticks(low, high));
    } else {
        const factors = decades > 3 ? [1] : decades > 1.5 ? [1, 3] : [1, 2, 3, 5, 7];
        for (let power = Math.floor(Math.log10(low)); 10 ** power <= high; ++power)
            ticks.push(...factors.map((factor) => factor * 10 ** power));
    }
    return ticks;
}

/// Three digits, as a plain number.
export const plain_tick = (value) => String(Number(value.toPrecision(3))).replace("-", "−");

/// Three digits times a power of ten.
export function power_tick(value) {
    const [digits, power] = Number(value.toPrecision(3)).toExponential().split("e");
    if (Number(power) === 0) return digits;
    if (Number(power) === 1) return String(digits * 10);
    const raised = Array.from(String(Number(power)), (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c])).join("");
    return `${digits === "1" ? "" : `${digits}·`}10${raised}`;
}
