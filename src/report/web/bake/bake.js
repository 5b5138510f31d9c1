// Puts the report of a bake together.

import { expose_for, luminance, view } from "../shared/colour.js";
import { by_id, element } from "../shared/elements.js";
import { count_text, figure_text, percent_text, share_text } from "../shared/format.js";
import { painted } from "../shared/paint.js";
import { hide_tip } from "../shared/tip.js";
import { connect_toolbar, set_exposure, show_facts, show_warnings } from "../shared/toolbar.js";
import { bake, picture_of, shown, stored_pictures } from "./data.js";
import { build_pages, pick_object } from "./lightmaps.js";
import { build_objects, mark_picked_object } from "./objects.js";
import { build_probes } from "./probes.js";
import { build_views } from "./wipe.js";
import { paint_picture, pixel_writers } from "./writers.js";

function build_bake_header() {
    document.title = `${bake.title} – Lobelia bake`;
    by_id("title").textContent = bake.title;
    by_id("made-by").textContent = `Made by Lobelia ${bake.lobelia ?? ""}.`;
    show_facts(bake.settings ?? []);
    show_warnings(bake.warnings ?? []);
}

/// Statistics as [figure, unit, name, explanation, whether to highlight it].
function statistics_tiles(s) {
    const baked = Number.isFinite(s.codec_error);
    const adaptive = bake.settings?.some(([name]) => name === "target error");
    return [
        [figure_text(s.rays / s.seconds / 1e6), "Mray/s", "Speed", `${figure_text(s.rays / 1e6)} million rays in ${figure_text(s.seconds)} s`],
        [count_text(s.texels), "", "Texels", `${count_text(s.samples)} samples each${adaptive ? " at most" : ""}`],
        [share_text(s.mean_error), "%", "Standard error", "of E at a texel, over the mean E, before denoising", s.mean_error > 0.1],
        baked && [share_text(s.codec_error), "%", "Codec error", "RMS of E by the codec minus E by the paths, over the mean E"],
        [share_text(s.back_face_share), "%", "Leaks", "of paths hit the back of a one-sided surface first", s.back_face_share > 0.01],
        [share_text(s.invalid_texels / s.texels), "%", "Invalid texels", `${count_text(s.invalid_texels)} see mostly back faces; ${count_text(s.buried_texels)} of them lie inside other geometry`, s.invalid_texels - s.buried_texels > 0.02 * s.texels],
        baked && [share_text(s.negative_share), "%", "Negative", "of irradiance evaluations around each normal are below 0", s.negative_share > 0.01],
        baked && [share_text(s.ringing), "%", "Ringing", "sum of negative E, over the sum of E", s.ringing > 0.01],
    ].filter(Boolean);
}

function build_tiles() {
    const statistics = bake.statistics;
    by_id("figures-section").hidden = !statistics;
    if (!statistics) return;
    by_id("tiles").append(
        ...statistics_tiles(statistics).map(([figure, unit, name, note, attention]) =>
            element(
                attention ? "div.tile.attention" : "div.tile",
                element("dt", name),
                element("dd", figure, unit ? element("small", unit) : null),
                element("p.muted", note),
            ),
        ),
    );
}

/// Bars of the area's share in each range of texel densities.
function build_density(density) {
    const most = Math.max(...density.map(([, share]) => share));
    by_id("density").hidden = density.length < 2;
    if (density.length < 2) return;
    by_id("density").append(
        element("figcaption.muted", "Texels per metre, by share of the area"),
        element(
            "div.density-bars",
            ...density.map(([from, share]) =>
                element(
                    "div",
                    { title: `from ${figure_text(from)}: ${percent_text(share)}` },
                    element("span", { style: `height: ${(100 * share) / most}%` }),
                    element("small.number", Number(from.toPrecision(2)).toString()),
                ),
            ),
        ),
    );
}

function build_preflight() {
    const { checks = [], pictures = [], density = [] } = bake.preflight ?? {};
    build_density(density);
    by_id("preflight-section").hidden = checks.length + pictures.length === 0;
    const marks = { good: "✓", note: "i", warning: "!", bad: "×" };
    by_id("checks").append(
        ...checks.map(({ level, name, text }) =>
            element(
                `li.${level}`,
                element("span.mark", { "aria-label": level }, marks[level] ?? "i"),
                element("div", element("strong", name), text ? element("p.muted", text) : null),
            ),
        ),
    );
    by_id("preflight-pictures").append(
        ...pictures
            .filter(({ name }) => stored_pictures[name])
            .map(({ name, title }) => {
                const canvas = element("canvas", { role: "img", "aria-label": title, width: 1, height: 1 });
                painted(canvas, () => paint_picture(canvas, picture_of(name), pixel_writers.plain()));
                return element("figure", canvas, element("figcaption.muted", title));
            }),
    );
}

/// The exposure follows the mean radiance of the reference, or of the lightmaps if there are no views.
function automatic_exposure() {
    const view = bake.views?.find(({ reference }) => stored_pictures[reference]);
    const picture = view ? picture_of(view.reference) : null;
    if (!picture) return bake.mean_irradiance > 0 ? bake.mean_irradiance / Math.PI : 0.25;
    let sum = 0;
    const { data } = picture;
    for (let i = 0; i < data.length; i += 3) sum += luminance(data.subarray(i, i + 3));
    return sum / (data.length / 3);
}

view.tone = "filmic";
expose_for(automatic_exposure());
build_bake_header();
build_tiles();
build_views();
build_pages();
build_probes();
build_objects();
build_preflight();
connect_toolbar();
set_exposure(0);
document.addEventListener("object-picked", mark_picked_object);
addEventListener("scroll", hide_tip, { passive: true });
addEventListener("keydown", (event) => {
    if (event.key === "Escape" && shown.object !== null) pick_object(null);
});
