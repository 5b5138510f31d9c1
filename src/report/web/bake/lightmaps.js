// The lightmaps: layers as small pictures, the chosen one large.

import { automatic_gain, error_gradient } from "../shared/colour.js";
import { signed_picture } from "../shared/differences.js";
import { button, by_id, element, segment_choice } from "../shared/elements.js";
import { figure_text, percent_text, signed_text } from "../shared/format.js";
import { forget_canvases, painted, repaint } from "../shared/paint.js";
import { made_once } from "../shared/picture_data.js";
import { hide_tip, show_tip } from "../shared/tip.js";
import { bake, picture_of, shown } from "./data.js";
import { make_viewer } from "./viewer.js";
import { paint_picture, pixel_writers, scale_bar, signed_gradient } from "./writers.js";

let viewer = null;

/// The pixel writer of a layer, by its kind and factor.
function layer_writer(layer) {
    if (layer.kind === "light" || layer.kind === "signed") return pixel_writers[layer.kind](layer.factor ?? 1);
    return pixel_writers[layer.kind](layer.scale ?? 1);
}

const is_charted = (layer) => layer.kind === "charts";
const chart_layer = () => bake.layers.find(is_charted);

/// A layer's picture of a page. One that is the difference of two others is made here.
function layer_picture(layer, page) {
    if (!layer.difference) return picture_of(`${layer.name} ${page}`);
    const [a, b] = layer.difference.map((name) => picture_of(`${name} ${page}`));
    return a && b ? made_once(`${layer.name} ${page}`, () => signed_picture(a, b)) : null;
}

/// The opacity of each texel: 0 outside of charts, low for texels of other objects if one is picked. Null: all opaque.
function texel_alpha(layer, page) {
    const charts = chart_layer() && picture_of(`${chart_layer().name} ${page}`);
    const picture = layer_picture(layer, page);
    if (!charts || charts.data.length * picture.channels !== picture.data.length) return null;
    const is_empty = (i) => {
        for (let k = 0; k < picture.channels; ++k) if (picture.data[i * picture.channels + k] !== 0) return false;
        return true;
    };
    const fades = layer.kind === "light" || layer.kind === "signed"; // these go on beyond their charts
    return (i) => {
        const chart = charts.data[i];
        if (chart === 0 && (!fades || is_empty(i))) return 0;
        if (shown.object === null) return 255;
        return chart > 0 && bake.object_of_chart[chart - 1] === shown.object ? 255 : 40;
    };
}

const current_layer = () => bake.layers[shown.layer];

function paint_layer(canvas, layer) {
    const picture = layer_picture(layer, shown.page);
    if (picture) paint_picture(canvas, picture, layer_writer(layer), texel_alpha(layer, shown.page));
}

function show_texel_tip(event, x, y) {
    const layer = current_layer(),
        picture = layer_picture(layer, shown.page);
    if (event.pointerType === "touch" || !picture || x < 0 || y < 0 || x >= picture.width || y >= picture.height)
        return hide_tip();
    const i = y * picture.width + x,
        values = [...picture.data.subarray(i * picture.channels, (i + 1) * picture.channels)],
        charts = chart_layer() && picture_of(`${chart_layer().name} ${shown.page}`),
        chart = charts?.width === picture.width ? charts.data[i] : 0,
        object = chart > 0 ? bake.objects?.[bake.object_of_chart[chart - 1]]?.name : null;
    const { width } = bake.pages[shown.page],
        factor = Math.round(width / picture.width);
    const texel = factor === 1 ? `texel ${x}, ${y}` : `texels from ${x * factor}, ${y * factor}`;
    const text = is_charted(layer)
        ? null
        : layer.kind === "signed_error"
          ? `${signed_text(values[0] * 100, 1)} %`
          : layer.kind === "error" || layer.kind === "share"
            ? percent_text(values[0])
            : values.map(figure_text).join("  ");
    show_tip(
        event,
        [
            object ?? (chart > 0 ? `chart ${chart}` : "no chart"),
            texel + (chart > 0 ? `, chart ${chart}` : ""),
            text && `${layer.symbol ?? layer.title}  ${text}${layer.unit ? ` ${layer.unit}` : ""}`,
        ].filter(Boolean),
    );
}

function layer_legend(layer) {
    const end = (layer.scale ?? 1) * 100;
    if (layer.kind === "error") return scale_bar(error_gradient(), ["0", `${end / 2} %`, `≥ ${end} %`]);
    if (layer.kind === "signed_error") return scale_bar(signed_gradient(), [`−${end} %`, "0", `+${end} %`]);
    if (layer.kind === "share")
        return scale_bar("linear-gradient(to right, rgb(191 0 0), rgb(216 139 64), rgb(225 225 225))", ["0", "50 %", "100 %"]);
    if (layer.kind === "signed") return scale_bar("linear-gradient(to right, #000, #808080, #fff)", ["below 0", "0", "above"]);
    return null;
}

function show_layer(number) {
    shown.layer = number;
    for (const thumb of document.querySelectorAll(".layers button"))
        thumb.setAttribute("aria-pressed", String(Number(thumb.dataset.layer) === number));
    const layer = current_layer();
    by_id("layer-title").replaceChildren(element("strong", layer.title), layer.note ? `  ${layer.note}` : "");
    by_id("layer-legend").replaceChildren(...[layer_legend(layer)].filter(Boolean));
    // The viewer asks the canvas for its size, which must be there before it is painted.
    const picture = layer_picture(layer, shown.page);
    if (picture) [by_id("viewer-canvas").width, by_id("viewer-canvas").height] = [picture.width, picture.height];
    viewer.apply();
    repaint("#viewer-canvas");
}

function show_page(number) {
    shown.page = number;
    build_layers();
    viewer.show_all();
}

/// Picks an object out of the lightmaps, or none; the same one again: none.
export function pick_object(number) {
    show_object(shown.object === number ? null : number);
    document.dispatchEvent(new CustomEvent("object-picked"));
    if (shown.object !== null) by_id("pages-section").scrollIntoView({ block: "start", behavior: "smooth" });
}

function show_object(number) {
    shown.object = number;
    const box = number === null ? null : bake.objects[number]?.box;
    if (box) {
        if (box.page !== shown.page) {
            document.querySelector(`#page-numbers input[value="${box.page}"]`).checked = true;
            show_page(box.page);
        }
        // The box counts texels of the page, the picture may be smaller.
        const picture = layer_picture(current_layer(), shown.page),
            factor = picture.width / bake.pages[shown.page].width;
        viewer.show_box([box.x0, box.y0, box.x1, box.y1].map((x) => x * factor));
    } else {
        viewer?.show_all();
    }
    by_id("object-clear").hidden = number === null;
    by_id("object-clear").textContent = number === null ? "" : `Only ${bake.objects[number].name} ×`;
    repaint("#viewer-canvas, .layers canvas");
}

function build_layers() {
    const root = by_id("layers");
    forget_canvases(root);
    const groups = [...new Set(bake.layers.map(({ group }) => group))];
    root.replaceChildren(
        ...groups.map((group) =>
            element(
                "div",
                element("h3", group),
                element(
                    "div.thumbs",
                    ...bake.layers.flatMap((layer, i) => {
                        if (layer.group !== group || !layer_picture(layer, shown.page)) return [];
                        const canvas = element("canvas", { width: 1, height: 1 });
                        painted(canvas, () => paint_layer(canvas, layer));
                        return [
                            button(
                                "thumb",
                                { "data-layer": i, "aria-pressed": "false", title: layer.title, onclick: () => show_layer(i) },
                                canvas,
                                element("span", layer.symbol ?? layer.title),
                            ),
                        ];
                    }),
                ),
            ),
        ),
    );
    show_layer(shown.layer);
}

function build_viewer() {
    const canvas = by_id("viewer-canvas");
    viewer = make_viewer(by_id("viewer"), { hover: show_texel_tip, leave: hide_tip });
    painted(canvas, () => {
        paint_layer(canvas, current_layer());
        viewer.apply();
    });
    by_id("viewer-tools").replaceChildren(
        element("p", { id: "layer-title", role: "status" }),
        element("div", { id: "layer-legend" }),
        button("quiet", { id: "object-clear", hidden: true, onclick: () => pick_object(null) }),
        element(
            "div.zoom",
            button("", { "aria-label": "Smaller", onclick: () => viewer.zoom_middle(1 / 1.5) }, "−"),
            button("", { "aria-label": "Larger", onclick: () => viewer.zoom_middle(1.5) }, "+"),
            button("", { onclick: () => viewer.show_all() }, "Fit"),
        ),
    );
}

/// Mean of the magnitudes of a layer's values on all pages, and the share of them that lies below 0.
function layer_range(layer) {
    let sum = 0,
        count = 0,
        below = 0;
    for (const picture of bake.pages.map((_, page) => layer_picture(layer, page)).filter(Boolean))
        for (const x of picture.data) {
            if (x === 0) continue;
            sum += Math.abs(x);
            count += 1;
            below += Math.max(0, -x);
        }
    return { mean: count ? sum / count : 0, below: sum > 0 ? below / sum : 0 };
}

/// Sets one gain for coefficients that are light and one for those that may be negative, so that each kind can be
/// compared: the largest mean magnitude is a quarter of white, or half of the way from grey to it.
function scale_coefficients() {
    const ranges = bake.layers.filter(({ kind }) => kind === "coefficient").map((layer) => ({ layer, ...layer_range(layer) }));
    // A little below 0 is an error of the fit, where no coefficient is far below; else it is what they mean.
    const may_be_negative = ranges.some(({ below }) => below > 0.1);
    for (const { layer, below } of ranges) layer.kind = may_be_negative && below > 1e-3 ? "signed" : "light";
    for (const [kind, target] of [["light", 0.25], ["signed", 1]]) {
        const of_kind = ranges.filter(({ layer }) => layer.kind === kind);
        const largest = Math.max(0, ...of_kind.map(({ mean }) => mean));
        for (const { layer } of of_kind) layer.factor = largest > 0 ? target / (largest * automatic_gain) : 1;
    }
}

export function build_pages() {
    bake.layers = (bake.layers ?? []).filter((layer) => bake.pages?.some((_, page) => layer_picture(layer, page)));
    if (!bake.layers.length) return;
    scale_coefficients();
    by_id("pages-section").hidden = false;
    const { width, height } = bake.pages[0],
        drawn = layer_picture(bake.layers[0], 0).width,
        reduced = drawn < width ? `, shown at 1/${Math.round(width / drawn)}` : "";
    by_id("pages-note").textContent =
        `${bake.pages.length === 1 ? "One page" : `${bake.pages.length} pages`} of ${width} × ${height} texels${reduced}.`;
    by_id("viewer").style.setProperty("--aspect", `${width} / ${height}`);
    by_id("page-numbers").hidden = bake.pages.length < 2;
    by_id("page-numbers").append(...segment_choice("page", bake.pages.map((_, i) => [i, String(i)]), 0, show_page));
    build_viewer();
    build_layers();
}
