// The look of charts: series, axes, cards; for the plots of all reports.

import { element } from "./elements.js";
import { count_text } from "./format.js";
import { even_ticks, log_ticks, plain_tick, power_tick } from "./ticks.js";

/// Colours that differ in hue and in lightness, on white and on black; with them, shapes.
export const k_series_colours = [
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

export const series_style = (i) => ({
    colour: k_series_colours[i % k_series_colours.length],
    shape: k_series_shapes[i % k_series_shapes.length],
});

export const css_colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export function plot_card(title, note, controls) {
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

export function log_axis(title, { binary = false, values }) {
    const low = Math.min(...values);
    const high = Math.max(...values);
    const margin = (high / low) ** 0.04 * 1.03;
    const text = binary ? count_text : low >= 1e-3 && high < 1e5 ? plain_tick : power_tick;
    const ticks = log_ticks(low, high, binary);
    return axis_with({ type: "logarithmic", title, min: low / margin, max: high * margin, ticks, text });
}

/// `margin`: the room at both ends, as a share of the range. `step` between ticks, or null for a round one.
export function linear_axis(title, { values, margin = 0.04, step = null }) {
    const low = Math.min(...values);
    const high = Math.max(...values);
    const room = (high - low) * margin || (high === low ? Math.abs(high) || 1 : 0);
    const ticks = even_ticks(low - room, high + room, step);
    return axis_with({ type: "linear", title, min: low - room, max: high + room, ticks, text: plain_tick });
}

export function plot_options(x, y, label) {
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
