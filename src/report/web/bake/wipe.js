// The scene lit by the bake beside its path-traced reference: one stage to wipe between them, and all pictures side by side.

import { error_gradient, error_scale_for, k_error_scales, luminance, view } from "../shared/colour.js";
import { difference_figures, signed_difference, signed_picture, smape_picture } from "../shared/differences.js";
import { button, by_id, element, segment_choice, select_element } from "../shared/elements.js";
import { capitalised, count_text, figure_text, percent_text, signed_text } from "../shared/format.js";
import { forget_canvases, painted, repaint } from "../shared/paint.js";
import { made_once } from "../shared/picture_data.js";
import { hide_tip, show_tip } from "../shared/tip.js";
import { bake, picture_of, shown, stored_pictures } from "./data.js";
import { paint_picture, pixel_writers, scale_bar, signed_gradient } from "./writers.js";

const k_forms = [
    ["wipe", "Wipe"],
    ["baked", "Bake"],
    ["reference", "Reference"],
    ["error", "Error"],
];
const k_form_titles = { baked: "From the bake", reference: "Path-traced reference", error: "Error" };

const current_view = () => bake.views[shown.camera];

/// The picture of the current camera in a form.
function view_picture(form) {
    const { baked, reference } = current_view();
    if (form !== "error") return picture_of(form === "baked" ? baked : reference);
    return made_once(`${shown.error_form} ${baked}`, () =>
        (shown.error_form === "signed" ? signed_picture : smape_picture)(picture_of(baked), picture_of(reference)),
    );
}

function paint_view(canvas, form) {
    const kind = form === "error" ? (shown.error_form === "signed" ? "signed_error" : "error") : "light";
    paint_picture(canvas, view_picture(form), pixel_writers[kind](kind === "light" ? 1 : shown.error_scale));
}

function view_canvas(form) {
    const { width, height } = picture_of(current_view().reference);
    const label = `${k_form_titles[form]}, camera ${current_view().camera}`;
    const canvas = element("canvas", { role: "img", "aria-label": label, class: `view ${form}`, width, height });
    return painted(canvas, () => paint_view(canvas, form));
}

// ---- The stage

function set_split(share) {
    shown.split = Math.max(0, Math.min(1, share));
    by_id("stage").style.setProperty("--split", `${shown.split * 100}%`);
    by_id("split").value = shown.split * 100;
}

function set_form(form) {
    shown.form = form;
    by_id("stage").dataset.form = form;
    for (const figure of document.querySelectorAll(".side-by-side button"))
        figure.setAttribute("aria-pressed", String(figure.dataset.form === form));
    document.querySelector(`#forms input[value="${form}"]`).checked = true;
}

/// The baked picture below, the reference above it right of the split; the error above both where it is asked for.
function build_stage() {
    const stage = by_id("stage");
    forget_canvases(stage);
    const { width, height } = picture_of(current_view().reference);
    const range = element("input", {
        type: "range",
        id: "split",
        min: 0,
        max: 100,
        step: 0.5,
        "aria-label": "Position of the wipe between bake and reference",
        oninput: (event) => set_split(event.target.value / 100),
    });
    stage.style.setProperty("--aspect", `${width} / ${height}`);
    stage.replaceChildren(
        element(
            "div.frame",
            { id: "stage-frame" },
            view_canvas("baked"),
            view_canvas("reference"),
            view_canvas("error"),
            element("span.tag.left", k_form_titles.baked),
            element("span.tag.right", k_form_titles.reference),
            element("span.tag.whole"),
            range,
            element("span.handle", { "aria-hidden": "true" }, element("span")),
        ),
        element(
            "div.stage-tools",
            element("fieldset.segments", { id: "forms" }, element("legend", "Show"), ...segment_choice("form", k_forms, shown.form, set_form)),
        ),
    );
    connect_stage();
    set_split(shown.split);
}

function connect_stage() {
    const frame = by_id("stage-frame");
    const share_at = (event) => {
        const box = frame.getBoundingClientRect();
        return (event.clientX - box.left) / box.width;
    };
    frame.addEventListener("pointerdown", (event) => {
        if (shown.form !== "wipe" || event.button !== 0) return;
        frame.setPointerCapture(event.pointerId);
        set_split(share_at(event));
        event.preventDefault();
        by_id("split").focus({ preventScroll: true });
    });
    frame.addEventListener("pointermove", (event) => {
        if (frame.hasPointerCapture(event.pointerId)) set_split(share_at(event));
        else show_view_tip(event, frame);
    });
    frame.addEventListener("pointerleave", hide_tip);
}

/// The values at the pointer, in both pictures.
function show_view_tip(event, frame) {
    const box = frame.getBoundingClientRect(),
        reference = view_picture("reference"),
        baked = view_picture("baked");
    const x = Math.floor(((event.clientX - box.left) / box.width) * reference.width),
        y = Math.floor(((event.clientY - box.top) / box.height) * reference.height);
    if (event.pointerType === "touch" || x < 0 || y < 0 || x >= reference.width || y >= reference.height) return hide_tip();
    const at = 3 * (y * reference.width + x),
        a = [...baked.data.subarray(at, at + 3)],
        b = [...reference.data.subarray(at, at + 3)];
    show_tip(event, [
        `pixel ${x}, ${y}`,
        `bake   L  ${a.map(figure_text).join("  ")}`,
        `reference  L  ${b.map(figure_text).join("  ")}`,
        `signed  ${signed_text(signed_difference(luminance(a), luminance(b)) * 100, 1)} %`,
    ]);
}

// ---- Beside it

function build_side_by_side() {
    const root = by_id("side-by-side");
    forget_canvases(root);
    const samples = current_view().samples ? `, ${count_text(current_view().samples)} paths a pixel` : "";
    root.replaceChildren(
        ...["baked", "reference", "error"].map((form) =>
            button(
                "picture",
                { "data-form": form, "aria-pressed": "false", onclick: () => set_form(shown.form === form ? "wipe" : form) },
                view_canvas(form),
                element("span", k_form_titles[form] + (form === "reference" ? samples : "")),
            ),
        ),
    );
}

const figures_of = (baked, reference) =>
    made_once(`figures ${baked}`, () => difference_figures(picture_of(baked), picture_of(reference)));

/// The figures of this camera, and the scale of its errors.
function build_view_figures() {
    const { baked, reference } = current_view();
    const figures = figures_of(baked, reference);
    const row = (value, name, note) => element("div", element("dt", name), element("dd", value), element("p.muted", note));
    const signed = shown.error_form === "signed",
        end = shown.error_scale * 100;
    const repaint_errors = (key, value) => {
        shown[key] = value;
        build_view_figures();
        repaint(".view.error");
    };
    by_id("view-figures").replaceChildren(
        element(
            "dl",
            row(percent_text(figures.relative), "Mean error", "relative, of all pixels"),
            row(percent_text(figures.rms), "RMS error", "over the mean radiance"),
            row(
                Number.isFinite(figures.bias) ? `${signed_text(figures.bias * 100, 2)} %` : "–",
                "Brightness",
                "of the bake, against the reference",
            ),
        ),
        element(
            "div.error-scale",
            element("h3", "Error"),
            element(
                "fieldset.segments",
                {},
                ...segment_choice(
                    "error-form",
                    [
                        ["signed", "Signed"],
                        ["absolute", "Absolute"],
                    ],
                    shown.error_form,
                    (form) => repaint_errors("error_form", form),
                ),
            ),
            scale_bar(
                signed ? signed_gradient() : error_gradient(),
                signed ? [`−${end} %`, "0", `+${end} %`] : ["0", `${end / 2} %`, `${end} %`],
            ),
            signed ? element("div.ticks.muted", element("span", "too dark"), element("span", "too bright")) : null,
            element(
                "label.muted",
                "Up to ",
                select_element(
                    k_error_scales.map((scale) => [String(scale), `${scale * 100} %`]),
                    String(shown.error_scale),
                    (scale) => repaint_errors("error_scale", Number(scale)),
                ),
            ),
        ),
    );
}

/// Explains a difference of brightness that noise cannot: specular reflection is beyond diffuse coefficients.
function explain_brightness({ bias }) {
    const reason = !bake.settings?.some(([name, value]) => name === "codec" && value.startsWith("none"))
        ? "A few coefficients blur the radiance that glossy surfaces reflect, and highlights come out weaker"
        : "This bake holds irradiance alone, which has no specular reflection: highlights are missing";
    by_id("views-explanation").textContent =
        bias < -0.005
            ? `The bake is ${percent_text(-bias)} darker than the reference. ${reason}; the error picture shows where.`
            : "";
}

function show_camera(number) {
    shown.camera = number;
    const { baked, reference } = current_view();
    const figures = figures_of(baked, reference);
    shown.error_scale = error_scale_for(figures.relative);
    build_stage();
    build_side_by_side();
    build_view_figures();
    explain_brightness(figures);
    set_form(shown.form);
}

export function build_views() {
    bake.views = (bake.views ?? []).filter(({ baked, reference }) => stored_pictures[baked] && stored_pictures[reference]);
    if (!bake.views.length) return;
    by_id("views-section").hidden = false;
    by_id("cameras").hidden = bake.views.length < 2;
    by_id("cameras").append(
        ...segment_choice("camera", bake.views.map(({ camera }, i) => [i, capitalised(camera || `camera ${i}`)]), 0, show_camera),
    );
    show_camera(0);
}
