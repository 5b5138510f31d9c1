// Pictures in frames: latitude-longitude pictures and lit spheres, and one probe for all of them.

import { view } from "../shared/colour.js";
import { by_id, element } from "../shared/elements.js";
import { figure_text, signed_text, vector_text } from "../shared/format.js";
import { painted, repaint } from "../shared/paint.js";
import { hide_tip, show_tip } from "../shared/tip.js";
import { domains, error_picture, method_picture, reference_picture } from "./data.js";
import { measured_positions, paint_lat_long, paint_sphere } from "./draw.js";
import { direction_of, position_of } from "./latlong.js";

/// A latitude-longitude picture. `get` gives it when it is first painted.
function lat_long_frame(get, { domain, quantity, label, mark = null }) {
    const canvas = element("canvas", { role: "img", "aria-label": label, class: "lat-long", width: 2, height: 1 });
    const frame = element("div", { class: `frame ${domain}` }, canvas, element("span.cross"));
    painted(canvas, () => {
        const picture = get();
        frame.classList.toggle("missing", !picture);
        if (picture) paint_lat_long(canvas, picture, quantity, measured_positions(domain));
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

export const reference_title = (domain) => (domains.length > 1 ? `Reference, ${domain}` : "Reference");

/// The picture, its error or the lit sphere of a method; of the reference where `method` is null.
export function frame_of(kind, domain, method) {
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

export function hide_probe() {
    hide_tip();
    document.documentElement.classList.remove("probing");
}

export function turn_spheres(degrees) {
    view.turn = ((((degrees + 180) % 360) + 360) % 360) - 180;
    by_id("turn").value = view.turn;
    by_id("turn-text").textContent = `${signed_text(Math.round(view.turn), 0)}°`;
    repaint(".sphere");
}
