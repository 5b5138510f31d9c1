// The report at a glance: white spheres lit by the environment itself and by the coefficients of a few methods.

import { button, by_id, element } from "../shared/elements.js";
import { count_text, percent_text } from "../shared/format.js";
import { domains, main_axis, mean, methods, report } from "./data.js";
import { open_detail } from "./detail.js";
import { frame_of } from "./frames.js";
import { irradiance_front, relative_error, spread_over } from "./ranking.js";

/// Methods that no smaller one beats, from the smallest to the largest; of the sphere if the report has it.
function glance_methods() {
    const of_domain = methods.filter((method) => method.domain === domains[0]);
    return spread_over(irradiance_front(of_domain), 6);
}

const sphere_kind = { title: "Lit sphere", quantity: "irradiance", form: "sphere" };

function glance_figure(method) {
    const error = relative_error(method, "irradiance", mean);
    return element(
        "figure",
        frame_of(sphere_kind, method.domain, method),
        element(
            "figcaption",
            button("name", { title: `Details of ${method.name}`, onclick: () => open_detail(method) }, element("strong", method[main_axis])),
            element("span.glance-error.number", `${percent_text(error)} error`),
            element("span.muted.number", `${count_text(method.bytes)} bytes`),
        ),
    );
}

export function build_glance() {
    const shown = glance_methods();
    by_id("glance-section").hidden = shown.length === 0;
    if (!shown.length) return;
    by_id("glance").replaceChildren(
        element(
            "figure.reference",
            frame_of(sphere_kind, domains[0], null),
            element("figcaption", element("strong", "Reference"), element("span.muted", report.settings?.reference ?? "exact")),
        ),
        ...shown.map(glance_figure),
    );
}
