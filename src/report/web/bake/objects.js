// The table of objects: size, brightness and errors of each.

import { luminance } from "../shared/colour.js";
import { button, by_id, element } from "../shared/elements.js";
import { count_text, figure_text, percent_text } from "../shared/format.js";
import { forget_canvases, painted } from "../shared/paint.js";
import { compare_values } from "../shared/sorting.js";
import { bake, shown } from "./data.js";
import { pick_object } from "./lightmaps.js";
import { paint_picture, pixel_writers } from "./writers.js";

const k_object_columns = [
    { key: "name", title: "Object", text: ({ name }) => name },
    { key: "texels", title: "Texels", text: ({ texels }) => count_text(texels) },
    { key: "irradiance", title: "Mean E", note: "W/m²", value: ({ irradiance }) => luminance(irradiance) },
    { key: "codec_error", title: "Codec error", note: "RMS of E, over its mean", bar: true },
    { key: "standard_error", title: "Standard error", note: "of E, over its mean", bar: true },
    { key: "invalid", title: "Invalid", note: "of texels", value: ({ invalid, texels }) => (texels ? invalid / texels : 0) },
];

const object_order = { key: null, descending: false };

const object_value = (object, { key, value }) => (value ? value(object) : object[key]);

/// Swatches show E/π at the exposure of the pictures.
function irradiance_swatch({ irradiance }) {
    const canvas = element("canvas.swatch-canvas", { width: 1, height: 1, "aria-hidden": "true" });
    const picture = { width: 1, height: 1, channels: 3, data: Float32Array.from(irradiance) };
    return painted(canvas, () => paint_picture(canvas, picture, pixel_writers.light(1 / Math.PI)));
}

function object_cell(object, column, largest) {
    const value = object_value(object, column);
    if (column.key === "name") return element("th", { scope: "row" }, value);
    if (column.key === "irradiance")
        return element("td.number", irradiance_swatch(object), object.texels ? figure_text(value) : "–");
    if (column.key === "invalid")
        return element(value > 0.01 ? "td.number.bad" : "td.number", object.texels ? percent_text(value) : "–");
    if (!column.bar) return element("td.number", column.text(object));
    const share = largest > 0 && Number.isFinite(value) ? value / largest : 0;
    return element(
        "td.number.with-bar",
        { style: `--share: ${share * 100}%` },
        object.texels && Number.isFinite(value) ? percent_text(value) : "–",
    );
}

export function mark_picked_object() {
    for (const row of document.querySelectorAll("#objects tbody tr"))
        row.setAttribute("aria-selected", String(Number(row.dataset.object) === shown.object));
}

function sort_objects(column) {
    const first_descending = column.key !== "name";
    object_order.descending = object_order.key === column.key ? !object_order.descending : first_descending;
    object_order.key = column.key;
    build_objects();
    document.querySelector(`#objects button[data-key="${column.key}"]`).focus();
}

export function build_objects() {
    const objects = bake.objects ?? [];
    by_id("objects-section").hidden = objects.length === 0;
    const columns = k_object_columns.filter(({ bar, key }) => !bar || objects.some((o) => Number.isFinite(o[key])));
    const largest = Object.fromEntries(
        columns.map(({ key }) => [key, Math.max(0, ...objects.map((o) => o[key]).filter(Number.isFinite))]),
    );
    const rows = objects.map((object, number) => ({ object, number }));
    const column = columns.find(({ key }) => key === object_order.key);
    if (column) {
        const value = ({ object }) => object_value(object, column);
        rows.sort((a, b) => compare_values(value(a), value(b), object_order.descending ? -1 : 1));
    }
    const head = columns.map(({ key, title, note }) =>
        element(
            "th",
            { scope: "col", "aria-sort": key === object_order.key ? (object_order.descending ? "descending" : "ascending") : null },
            button("", { "data-key": key, onclick: () => sort_objects(columns.find((c) => c.key === key)) }, title),
            note ? element("span.muted", note) : null,
        ),
    );
    forget_canvases(by_id("objects"));
    by_id("objects").replaceChildren(
        element("thead", element("tr", ...head)),
        element(
            "tbody",
            ...rows.map(({ object, number }) =>
                element(
                    "tr",
                    {
                        "data-object": number,
                        tabindex: object.box ? 0 : null,
                        "aria-selected": String(number === shown.object),
                        onclick: object.box ? () => pick_object(number) : () => {},
                        onkeydown: (event) => {
                            if (event.key === "Enter" && object.box) pick_object(number);
                        },
                    },
                    ...columns.map((c) => object_cell(object, c, largest[c.key])),
                ),
            ),
        ),
    );
}
