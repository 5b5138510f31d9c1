// Puts the report together: header, controls, and which event changes which part.

import { expose_for, luminance } from "../shared/colour.js";
import { by_id } from "../shared/elements.js";
import { count_text, figure_text } from "../shared/format.js";
import { repaint } from "../shared/paint.js";
import { connect_toolbar, set_exposure, show_facts, show_warnings } from "../shared/toolbar.js";
import { methods, report } from "./data.js";
import { close_detail } from "./detail.js";
import { hide_probe, turn_spheres } from "./frames.js";
import { build_glance } from "./glance.js";
import { build_filters, build_method_table, mark_rows, on_method_key } from "./methods.js";
import { build_picture_table, lay_out_pictures, picture_table } from "./pictures.js";
import { build_plots } from "./plots.js";
import { restore_choice, selection } from "./selection.js";

function build_header() {
    const { environment = {}, settings = {} } = report;
    document.title = `${environment.name ?? "Environment"} – Lobelia report`;
    by_id("brand").textContent = settings.recipe
        ? `Lobelia, the ${settings.recipe} recipe`
        : "Lobelia, comparison of methods";
    by_id("environment-name").textContent = environment.name ?? "Environment";
    by_id("made-by").textContent =
        `Made by Lobelia ${report.lobelia ?? ""}, report format ${report.format ?? 1}.`;

    const size = environment.width ? `${environment.width} × ${environment.height} texels` : null;
    const source =
        environment.source_width && environment.source_width !== environment.width
            ? `, reduced from ${environment.source_width} × ${environment.source_height}`
            : "";
    const facts = [
        ["Environment", size && size + source],
        ["Mean radiance", environment.mean_radiance && environment.mean_radiance.map(figure_text).join("  ")],
        ["Methods", String(methods.length)],
    ];
    facts.push(...setting_facts(settings));
    show_facts(facts.filter(([, value]) => value));
    show_warnings(environment.warnings ?? []);
}

/// Returns the settings without the recipe and null values; a width and its height become one fact.
function setting_facts(settings) {
    const facts = [];
    for (const [key, value] of Object.entries(settings)) {
        const stem = key.replace(/_(width|height)$/, "");
        const is_size = `${stem}_width` in settings && `${stem}_height` in settings;
        const text = is_size ? `${settings[`${stem}_width`]} × ${settings[`${stem}_height`]}` : setting_text(value);
        if (value !== null && key !== "recipe" && !(is_size && key.endsWith("_height")))
            facts.push([(is_size ? `${stem} at` : key).replaceAll("_", " "), text]);
    }
    return facts;
}

function setting_text(value) {
    if (typeof value === "number") return Number.isInteger(value) ? count_text(value) : figure_text(value);
    return typeof value === "object" ? JSON.stringify(value) : String(value);
}

// ---- Controls

function connect_controls() {
    connect_toolbar();
    by_id("turn").addEventListener("input", (event) => turn_spheres(Number(event.target.value)));
    by_id("turn-reset").addEventListener("click", () => turn_spheres(0));
    by_id("layout").addEventListener("change", (event) => {
        picture_table.layout = event.target.value;
        lay_out_pictures();
    });
    by_id("pictures-restore").addEventListener("click", restore_choice);
    by_id("methods").addEventListener("keydown", on_method_key);
}

function connect_page() {
    document.addEventListener("pins-changed", build_picture_table);
    document.addEventListener("pins-changed", mark_rows);
    document.addEventListener("detail-changed", mark_rows);
    document.addEventListener("keydown", (event) => {
        if (event.key === "Escape") close_detail();
    });
    addEventListener("resize", () => {
        lay_out_pictures();
        repaint(".sphere");
    });
    addEventListener("scroll", hide_probe, { passive: true });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", build_plots);
}

by_id("pictures-rule").textContent =
    selection.chosen.length === methods.length
        ? "All methods of this report beside the reference."
        : "The reference, the methods of the least irradiance error for some sizes, and the one of the least radiance error. Pin others in the table below.";
build_header();
build_glance();
build_filters();
build_picture_table();
build_method_table();
connect_controls();
connect_page();
expose_for(luminance(report.environment?.mean_radiance ?? [0.25, 0.25, 0.25]));
set_exposure(0);
turn_spheres(0);
setTimeout(build_plots); // below the fold: let the pictures come first
