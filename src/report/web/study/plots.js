// The plots of a study: curves on linear or logarithmic axes, with legends that hide them.

import {
    css_colour,
    k_series_colours,
    linear_axis,
    log_axis,
    plot_card,
    plot_options,
    series_style,
} from "../shared/charts.js";
import { button, by_id, element } from "../shared/elements.js";
import { count_text, figure_text } from "../shared/format.js";
import { is_reference, study } from "./data.js";

const shown_plots = []; // { chart, legend }
export const hidden_names = new Set(); // in all plots

/// A name has the same look in all plots. Dashes tell apart what has the same colour, and help where colours cannot.
const k_dashes = [[], [9, 4], [3, 3], [12, 4, 3, 4]];
const curve_style = (() => {
    const names = new Set(study.plots.flatMap(({ series }) => series.map(({ name }) => name)));
    const styles = new Map();
    let i = 0;
    for (const name of [...names].filter((candidate) => !is_reference(candidate))) {
        const dash = k_dashes[(i + Math.floor(i / k_series_colours.length)) % k_dashes.length];
        styles.set(name, { ...series_style(i), dash, width: 2 });
        ++i;
    }
    return (name) => styles.get(name) ?? { colour: css_colour("--text"), shape: "circle", dash: [], width: 5 };
})();

/// A logarithmic axis has no place for zero or less: leave a gap.
const on_axis = (value, axis) => Number.isFinite(value) && (axis === "linear" || value > 0);

function curve({ name, x, y }, plot) {
    const { colour, shape, dash, width } = curve_style(name);
    const few = x.length <= 24;
    return {
        label: name,
        data: x.map((value, i) =>
            on_axis(value, plot.x_axis) && on_axis(y[i], plot.y_axis) ? { x: value, y: y[i] } : { x: NaN, y: NaN },
        ),
        hidden: hidden_names.has(name),
        showLine: true,
        borderColor: colour,
        backgroundColor: colour,
        borderWidth: width,
        borderDash: dash,
        borderJoinStyle: "round",
        pointStyle: few ? shape : "circle",
        pointRadius: few && !is_reference(name) ? 3.5 : 0,
        pointHoverRadius: 4.5,
        pointBorderWidth: 1.5,
        order: is_reference(name) ? 1 : 0, // the reference below all others
    };
}

// ---- Axes and tooltips

const finite_values = (datasets, key) =>
    datasets.flatMap(({ data }) => data.map((point) => point[key])).filter(Number.isFinite);

function x_axis(plot, values) {
    if (plot.x_axis === "logarithmic") {
        const binary = values.every((value) => Number.isInteger(Math.log2(value)));
        return log_axis(plot.x_label, { binary, values });
    }
    return linear_axis(plot.x_label, { values, margin: 0, step: /degrees|°/.test(plot.x_label) ? 30 : null });
}

const y_axis = (plot, values) => (plot.y_axis === "linear" ? linear_axis : log_axis)(plot.y_label, { values });

/// If all curves have the same x values, a tooltip shows all of them there; else the nearest point only.
function tooltips_of(plot, options) {
    const places = JSON.stringify(plot.series[0].x);
    const alike = plot.series.every(({ x }) => JSON.stringify(x) === places);
    options.interaction = { mode: alike ? "index" : "nearest", axis: alike ? "x" : "xy", intersect: false };
    Object.assign(options.plugins.tooltip, {
        itemSort: (a, b) => b.raw.y - a.raw.y,
        bodyFont: { size: 12 },
        titleMarginBottom: 4,
    });
    options.plugins.tooltip.callbacks.title = ([item]) => (item ? `${plot.x_label}: ${place_text(item.raw.x)}` : "");
}

const place_text = (value) => (Number.isInteger(value) ? count_text(value) : figure_text(value));

/// A line through the points that the tooltip is about.
const place_line = {
    id: "place-line",
    beforeDatasetsDraw({ ctx, chartArea, tooltip }) {
        const [active] = tooltip?.getActiveElements() ?? [];
        if (!active) return;
        ctx.save();
        ctx.strokeStyle = css_colour("--strong-line");
        ctx.beginPath();
        ctx.moveTo(active.element.x, chartArea.top);
        ctx.lineTo(active.element.x, chartArea.bottom);
        ctx.stroke();
        ctx.restore();
    },
};

// ---- Legends

/// Draws the line and marker of a curve.
function curve_swatch(dataset) {
    const [width, height] = [38, 14];
    const canvas = element("canvas", { width: width * 2, height: height * 2, "aria-hidden": "true" });
    const context = canvas.getContext("2d");
    context.scale(2, 2);
    Object.assign(context, {
        strokeStyle: dataset.borderColor,
        fillStyle: dataset.backgroundColor,
        lineWidth: dataset.borderWidth,
    });
    context.setLineDash(dataset.borderDash);
    context.beginPath();
    context.moveTo(0, height / 2);
    context.lineTo(width, height / 2);
    context.stroke();
    context.setLineDash([]);
    const { pointStyle, pointRadius: radius, pointBorderWidth: borderWidth } = dataset;
    if (radius) Chart.helpers.drawPoint(context, { pointStyle, radius, borderWidth }, width / 2, height / 2);
    return canvas;
}

function legend_entry(dataset, emphasise) {
    const name = dataset.label;
    return button(
        "legend-entry",
        {
            "data-name": name,
            "aria-pressed": String(!hidden_names.has(name)),
            onclick: (event) => {
                // The second click of a double click must not undo what the double click does.
                if (event.detail > 1) return;
                if (!hidden_names.delete(name)) hidden_names.add(name);
                apply_hidden();
            },
            ondblclick: () => show_alone(name),
            onpointerenter: () => emphasise(name),
            onpointerleave: () => emphasise(null),
            onfocus: () => emphasise(name),
            onblur: () => emphasise(null),
        },
        curve_swatch(dataset),
        element("span", name),
    );
}

/// Shows one name and the references only.
function show_alone(name) {
    hidden_names.clear();
    for (const { series } of study.plots)
        for (const { name: other } of series) if (other !== name && !is_reference(other)) hidden_names.add(other);
    apply_hidden();
}

/// Brings all plots and legends to what is hidden.
export function apply_hidden() {
    for (const { chart, legend } of shown_plots) {
        chart.data.datasets.forEach(({ label }, i) => chart.setDatasetVisibility(i, !hidden_names.has(label)));
        chart.update();
        for (const entry of legend.children)
            entry.setAttribute("aria-pressed", String(!hidden_names.has(entry.dataset.name)));
    }
    by_id("show-all").hidden = hidden_names.size === 0;
}

/// Fades all curves but one; none where `name` is null.
function emphasise_curve(chart, name) {
    for (const dataset of chart.data.datasets) {
        const fade = name !== null && dataset.label !== name && !hidden_names.has(name);
        dataset.borderColor = dataset.backgroundColor + (fade ? "30" : "");
        dataset.pointBackgroundColor = dataset.borderColor;
    }
    chart.update();
}

// ---- Plots

function build_plot(plot) {
    const { card, canvas } = plot_card(plot.title, plot.note, []);
    const legend = element("div.legend", { role: "group", "aria-label": "Curves" });
    card.append(legend);
    const make = () => {
        const datasets = plot.series.map((series) => curve(series, plot));
        const [xs, ys] = ["x", "y"].map((key) => finite_values(datasets, key));
        if (!xs.length) return;
        const options = plot_options(
            x_axis(plot, xs),
            y_axis(plot, ys),
            ({ raw, dataset }) => `${dataset.label}: ${figure_text(raw.y)}`,
        );
        options.plugins.legend.display = false;
        tooltips_of(plot, options);
        const chart = new Chart(canvas, { type: "scatter", data: { datasets }, options, plugins: [place_line] });
        legend.append(...datasets.map((dataset) => legend_entry(dataset, (name) => emphasise_curve(chart, name))));
        shown_plots.push({ chart, legend });
    };
    return { card, make };
}

export function build_study_plots() {
    for (const { chart } of shown_plots.splice(0)) chart.destroy();
    const plots = study.plots.map(build_plot);
    by_id("plots").replaceChildren(...plots.map(({ card }) => card));
    // A chart measures its place, so it is made once that is on the page.
    for (const { make } of plots) make();
}
