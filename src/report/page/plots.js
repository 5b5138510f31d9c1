// The plots: error against bytes with its Pareto front, and convergence with the number of samples.
"use strict";

/// Colours that differ in hue and in lightness, on white and on black; with them, shapes.
const k_series_colours = ["#5b6be0", "#e08a2e", "#1f9e89", "#c8437f", "#8f9a2f", "#9a6bd8", "#3a9bd1", "#c05a3c", "#7b8194", "#c9a227"];
const k_series_shapes = ["circle", "triangle", "rect", "rectRot", "cross", "star", "crossRot"];

const series_style = (i) => ({ colour: k_series_colours[i % k_series_colours.length], shape: k_series_shapes[i % k_series_shapes.length] });

const plots = { made: [], error: "irradiance_over_pi_rms", domain: domains[0], basis: null, sequence: null };

const plot_errors = [
    ["irradiance_over_pi_rms", "Irradiance E/π, RMS"], ["irradiance_smape", "Irradiance E/π, sMAPE"], ["irradiance_relmse", "Irradiance E/π, relMSE"],
    ["radiance_rms", "Radiance, RMS"], ["radiance_smape", "Radiance, sMAPE"], ["radiance_relmse", "Radiance, relMSE"],
];

const css_colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function build_plots() {
    const root = document.getElementById("plots");
    for (const chart of plots.made) chart.destroy();
    plots.made = [];
    const cards = [build_size_plot(), build_convergence_plot()].filter(Boolean);
    root.replaceChildren(...cards.map(({ card }) => card));
    // A chart measures its place, so it is made once that is on the page.
    for (const { make } of cards) make();
}

function plot_card(title, note, controls) {
    const canvas = element("canvas", { role: "img", "aria-label": title });
    const card = element("figure", { class: "plot" },
        element("figcaption", {}, element("h3", {}, title), element("p", { class: "muted" }, note), element("div", { class: "plot-controls" }, ...controls)),
        element("div", { class: "plot-canvas" }, canvas));
    return { card, canvas };
}

function plot_select(label, options, value, change) {
    const list = options.map(([key, title]) => element("option", { value: key, selected: key === value }, title));
    return element("label", {}, label, element("select", { onchange: (event) => change(event.target.value) }, ...list));
}

/// A logarithmic axis with ticks at 1, 2, 5 times powers of ten, or at powers of two.
function log_axis(title, { binary = false, values }) {
    const [low, high] = [Math.min(...values), Math.max(...values)], ticks = [];
    if (binary) for (let tick = 2 ** Math.floor(Math.log2(low)); tick < high * 2; tick *= 2) ticks.push(tick);
    const decades = Math.log10(high / low), steps = decades > 3 ? [1] : decades > 1.5 ? [1, 3] : [1, 2, 3, 5, 7];
    if (!binary)
        for (let power = Math.floor(Math.log10(low)); 10 ** power <= high; ++power) ticks.push(...steps.map((step) => step * 10 ** power));
    const margin = (high / low) ** 0.04 * 1.03;
    return {
        type: "logarithmic", min: low / margin, max: high * margin,
        title: { display: true, text: title, color: css_colour("--muted") },
        grid: { color: css_colour("--line"), drawBorder: false, tickLength: 0 },
        ticks: { color: css_colour("--muted"), padding: 6, autoSkip: false, maxRotation: 0, callback: (value) => (binary ? figure_text_whole(value) : String(Number(value.toPrecision(2)))) },
        afterBuildTicks: (axis) => { axis.ticks = ticks.filter((tick) => tick >= axis.min && tick <= axis.max).map((value) => ({ value })); },
    };
}

function plot_options(x, y, label) {
    return {
        animation: false, responsive: true, maintainAspectRatio: false,
        font: { family: "system-ui, sans-serif" },
        scales: { x, y },
        plugins: {
            legend: { position: "bottom", labels: { color: css_colour("--text"), usePointStyle: true, boxWidth: 8, boxHeight: 8, padding: 14 } },
            tooltip: {
                backgroundColor: css_colour("--tip"), titleColor: css_colour("--tip-text"), bodyColor: css_colour("--tip-text"),
                padding: 10, usePointStyle: true, boxPadding: 4, callbacks: { title: () => "", label },
            },
        },
    };
}

// ---- Error against bytes

/// The methods that no other beats in both bytes and error, from small to large.
function pareto_front(points) {
    const front = [];
    for (const point of [...points].sort((a, b) => a.method.bytes - b.method.bytes || a.y - b.y))
        if (!front.length || point.y < front.at(-1).y) front.push(point);
    return front;
}

/// Writes the basis beside each point of the front, where there is room.
const front_labels = {
    id: "front-labels",
    afterDatasetsDraw(chart) {
        const { ctx, chartArea } = chart, front = chart.data.datasets.findIndex((set) => set.front), taken = [];
        if (front < 0) return;
        ctx.save();
        ctx.font = "12px system-ui, sans-serif";
        ctx.fillStyle = css_colour("--text");
        chart.getDatasetMeta(front).data.forEach((point, i) => {
            const text = chart.data.datasets[front].data[i].method.basis, width = ctx.measureText(text).width;
            const box = { left: point.x - width - 8, right: point.x - 8, top: point.y + 6, bottom: point.y + 20 };
            if (box.left < chartArea.left) Object.assign(box, { left: point.x + 8, right: point.x + 8 + width, top: point.y - 20, bottom: point.y - 6 });
            if (taken.some((other) => box.left < other.right && other.left < box.right && box.top < other.bottom && other.top < box.bottom)) return;
            taken.push(box);
            ctx.fillText(text, box.left, box.bottom - 3);
        });
        ctx.restore();
    },
};

function build_size_plot() {
    // Families of one size would hide each other: move them apart by a little, 1.5 % a family.
    const families = [...new Set(methods.map(family_of))];
    const apart = (method) => 1.015 ** (families.indexOf(family_of(method)) - (families.length - 1) / 2);
    const points = methods
        .filter((method) => method.domain === plots.domain && method.bytes > 0 && method[plots.error] > 0)
        .map((method) => ({ x: method.bytes * apart(method), y: method[plots.error], method }));
    const change = (key) => (value) => {
        plots[key] = value;
        build_plots();
    };
    const controls = [plot_select("Error", plot_errors, plots.error, change("error"))];
    if (domains.length > 1) controls.push(plot_select("Domain", domains.map((domain) => [domain, domain]), plots.domain, change("domain")));
    const { card, canvas } = plot_card("Error against size", "Every method; the line joins those that nothing beats in both. A click opens the details.", controls);
    if (!points.length) return null;

    const sets = families.map((family, i) => {
        const { colour, shape } = series_style(i);
        const line_only = ["cross", "star", "crossRot"].includes(shape);
        return { label: family, data: points.filter(({ method }) => family_of(method) === family), backgroundColor: `${colour}b0`, borderColor: colour,
                 borderWidth: line_only ? 2 : 1, pointStyle: shape, radius: 5, hoverRadius: 7 };
    }).filter(({ data }) => data.length);
    const front = { front: true, type: "line", label: "Pareto front", data: pareto_front(points), stepped: "before", borderColor: css_colour("--muted"), borderWidth: 1.5,
                    borderDash: [5, 4], pointRadius: 0, pointHitRadius: 0, pointStyle: "line", order: 1 };
    const label = ({ raw, dataset }) => (dataset.front ? null : `${raw.method.name}: ${figure_text(raw.y)}, ${figure_text_whole(raw.method.bytes)} bytes`);
    const title = plot_errors.find(([key]) => key === plots.error)[1];
    const options = plot_options(log_axis("Bytes", { binary: true, values: points.map(({ x }) => x) }), log_axis(title, { values: points.map(({ y }) => y) }), label);
    options.onClick = (event, hits, chart) => {
        const hit = hits.find(({ datasetIndex }) => !chart.data.datasets[datasetIndex].front);
        if (hit) open_detail(hit.element.$context.raw.method);
    };
    options.plugins.tooltip.filter = ({ dataset }, i) => !dataset.front && i < 8;
    const make = () => plots.made.push(new Chart(canvas, { type: "scatter", data: { datasets: [...sets, front] }, options, plugins: [front_labels] }));
    return { card, make };
}

// ---- Convergence

function build_convergence_plot() {
    const runs = report.convergence ?? [];
    if (!runs.length) return null;
    const distinct = (key) => [...new Set(runs.map((run) => run[key]))];
    plots.basis ??= distinct("basis")[0];
    plots.sequence ??= distinct("sequence")[0];
    const change = (key) => (value) => {
        plots[key] = value;
        build_plots();
    };
    const controls = ["basis", "sequence"].map((key) => plot_select(key[0].toUpperCase() + key.slice(1), distinct(key).map((x) => [x, x]), plots[key], change(key)));
    const { card, canvas } = plot_card("Convergence", "Error in excess of what the encoder reaches with every texel, by the number of samples.", controls);

    const encoders = distinct("encoder");
    const chosen = runs.filter((run) => run.basis === plots.basis && run.sequence === plots.sequence);
    const sets = chosen.map((run) => {
        const { colour, shape } = series_style(encoders.indexOf(run.encoder));
        // A logarithmic axis has no place for an excess of zero or less: leave a gap.
        const data = run.samples.map((x, i) => ({ x, y: run.excess[i] > 0 ? run.excess[i] : NaN }));
        return { label: run.encoder, data, showLine: true, borderColor: colour, backgroundColor: colour, borderWidth: 2, pointStyle: shape, radius: 4, hoverRadius: 6, tension: 0 };
    });
    const values = sets.flatMap(({ data }) => data).filter(({ y }) => Number.isFinite(y));
    const label = ({ raw, dataset }) => `${plots.basis}/${dataset.label}: ${figure_text(raw.y)} at ${figure_text_whole(raw.x)} samples`;
    const make = () => {
        if (!values.length) return;
        const options = plot_options(log_axis("Samples", { binary: true, values: values.map(({ x }) => x) }), log_axis("Excess error", { values: values.map(({ y }) => y) }), label);
        plots.made.push(new Chart(canvas, { type: "scatter", data: { datasets: sets }, options }));
    };
    return { card, make };
}
