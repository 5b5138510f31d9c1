// The detail panel: one method beside the reference, with all its figures and its coefficients.

import { error_gradient, view } from "../shared/colour.js";
import { button, by_id, element } from "../shared/elements.js";
import { count_text, figure_text, share_text, vector_text } from "../shared/format.js";
import { forget_canvases } from "../shared/paint.js";
import { plain_tick } from "../shared/ticks.js";
import { frame_of } from "./frames.js";
import { is_pinned, toggle_pin } from "./selection.js";

export const detail = { method: null, opener: null };

const detail_rows = [
    { title: "Radiance", quantity: "radiance", form: "lat-long" },
    {
        title: "Irradiance / π",
        quantity: "irradiance",
        form: "lat-long",
        mark: (method) => method?.irradiance_worst?.direction,
    },
    { title: "Lit sphere", quantity: "irradiance", form: "sphere" },
];

export function open_detail(method) {
    const panel = by_id("detail");
    const focused_inside = panel.contains(document.activeElement);
    if (panel.hidden) detail.opener = document.activeElement;
    detail.method = method;
    forget_canvases(panel);
    panel.replaceChildren(
        detail_heading(method),
        element(
            "div.detail-body",
            detail_pictures(method),
            detail_figures(method),
            detail_storage(method),
            detail_coefficients(method),
        ),
    );
    panel.hidden = false;
    document.body.classList.add("with-detail");
    if (focused_inside || !detail.opener?.closest("table")) by_id("detail-title").focus({ preventScroll: true });
    document.dispatchEvent(new CustomEvent("detail-changed"));
}

export function close_detail() {
    const panel = by_id("detail");
    if (panel.hidden) return;
    forget_canvases(panel);
    panel.hidden = true;
    panel.replaceChildren();
    detail.method = null;
    document.body.classList.remove("with-detail");
    detail.opener?.focus({ preventScroll: true });
    document.dispatchEvent(new CustomEvent("detail-changed"));
}

function detail_heading(method) {
    const pin = button(
        "",
        {
            "aria-pressed": String(is_pinned(method)),
            onclick: () => {
                toggle_pin(method);
                pin.setAttribute("aria-pressed", String(is_pinned(method)));
            },
        },
        "Pin to the pictures",
    );
    return element(
        "div.detail-head",
        element(
            "h2",
            { id: "detail-title", tabindex: -1 },
            element("strong", method.basis),
            ` / ${method.encoder} / ${method.evaluator}`,
        ),
        pin,
        button("quiet.close", { "aria-label": "Close the details", title: "Close (Esc)", onclick: close_detail }, "×"),
    );
}

function detail_pictures(method) {
    const head = ["", "Reference", method.name, "Error (sMAPE)"].map((text) => element("div.detail-column", text));
    const rows = detail_rows.flatMap((kind) => [
        element("div.detail-kind", kind.title),
        frame_of({ ...kind, mark: null }, method.domain, null),
        frame_of({ ...kind, mark: null }, method.domain, method),
        element(
            "div.with-scale",
            frame_of({ ...kind, title: `${kind.title} error`, form: `${kind.form}-error` }, method.domain, method),
            small_scale(kind),
        ),
    ]);
    return element("div.detail-pictures", ...head, ...rows);
}

function small_scale({ quantity, form }) {
    if (form === "sphere") return null;
    const bar = element("span.bar", { style: `background: ${error_gradient()}` });
    return element("div.small-scale.number", "0", bar, String(view.error_scale[quantity]));
}

function detail_figures(method) {
    const head = ["", "Radiance L", "Irradiance E/π"].map((text) => element("th", { scope: "col" }, text));
    const row = (name, radiance, irradiance, as_text = figure_text) =>
        element(
            "tr",
            element("th", { scope: "row" }, name),
            element("td", as_text(method[radiance])),
            element("td", as_text(method[irradiance])),
        );
    const errors = element(
        "table.figures-table",
        element("thead", element("tr", ...head)),
        element(
            "tbody",
            {},
            row("RMS error", "radiance_rms", "irradiance_over_pi_rms"),
            row("RMS error, unweighted", "radiance_rms_unweighted", "irradiance_over_pi_rms_unweighted"),
            row("sMAPE", "radiance_smape", "irradiance_smape"),
            row("relMSE", "radiance_relmse", "irradiance_relmse"),
            row("Negative, % of directions", "negative_share", "irradiance_negative_share", share_text),
        ),
    );
    const worst = method.irradiance_worst;
    const fact = (name, value) => [element("dt", name), element("dd.number", value)];
    const facts = element(
        "dl.facts",
        ...fact("Domain", method.domain),
        ...fact("Size", `${count_text(method.floats)} floats, ${count_text(method.bytes)} bytes`),
        ...fact("Largest error of E/π", figure_text(worst?.error)),
        ...fact("… towards", worst?.direction ? vector_text(worst.direction) : "–"),
        ...fact("Encoding", `${figure_text(method.encode_ms)} ms`),
        ...fact("Evaluation", `${figure_text(method.evaluate_ns_per_normal)} ns for a normal`),
    );
    return element("div.detail-figures", errors, facts);
}

/// Errors of the method in each measured storage; null if there are none.
function detail_storage(method) {
    if (!method.storage?.length) return null;
    const five_digits = (value) => (Number.isFinite(value) ? value.toPrecision(5) : "–");
    const columns = [
        ["Storage", (stored) => stored.name],
        ["Bytes", ({ bytes }) => plain_tick(bytes)],
        ["L, RMS", ({ radiance_rms }) => five_digits(radiance_rms)],
        ["E/π, RMS", ({ irradiance_over_pi_rms }) => five_digits(irradiance_over_pi_rms)],
        ["Largest error", ({ largest_error }) => figure_text(largest_error)],
        ["Bound", ({ bound, cut }) => (cut ? `${figure_text(bound)}, ${cut} cut` : figure_text(bound))],
    ];
    const head = element("tr", ...columns.map(([title]) => element("th", { scope: "col" }, title)));
    const rows = method.storage.map((stored) =>
        element(
            "tr",
            ...columns.map(([, text], i) =>
                i ? element("td", text(stored)) : element("th", { scope: "row" }, text(stored)),
            ),
        ),
    );
    return element(
        "section.detail-storage",
        { "aria-label": "Storage" },
        element(
            "div.section-head",
            element("h3", "Stored"),
            element(
                "p.muted",
                "As a single texel: blocks and coarse chroma lose more where neighbours differ. " +
                    "The last two are of coefficients, relative to the largest.",
            ),
        ),
        element("table.figures-table", element("thead", head), element("tbody", ...rows)),
    );
}

function detail_coefficients(method) {
    const coefficients = method.coefficients ?? [];
    const status = element("span.muted", { role: "status" });
    const copy = button(
        "",
        {
            onclick: async () => {
                status.textContent = (await copy_text(JSON.stringify(coefficients)))
                    ? "Copied as JSON"
                    : "The browser refused";
            },
        },
        "Copy",
    );
    const number = (value) => element("td", Number.isFinite(value) ? value.toPrecision(6).replace("-", "−") : "–");
    const rows = coefficients.map((c, i) =>
        element("tr", element("th", { scope: "row" }, String(i)), ...[].concat(c).map(number)),
    );
    const head = element("tr", ...["i", "r", "g", "b"].map((text) => element("th", { scope: "col" }, text)));
    return element(
        "section.detail-coefficients",
        { "aria-label": "Coefficients" },
        element("div.section-head", element("h3", `${coefficients.length} coefficients`), copy, status),
        element(
            "div.coefficients-scroll",
            { tabindex: 0, role: "region", "aria-label": "Table of coefficients" },
            element("table.figures-table", element("thead", head), element("tbody", ...rows)),
        ),
    );
}

/// Copies, also where the browser keeps its clipboard interface from local files.
async function copy_text(text) {
    try {
        await navigator.clipboard.writeText(text);
        return true;
    } catch {
        const area = element("textarea.off-screen", text);
        document.body.append(area);
        area.select();
        const copied = document.execCommand("copy");
        area.remove();
        return copied;
    }
}
