// The scene from the bake and by paths: one stage to wipe between them, and all pictures side by side.
"use strict";

const k_forms = [
    ["wipe", "Wipe"],
    ["baked", "Bake"],
    ["truth", "Truth"],
    ["error", "Error"],
];
const k_form_titles = { baked: "From the bake", truth: "Path-traced", error: "Error" };

const current_view = () => bake.views[shown.camera];

/// The picture that a form shows of the current camera.
function view_picture(form) {
    const { baked, truth } = current_view();
    if (form !== "error") return picture_of(form === "baked" ? baked : truth);
    return made_once(`${shown.error_form} ${baked}`, () =>
        (shown.error_form === "signed" ? signed_picture : smape_picture)(picture_of(baked), picture_of(truth)),
    );
}

function paint_view(canvas, form) {
    const kind = form === "error" ? (shown.error_form === "signed" ? "signed_error" : "error") : "light";
    paint_picture(canvas, view_picture(form), pixel_writers[kind](kind === "light" ? 1 : shown.error_scale));
}

function view_canvas(form) {
    const { width, height } = picture_of(current_view().truth);
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

function segment_choice(name, options, value, change) {
    return options.map(([key, title]) =>
        element(
            "label",
            element("input", {
                type: "radio",
                name,
                value: key,
                checked: String(key) === String(value),
                onchange: () => change(key),
            }),
            element("span", title),
        ),
    );
}

/// The baked picture below, the truth above it right of the split; the error above both where it is asked for.
function build_stage() {
    const stage = by_id("stage");
    forget_canvases(stage);
    const { width, height } = picture_of(current_view().truth);
    const range = element("input", {
        type: "range",
        id: "split",
        min: 0,
        max: 100,
        step: 0.5,
        "aria-label": "Where the bake ends and the truth begins",
        oninput: (event) => set_split(event.target.value / 100),
    });
    stage.style.setProperty("--aspect", `${width} / ${height}`);
    stage.replaceChildren(
        element(
            "div.frame",
            { id: "stage-frame" },
            view_canvas("baked"),
            view_canvas("truth"),
            view_canvas("error"),
            element("span.tag.left", k_form_titles.baked),
            element("span.tag.right", k_form_titles.truth),
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
        truth = view_picture("truth"),
        baked = view_picture("baked");
    const x = Math.floor(((event.clientX - box.left) / box.width) * truth.width),
        y = Math.floor(((event.clientY - box.top) / box.height) * truth.height);
    if (event.pointerType === "touch" || x < 0 || y < 0 || x >= truth.width || y >= truth.height) return hide_tip();
    const at = 3 * (y * truth.width + x),
        a = [...baked.data.subarray(at, at + 3)],
        b = [...truth.data.subarray(at, at + 3)];
    show_tip(event, [
        `pixel ${x}, ${y}`,
        `bake   L  ${a.map(figure_text).join("  ")}`,
        `truth  L  ${b.map(figure_text).join("  ")}`,
        `signed  ${signed_text(signed_difference(luminance(a), luminance(b)) * 100, 1)} %`,
    ]);
}

// ---- Beside it

function build_side_by_side() {
    const root = by_id("side-by-side");
    forget_canvases(root);
    const samples = current_view().samples ? `, ${count_text(current_view().samples)} paths a pixel` : "";
    root.replaceChildren(
        ...["baked", "truth", "error"].map((form) =>
            button(
                "picture",
                { "data-form": form, "aria-pressed": "false", onclick: () => set_form(shown.form === form ? "wipe" : form) },
                view_canvas(form),
                element("span", k_form_titles[form] + (form === "truth" ? samples : "")),
            ),
        ),
    );
}

/// The figures of this camera, and the scale of its errors.
function build_view_figures() {
    const { baked, truth } = current_view();
    const figures = made_once(`figures ${baked}`, () => difference_figures(picture_of(baked), picture_of(truth)));
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
                "of the bake, against the truth",
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

function show_camera(number) {
    shown.camera = number;
    const { baked, truth } = current_view();
    shown.error_scale = error_scale_for(difference_figures(picture_of(baked), picture_of(truth)).relative);
    build_stage();
    build_side_by_side();
    build_view_figures();
    set_form(shown.form);
}

function build_views() {
    bake.views = (bake.views ?? []).filter(({ baked, truth }) => stored_pictures[baked] && stored_pictures[truth]);
    if (!bake.views.length) return;
    by_id("views-section").hidden = false;
    by_id("cameras").hidden = bake.views.length < 2;
    by_id("cameras").append(
        ...segment_choice("camera", bake.views.map(({ camera }, i) => [i, capitalised(camera || `camera ${i}`)]), 0, show_camera),
    );
    show_camera(0);
}
