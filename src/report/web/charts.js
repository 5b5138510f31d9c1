// How charts look: series, axes, cards; for the plots of all pages.
"use strict";

/// Colours that differ in hue and in lightness, on white and on black; with them, shapes.
const k_series_colours = [
    "#5b6be0",
    "#e08a2e",
    "#1f9e89",
    "#c8437f",
    "#8f9a2f",
    "#9a6bd8",
    "#3a9bd1",
    "#c05a3c",
    "#7b8194",
    "#c9a227",
];
const k_series_shapes = ["circle", "triangle", "rect", "rectRot", "cross", "star", "crossRot"];

const series_style = (i) => ({
    colour: k_series_colours[i % k_series_colours.length],
    shape: k_series_shapes[i % k_series_shapes.length],
});

const css_colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function plot_card(title, note, controls) {
    const canvas = element("canvas", { role: "img", "aria-label": title });
    const card = element(
        "figure.plot",
        element(
            "figcaption",
            element("h3", title),
            note ? element("p.muted", note) : null,
            controls.length ? element("div.plot-controls", ...controls) : null,
        ),
        element("div.plot-canvas", canvas),
    );
    return { card, canvas };
}

/// Round numbers at even steps from about `low` to about `high`.
function even_ticks(low, high, given_step = null) {
    const least_step = Math.max((high - low) / 8, Math.abs(high) * 1e-3, 1e-30);
    const power = 10 ** Math.floor(Math.log10(least_step));
    const round_step = [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= least_step);
    const step = given_step ?? round_step;
    const first = Math.floor(low / step);
    return Array.from({ length: Math.ceil(high / step) - first + 1 }, (_, i) => (first + i) * step);
}

/// Ticks of a logarithmic axis from `low` to `high`: powers of two; or round numbers, evenly spaced within half a
/// decade, at some of 1, 2, 3, 5, 7 times powers of ten beyond.
function log_ticks(low, high, binary) {
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
const plain_tick = (value) => String(Number(value.toPrecision(3))).replace("-", "−");

/// Three digits times a power of ten.
function power_tick(value) {
    const [digits, power] = Number(value.toPrecision(3)).toExponential().split("e");
    if (Number(power) === 0) return digits;
    if (Number(power) === 1) return String(digits * 10);
    const raised = Array.from(String(Number(power)), (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c])).join("");
    return `${digits === "1" ? "" : `${digits}·`}10${raised}`;
}

function axis_with({ type, title, min, max, ticks, text }) {
    return {
        type,
        min,
        max,
        title: { display: true, text: title, color: css_colour("--muted") },
        grid: { color: css_colour("--line"), drawBorder: false, tickLength: 0 },
        ticks: {
            color: css_colour("--muted"),
            padding: 6,
            autoSkip: false,
            maxRotation: 0,
            callback: (value) => text(value),
        },
        afterBuildTicks: (axis) => {
            axis.ticks = ticks.filter((tick) => tick >= axis.min && tick <= axis.max).map((value) => ({ value }));
        },
    };
}

function log_axis(title, { binary = false, values }) {
    const low = Math.min(...values);
    const high = Math.max(...values);
    const margin = (high / low) ** 0.04 * 1.03;
    const text = binary ? count_text : low >= 1e-3 && high < 1e5 ? plain_tick : power_tick;
    const ticks = log_ticks(low, high, binary);
    return axis_with({ type: "logarithmic", title, min: low / margin, max: high * margin, ticks, text });
}

/// `margin`: the room at both ends, as a share of the range. `step` between ticks, or null for a round one.
function linear_axis(title, { values, margin = 0.04, step = null }) {
    const low = Math.min(...values);
    const high = Math.max(...values);
    const room = (high - low) * margin || (high === low ? Math.abs(high) || 1 : 0);
    const ticks = even_ticks(low - room, high + room, step);
    return axis_with({ type: "linear", title, min: low - room, max: high + room, ticks, text: plain_tick });
}

function plot_options(x, y, label) {
    return {
        animation: false,
        responsive: true,
        maintainAspectRatio: false,
        font: { family: "system-ui, sans-serif" },
        scales: { x, y },
        plugins: {
            legend: {
                position: "bottom",
                labels: { color: css_colour("--text"), usePointStyle: true, boxWidth: 8, boxHeight: 8, padding: 14 },
            },
            tooltip: {
                backgroundColor: css_colour("--tip"),
                titleColor: css_colour("--tip-text"),
                bodyColor: css_colour("--tip-text"),
                padding: 10,
                usePointStyle: true,
                boxPadding: 4,
                callbacks: { title: () => "", label },
            },
        },
    };
}
