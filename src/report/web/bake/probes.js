// The probes: for each height a plan of small spheres, lit by the coefficients of the probes.

import { by_id, element } from "../shared/elements.js";
import { count_text, figure_text } from "../shared/format.js";
import { painted } from "../shared/paint.js";
import { bake, picture_of, shown, stored_pictures } from "./data.js";
import { paint_picture, pixel_writers } from "./writers.js";

const k_probe_marks = { nothing: 0, valid: 1, invalid: 2 };
const k_invalid_colour = [191, 0, 0];

/// Light, or flat red for an invalid probe.
function probe_writer(marks) {
    const light = pixel_writers.light(1);
    return (data, i, out, at) => {
        if (marks.data[at / 4] !== k_probe_marks.invalid) return light(data, i, out, at);
        for (let k = 0; k < 3; ++k) out[at + k] = k_invalid_colour[k];
    };
}

function probe_plan({ height, count, name, marks: marks_name }) {
    const marks = picture_of(marks_name);
    const title = `${figure_text(height)} m, ${count_text(count)} ${count === 1 ? "probe" : "probes"}`;
    const canvas = element("canvas", { role: "img", "aria-label": `Probes at ${title}`, width: 1, height: 1 });
    painted(canvas, () =>
        paint_picture(canvas, picture_of(name), probe_writer(marks), (i) => (marks.data[i] === k_probe_marks.nothing ? 0 : 255)),
    );
    return element("figure", canvas, element("figcaption.muted", title));
}

export function build_probes() {
    const probes = bake.probes;
    by_id("probes-section").hidden = !probes;
    if (!probes) return;
    const some = probes.plans.length < probes.heights ? ` Of ${count_text(probes.heights)} heights, ${probes.plans.length} are shown.` : "";
    by_id("probes-note").textContent =
        `${count_text(probes.count)} in ${probes.codec}, seen from above, x to the right, z down the page: E/π at the normals of a sphere. ` +
        `${probes.invalid === 0 ? "All are valid." : `${count_text(probes.invalid)} see mostly back faces and are invalid (red).`}${some}`;
    by_id("probe-plans").append(...probes.plans.filter(({ name }) => stored_pictures[name]).map(probe_plan));
}
