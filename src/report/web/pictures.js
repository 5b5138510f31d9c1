// The picture table: the reference and a few methods, radiance, irradiance, errors, lit spheres; and one probe for all.
"use strict";

// ---- Frames: a picture of fixed shape with its overlays

/// A latitude-longitude picture. `get` gives it when it is first painted.
function lat_long_frame(get, { domain, quantity, label, mark = null }) {
    const canvas = element("canvas", { role: "img", "aria-label": label, class: "lat-long", width: 2, height: 1 });
    const frame = element("div", { class: `frame ${domain}` }, canvas, element("span.cross"));
    painted(canvas, () => {
        const picture = get();
        frame.classList.toggle("missing", !picture);
        if (picture) paint_lat_long(canvas, picture, quantity, judged_positions(domain));
    });
    if (mark) {
        const [u, v] = position_of(mark);
        frame.append(element("span.mark", { style: `left: ${u * 100}%; top: ${v * 100}%`, title: "Largest error" }));
    }
    attach_probe(frame, get, quantity, label);
    return frame;
}

/// A sphere lit by the picture; dragging turns all of them.
function sphere_frame(get, { domain, quantity, label }) {
    const canvas = element("canvas", { role: "img", "aria-label": label, class: "sphere", width: 1, height: 1 });
    const frame = element("div.frame.round", canvas);
    painted(canvas, () => {
        const picture = get();
        frame.classList.toggle("missing", !picture);
        if (picture) paint_sphere(canvas, picture, quantity, domain);
    });
    canvas.addEventListener("pointerdown", (event) => {
        canvas.setPointerCapture(event.pointerId);
        event.preventDefault();
    });
    canvas.addEventListener("pointermove", (event) => {
        // A drag across the sphere is half a turn.
        if (canvas.hasPointerCapture(event.pointerId))
            turn_spheres(view.turn + (event.movementX / canvas.clientWidth) * 180);
    });
    return frame;
}

const reference_title = (domain) => (domains.length > 1 ? `Reference, ${domain}` : "Reference");

/// The picture, its error or the lit sphere of a method; of the reference where `method` is null.
function frame_of(kind, domain, method) {
    const { quantity, form } = kind;
    const name = method?.name ?? reference_title(domain);
    const options = { domain, quantity, label: `${kind.title}: ${name}` };
    const get = () => {
        if (form.endsWith("error")) return error_picture(method, quantity);
        return method ? method_picture(method, quantity) : reference_picture(domain, quantity);
    };
    return form.startsWith("sphere")
        ? sphere_frame(get, options)
        : lat_long_frame(get, { ...options, mark: kind.mark?.(method) });
}

// ---- The probe: the same direction in all pictures, the value in one

function attach_probe(frame, get, quantity, label) {
    frame.addEventListener("pointermove", (event) => {
        const box = frame.getBoundingClientRect();
        const picture = get();
        const u = (event.clientX - box.left) / box.width;
        const v = (event.clientY - box.top) / box.height;
        if (!picture || u < 0 || u >= 1 || v < 0 || v >= 1) return hide_probe();
        const at = (Math.floor(v * picture.height) * picture.width + Math.floor(u * picture.width)) * picture.channels;
        const values = [...picture.data.subarray(at, at + picture.channels)];
        show_probe(event, u, v, [
            label,
            picture.channels === 1
                ? `sMAPE ${figure_text(values[0])}`
                : `${quantity === "radiance" ? "L" : "E/π"}  ${values.map(figure_text).join("  ")}`,
            `towards  ${vector_text(direction_of(u, v))}`,
        ]);
    });
    frame.addEventListener("pointerleave", hide_probe);
}

function show_probe(event, u, v, lines) {
    const root = document.documentElement;
    root.style.setProperty("--probe-u", `${u * 100}%`);
    root.style.setProperty("--probe-v", `${v * 100}%`);
    root.classList.add("probing");
    show_tip(event, lines);
}

function hide_probe() {
    hide_tip();
    document.documentElement.classList.remove("probing");
}

// ---- The table

const picture_kinds = [
    { title: "Radiance", note: "L", quantity: "radiance", form: "lat-long" },
    { title: "Radiance error", note: "sMAPE", quantity: "radiance", form: "error" },
    { title: "Irradiance", note: "E/π", quantity: "irradiance", form: "lat-long" },
    { title: "Irradiance error", note: "sMAPE of E/π", quantity: "irradiance", form: "error" },
    { title: "Lit sphere", note: "white, diffuse", quantity: "irradiance", form: "sphere" },
];

/// `chosen` by rule, and `shown` in the end; `layout` once the reader has said so.
const picture_table = {
    shown: [],
    layout: null,
    chosen: representative_methods(),
    error_scale_choice: { radiance: "auto", irradiance: "auto" },
};
picture_table.shown = [...picture_table.chosen];

const is_pinned = (method) => picture_table.shown.includes(method);

function toggle_pin(method) {
    const { shown } = picture_table;
    if (is_pinned(method)) shown.splice(shown.indexOf(method), 1);
    else shown.push(method);
    build_picture_table();
    document.dispatchEvent(new CustomEvent("pins-changed"));
}

/// One subject is the reference of a domain, or a method.
function subjects_shown() {
    const used = domains.filter((domain) => picture_table.shown.some((method) => method.domain === domain));
    return (used.length ? used : domains.slice(0, 1)).flatMap((domain) => [
        { domain, method: null },
        ...picture_table.shown.filter((method) => method.domain === domain).map((method) => ({ domain, method })),
    ]);
}

function build_picture_table() {
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
            cells.push(
                cell(
                    legend ? "picture legend" : "picture",
                    s + 1,
                    i + 1,
                    legend ? error_legend(kind.quantity) : frame_of(kind, domain, method),
                ),
            );
        });
        cells.push(cell("figures", s + 1, picture_kinds.length + 1, method ? short_figures(method) : null));
    });
    root.style.setProperty("--subjects", subjects.length);
    root.replaceChildren(...cells);
    const changed =
        picture_table.shown.length !== picture_table.chosen.length || picture_table.chosen.some((m) => !is_pinned(m));
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
        ...row("E/π RMS", figure_text(method.irradiance_over_pi_rms), "Root mean square error of irradiance over pi"),
        ...row("L RMS", figure_text(method.radiance_rms), "Root mean square error of radiance"),
        ...row(
            "E/π sMAPE",
            figure_text(method.irradiance_smape),
            "Symmetric mean absolute error of irradiance, 0 to 1",
        ),
        ...row("L sMAPE", figure_text(method.radiance_smape), "Symmetric mean absolute error of radiance, 0 to 1"),
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
            choice === "auto" ? automatic_error_scale(picture_table.shown, quantity) : Number(choice);
    }
}

/// Methods as columns where they fit side by side, else as rows, until the reader chooses.
function lay_out_pictures() {
    const root = by_id("pictures");
    const scroll = by_id("picture-scroll");
    const rem = parseFloat(getComputedStyle(document.documentElement).fontSize);
    const columns_fit = (subjects_shown().length * 9.5 + 9.1) * rem <= scroll.clientWidth;
    const layout = picture_table.layout ?? (columns_fit ? "columns" : "rows");
    if (root.dataset.layout !== layout) repaint(".sphere");
    root.dataset.layout = layout;
    document.querySelector(`#layout input[value="${layout}"]`).checked = true;
}
