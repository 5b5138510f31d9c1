// The header's facts and warnings, and the toolbar: exposure, tone curve, mark of negative values.

import { gain, view } from "./colour.js";
import { by_id, element } from "./elements.js";
import { figure_text, signed_text } from "./format.js";
import { repaint } from "./paint.js";

export function show_facts(facts) {
    by_id("summary").append(
        ...facts.map(([name, value]) => element("div", element("dt", name), element("dd", value))),
    );
}

export function show_warnings(warnings) {
    by_id("warnings").hidden = warnings.length === 0;
    by_id("warnings").append(...warnings.map((text) => element("li", text)));
}

export function set_exposure(ev) {
    view.exposure = Number(ev);
    by_id("exposure").value = ev;
    by_id("exposure-text").textContent = `${signed_text(view.exposure, 1)} EV`;
    by_id("exposure-text").title = `Values are multiplied by ${figure_text(gain())}`;
    repaint();
}

export function connect_toolbar() {
    by_id("exposure").addEventListener("input", (event) => set_exposure(event.target.value));
    by_id("exposure-reset").addEventListener("click", () => set_exposure(0));
    by_id("tone").addEventListener("change", (event) => {
        view.tone = event.target.value;
        repaint();
    });
    by_id("negative").addEventListener("change", (event) => {
        view.mark_negative = event.target.checked;
        repaint();
    });
    new ResizeObserver(([{ target }]) =>
        document.documentElement.style.setProperty("--toolbar-height", getComputedStyle(target).position === "sticky" ? `${target.offsetHeight}px` : "0px"),
    ).observe(by_id("toolbar"));
}
