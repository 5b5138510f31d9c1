// The plots: error against bytes with its Pareto front, and convergence with the number of samples.

import { css_colour, log_axis, plot_card, plot_options, series_style } from "../shared/charts.js";
import { by_id, element, select_element } from "../shared/elements.js";
import { capitalised, count_text, figure_text } from "../shared/format.js";
import { domains, family_of, main_axis, methods, report } from "./data.js";
import { open_detail } from "./detail.js";
import { pareto_front, spread_apart } from "./pareto.js";

const plots = {
    made: [],
    error: "irradiance_over_pi_rms",
    domain: domains[0],
    storage: "",
    colour: new Set(methods.map(family_of)).size > 3 ? "family" : "encoder",
    basis: null,
    sequence: null,
};

/// Groups that the colours of the size plot may show.
const plot_groups = {
    family: ({ method }) => family_of(method),
    encoder: ({ method }) => method.encoder,
    evaluator: ({ method }) => method.evaluator,
    storage: ({ storage }) => storage,
};

const plot_errors = [
    ["irradiance_over_pi_rms", "Irradiance E/π, RMS"],
    ["irradiance_smape", "Irradiance E/π, sMAPE"],
    ["irradiance_relmse", "Irradiance E/π, relMSE"],
    ["radiance_rms", "Radiance, RMS"],
    ["radiance_smape", "Radiance, sMAPE"],
    ["radiance_relmse", "Radiance, relMSE"],
];

export function build_plots() {
    const root = by_id("plots");
    for (const chart of plots.made) chart.destroy();
    plots.made = [];
    const cards = [build_size_plot(), build_convergence_plot()].filter(Boolean);
    root.replaceChildren(...cards.map(({ card }) => card));
    by_id("plots-section").hidden = cards.length === 0;
    // A chart measures its place, so it is made once that is on the page.
    for (const { make } of cards) make();
}

/// A choice that all plots are built again for.
function plot_select(label, key, options) {
    const choose = (value) => {
        plots[key] = value;
        build_plots();
        document.querySelector(`#plots select[data-key="${key}"]`)?.focus();
    };
    return element("label", label, select_element(options, plots[key], choose, { "data-key": key }));
}

const as_options = (values) => values.map((value) => [value, value]);

// ---- Error against bytes

/// The names of all measured storages.
const storage_names = [...new Set(methods.flatMap((method) => (method.storage ?? []).map(({ name }) => name)))];

/// The points of a method in the size plot: in floats, or in the chosen storages.
function stored_figures(method) {
    if (!plots.storage) return [{ bytes: method.bytes, error: method[plots.error], storage: "floats" }];
    return (method.storage ?? [])
        .filter(({ name }) => plots.storage === "*" || name === plots.storage)
        .map((stored) => ({ bytes: stored.bytes, error: stored[plots.error], storage: stored.name }));
}

/// The error measures that are available for the chosen storage.
const shown_errors = () =>
    plots.storage ? plot_errors.filter(([key]) => methods.some(({ storage }) => key in (storage?.[0] ?? {}))) : plot_errors;

/// Names each point of the front, where there is room.
const front_labels = {
    id: "front-labels",
    afterDatasetsDraw(chart) {
        const { ctx, chartArea } = chart;
        const front = chart.data.datasets.findIndex((set) => set.front);
        const taken = [];
        if (front < 0) return;
        ctx.save();
        ctx.font = "12px system-ui, sans-serif";
        ctx.fillStyle = css_colour("--text");
        chart.getDatasetMeta(front).data.forEach((point, i) => {
            const text = chart.data.datasets[front].data[i].method[main_axis];
            const width = ctx.measureText(text).width;
            const height = 14;
            const fits_left = point.x - width - 8 >= chartArea.left;
            const left = fits_left ? point.x - width - 8 : point.x + 8;
            const top = fits_left ? point.y + 6 : point.y - 6 - height;
            const overlaps = (box) =>
                left < box.left + box.width && box.left < left + width && Math.abs(top - box.top) < height;
            if (taken.some(overlaps)) return;
            taken.push({ left, top, width });
            ctx.fillText(text, left, top + height - 3);
        });
        ctx.restore();
    },
};

/// A point for each method, or for each storage of each.
function size_points() {
    return methods
        .filter((method) => method.domain === plots.domain)
        .flatMap((method) => stored_figures(method).map((figures) => ({ method, ...figures, y: figures.error })))
        .filter(({ bytes, y }) => bytes > 0 && y > 0);
}

function size_series(label, points, i) {
    const { colour, shape } = series_style(i);
    const of_lines = ["cross", "star", "crossRot"].includes(shape);
    return {
        label,
        data: points,
        backgroundColor: `${colour}b0`,
        borderColor: colour,
        borderWidth: of_lines ? 2 : 1,
        pointStyle: shape,
        radius: 5,
        hoverRadius: 7,
    };
}

function front_series(points) {
    return {
        front: true,
        type: "line",
        label: "Pareto front",
        data: pareto_front(points),
        stepped: "before",
        borderColor: css_colour("--muted"),
        borderWidth: 1.5,
        borderDash: [5, 4],
        pointRadius: 0,
        pointHitRadius: 0,
        pointStyle: "line",
        order: 1,
    };
}

function size_options(points) {
    const title = plot_errors.find(([key]) => key === plots.error)[1];
    const options = plot_options(
        log_axis("Bytes", { binary: true, values: points.map(({ x }) => x) }),
        log_axis(title, { values: points.map(({ y }) => y) }),
        ({ raw }) => {
            const name = plots.storage ? `${raw.method.name}, ${raw.storage}` : raw.method.name;
            return `${name}: ${figure_text(raw.y)}, ${count_text(raw.bytes)} bytes`;
        },
    );
    const most_in_tip = 8;
    options.plugins.tooltip.filter = ({ dataset }, i) => !dataset.front && i < most_in_tip;
    options.onClick = (event, hits, chart) => {
        const hit = hits.find(({ datasetIndex }) => !chart.data.datasets[datasetIndex].front);
        if (hit) open_detail(hit.element.$context.raw.method);
    };
    return options;
}

function build_size_plot() {
    if (new Set(methods.map(({ bytes }) => bytes)).size < 2 && !storage_names.length) return null;
    const errors = shown_errors();
    if (!errors.some(([key]) => key === plots.error)) plots.error = errors[0][0];
    const group_names = Object.keys(plot_groups).filter((name) => name !== "storage" || storage_names.length);
    const controls = [
        plot_select("Error", "error", errors),
        plot_select("Colour by", "colour", as_options(group_names)),
    ];
    if (domains.length > 1) controls.push(plot_select("Domain", "domain", as_options(domains)));
    if (storage_names.length)
        controls.push(plot_select("Stored as", "storage", [["", "floats"], ["*", "all"], ...as_options(storage_names)]));
    const { card, canvas } = plot_card(
        "Error against size",
        "Every method; the line joins those that no other beats in both. Click a point for its details.",
        controls,
    );
    const group_of = plot_groups[plots.colour];
    const points = size_points();
    const groups = [...new Set(points.map(group_of))];
    spread_apart(points, groups, group_of);
    const points_of = (group) => points.filter((point) => group_of(point) === group);
    const series = groups.map((group, i) => size_series(group, points_of(group), i));
    const make = () => {
        if (!points.length) return;
        const data = { datasets: [...series, front_series(points)] };
        const options = size_options(points);
        plots.made.push(new Chart(canvas, { type: "scatter", data, options, plugins: [front_labels] }));
    };
    return { card, make };
}

// ---- Convergence

function convergence_series(run, i) {
    const { colour, shape } = series_style(i);
    return {
        label: run.encoder,
        // A logarithmic axis has no place for an excess of zero or less: leave a gap.
        data: run.samples.map((x, k) => ({ x, y: run.excess[k] > 0 ? run.excess[k] : NaN })),
        showLine: true,
        borderColor: colour,
        backgroundColor: colour,
        borderWidth: 2,
        pointStyle: shape,
        radius: 4,
        hoverRadius: 6,
    };
}

function build_convergence_plot() {
    const runs = report.convergence ?? [];
    if (!runs.length) return null;
    const distinct = (key) => [...new Set(runs.map((run) => run[key]))];
    plots.basis ??= distinct("basis")[0];
    plots.sequence ??= distinct("sequence")[0];
    const controls = ["basis", "sequence"].map((key) => plot_select(capitalised(key), key, as_options(distinct(key))));
    const { card, canvas } = plot_card(
        "Convergence",
        "Distance from the limit of the encoder, relative to it, in the norm of radiance.",
        controls,
    );
    const encoders = distinct("encoder");
    const chosen = runs.filter((run) => run.basis === plots.basis && run.sequence === plots.sequence);
    const datasets = chosen.map((run) => convergence_series(run, encoders.indexOf(run.encoder)));
    const points = datasets.flatMap(({ data }) => data).filter(({ y }) => Number.isFinite(y));
    const make = () => {
        if (!points.length) return;
        const options = plot_options(
            log_axis("Samples", { binary: true, values: points.map(({ x }) => x) }),
            log_axis("Excess error, relative", { values: points.map(({ y }) => y) }),
            ({ raw, dataset }) =>
                `${plots.basis}/${dataset.label}: ${figure_text(raw.y)} at ${count_text(raw.x)} samples`,
        );
        plots.made.push(new Chart(canvas, { type: "scatter", data: { datasets }, options }));
    };
    return { card, make };
}
