// The picture table: the reference beside some methods; radiance, irradiance, errors, lit spheres.

import { error_gradient, error_scale_for, k_error_scales, view } from "../shared/colour.js";
import { button, by_id, element, select_element } from "../shared/elements.js";
import { count_text, figure_text, percent_text } from "../shared/format.js";
import { forget_canvases, repaint } from "../shared/paint.js";
import { domains, main_axis, mean } from "./data.js";
import { open_detail } from "./detail.js";
import { frame_of, reference_title } from "./frames.js";
import { quantities, relative_error } from "./ranking.js";
import { is_pinned, selection, toggle_pin } from "./selection.js";

const picture_kinds = [
    { title: "Radiance", note: "L", quantity: "radiance", form: "lat-long" },
    { title: "Radiance error", note: "sMAPE", quantity: "radiance", form: "error" },
    { title: "Irradiance", note: "E/π", quantity: "irradiance", form: "lat-long" },
    { title: "Irradiance error", note: "sMAPE of E/π", quantity: "irradiance", form: "error" },
    { title: "Lit sphere", note: "white, diffuse", quantity: "irradiance", form: "sphere" },
];

selection.shown = [...selection.chosen];

/// `layout`: null until the reader chooses one.
export const picture_table = { layout: null, error_scale_choice: { radiance: "auto", irradiance: "auto" } };

/// One subject is the reference of a domain, or a method.
function subjects_shown() {
    const used = domains.filter((domain) => selection.shown.some((method) => method.domain === domain));
    return (used.length ? used : domains.slice(0, 1)).flatMap((domain) => [
        { domain, method: null },
        ...selection.shown.filter((method) => method.domain === domain).map((method) => ({ domain, method })),
    ]);
}

export function build_picture_table() {
    const root = by_id("pictures");
    const subjects = subjects_shown();
    forget_canvases(root);
    update_error_scales();
    const cells = picture_kinds.map((kind, i) =>
        cell("kind", 0, i + 1, element("h3", kind.title), element("p.muted", kind.note)),
    );
    subjects.forEach(({ domain, method }, s) => {
        cells.push(
            cell("subject", s + 1, 0, ...(method ? method_heading(method) : [element("h3", reference_title(domain))])),
        );
        picture_kinds.forEach((kind, i) => {
            const legend = kind.form === "error" && !method;
            const content = legend ? error_legend(kind.quantity) : frame_of(kind, domain, method);
            const made = cell(legend ? "picture legend" : "picture", s + 1, i + 1, content);
            made.dataset.title = kind.title; // phones show it below the picture
            cells.push(made);
        });
        cells.push(cell("figures", s + 1, picture_kinds.length + 1, method ? short_figures(method) : null));
    });
    root.style.setProperty("--subjects", subjects.length);
    root.replaceChildren(...cells);
    const changed =
        selection.shown.length !== selection.chosen.length || selection.chosen.some((m) => !is_pinned(m));
    by_id("pictures-restore").hidden = !changed;
    lay_out_pictures();
}

/// `subject` and `kind` count from 0, the headings; the style sheet makes them columns and rows, or rows and columns.
function cell(classes, subject, kind, ...content) {
    return element(
        "div",
        { class: `cell ${classes}${subject === 1 ? " first" : ""}`, style: `--subject: ${subject}; --kind: ${kind}` },
        ...content,
    );
}

function method_heading(method) {
    return [
        button(
            "name",
            { title: "Details", onclick: () => open_detail(method) },
            element("strong", method[main_axis]),
            ...["basis", "encoder", "evaluator"]
                .filter((axis) => axis !== main_axis)
                .map((axis) => element("span", `${method[axis]} `)),
        ),
        button(
            "remove.quiet",
            {
                "aria-label": `Remove ${method.name} from the pictures`,
                title: "Remove",
                onclick: () => toggle_pin(method),
            },
            "×",
        ),
    ];
}

function short_figures(method) {
    const row = (name, value, title) => [element("dt", { title }, name), element("dd", value)];
    return element(
        "dl",
        {},
        ...row("E error", percent_text(relative_error(method, "irradiance", mean)), "RMS error of irradiance, in per cent of the mean"),
        ...row("L error", percent_text(relative_error(method, "radiance", mean)), "RMS error of radiance, in per cent of the mean"),
        ...row("E/π RMS", figure_text(method.irradiance_over_pi_rms), "RMS error of irradiance over pi [W/(m² sr)]"),
        ...row("L RMS", figure_text(method.radiance_rms), "RMS error of radiance [W/(m² sr)]"),
        ...row("Bytes", count_text(method.bytes), `${method.floats} floats`),
    );
}

/// The colour scale, with a choice of its end.
function error_legend(quantity) {
    const end = view.error_scale[quantity];
    const choices = [["auto", "auto"], ...k_error_scales.map((scale) => [String(scale), `0 – ${scale}`])];
    const choose = (choice) => {
        picture_table.error_scale_choice[quantity] = choice;
        build_picture_table();
        repaint("#detail canvas");
        document.querySelector(`.legend select[data-quantity="${quantity}"]`)?.focus();
    };
    const select = select_element(choices, picture_table.error_scale_choice[quantity], choose, {
        "data-quantity": quantity,
        "aria-label": `End of the error scale of ${quantity}`,
    });
    const bar = element("div.bar", { style: `background: ${error_gradient()}` });
    const ticks = [0, end / 2, end].map((x, i) =>
        element("span", i === 2 && end < 1 ? `≥ ${x}` : String(Number(x.toPrecision(3)))),
    );
    return element("div.error-legend", element("label", "Scale ", select), bar, element("div.ticks.number", ...ticks));
}

/// A scale with room above twice the median of the methods' mean errors.
function automatic_error_scale(shown, quantity) {
    const errors = shown
        .map((method) => method[quantities[quantity].smape])
        .filter(Number.isFinite)
        .sort((a, b) => a - b);
    return error_scale_for(errors.length ? errors[Math.trunc(errors.length / 2)] : 1);
}

function update_error_scales() {
    for (const quantity of Object.keys(quantities)) {
        const choice = picture_table.error_scale_choice[quantity];
        view.error_scale[quantity] =
            choice === "auto" ? automatic_error_scale(selection.shown, quantity) : Number(choice);
    }
}

/// Methods as columns where they fit side by side, else as rows, until the reader chooses.
export function lay_out_pictures() {
    const root = by_id("pictures");
    const scroll = by_id("picture-scroll");
    const rem = parseFloat(getComputedStyle(document.documentElement).fontSize);
    const columns_fit = (subjects_shown().length * 9.5 + 9.1) * rem <= scroll.clientWidth;
    const layout = picture_table.layout ?? (columns_fit ? "columns" : "rows");
    if (root.dataset.layout !== layout) repaint(".sphere");
    root.dataset.layout = layout;
    document.querySelector(`#layout input[value="${layout}"]`).checked = true;
}
