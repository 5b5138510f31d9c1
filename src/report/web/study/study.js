// Puts the report of a study together.

import { by_id, element } from "../shared/elements.js";
import { capitalised } from "../shared/format.js";
import { study } from "./data.js";
import { connect_picture_form, picture_groups } from "./pictures.js";
import { apply_hidden, build_study_plots, hidden_names } from "./plots.js";
import { study_table } from "./tables.js";

function build_study_header() {
    document.title = `${study.title} – Lobelia study`;
    by_id("title").textContent = study.title;
    by_id("summary").textContent = study.summary;
    const made_by = `Made by Lobelia${study.lobelia ? ` ${study.lobelia}` : ""}.`;
    const pictures =
        "Pictures show linear values, clipped to 0 … 1, with the sRGB curve; differences are of the displayed values.";
    by_id("made-by").textContent = study.pictures.length ? `${pictures} ${made_by}` : made_by;
}

/// Shows the sections that the study has, and links to them if there are several.
function build_contents() {
    const present = ["tables", "pictures", "plots"].filter((kind) => study[kind].length);
    for (const kind of present) by_id(`${kind}-section`).hidden = false;
    const links = present.map((kind) =>
        element("a", { href: `#${kind}-section` }, `${capitalised(kind)} (${study[kind].length})`),
    );
    if (links.length > 1) by_id("contents").append(...links);
}

build_study_header();
build_contents();
by_id("tables").append(...study.tables.map(study_table));
by_id("pictures").append(...picture_groups(study.pictures));
connect_picture_form(study.pictures);
by_id("show-all").addEventListener("click", () => {
    hidden_names.clear();
    apply_hidden();
});
build_study_plots();
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", build_study_plots);
