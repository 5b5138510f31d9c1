// Puts the page together: header, controls, and what changes what.
"use strict";

function build_header() {
    const { environment = {}, settings = {} } = report;
    document.title = `${environment.name ?? "Environment"} – Lobelia report`;
    by_id("brand").textContent = settings.recipe
        ? `Lobelia, the ${settings.recipe} recipe`
        : "Lobelia, comparison of methods";
    by_id("environment-name").textContent = environment.name ?? "Environment";
    by_id("made-by").textContent =
        `Made by Lobelia ${report.lobelia ?? ""}, report format ${report.format ?? 1}. Charts: Chart.js, MIT licence.`;

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

/// All settings but the recipe and what is null; a width and its height become one.
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

function turn_spheres(degrees) {
    view.turn = ((((degrees + 180) % 360) + 360) % 360) - 180;
    by_id("turn").value = view.turn;
    by_id("turn-text").textContent = `${signed_text(Math.round(view.turn), 0)}°`;
    repaint(".sphere");
}

function connect_controls() {
    connect_toolbar();
    by_id("turn").addEventListener("input", (event) => turn_spheres(Number(event.target.value)));
    by_id("turn-reset").addEventListener("click", () => turn_spheres(0));
    by_id("layout").addEventListener("change", (event) => {
        picture_table.layout = event.target.value;
        lay_out_pictures();
    });
    by_id("pictures-restore").addEventListener("click", () => {
        picture_table.shown = [...picture_table.chosen];
        build_picture_table();
        document.dispatchEvent(new CustomEvent("pins-changed"));
    });
    by_id("methods").addEventListener("keydown", on_method_key);
}

function connect_page() {
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
    picture_table.chosen.length === methods.length
        ? "All methods of this report beside the reference."
        : "For some sizes the method of the least irradiance error, and the one of the least radiance error; the table pins others.";
build_header();
build_filters();
build_picture_table();
build_method_table();
connect_controls();
connect_page();
expose_for(luminance(report.environment?.mean_radiance ?? [0.25, 0.25, 0.25]));
set_exposure(0);
turn_spheres(0);
setTimeout(build_plots); // below the fold: let the pictures come first
