// The figures beside the pointer.

import { by_id, element } from "./elements.js";

/// Shows lines of text near the pointer, within the window.
export function show_tip(event, lines) {
    const tip = by_id("tip");
    tip.replaceChildren(...lines.map((line) => element("div", line)));
    tip.hidden = false;
    const left = Math.min(event.clientX + 16, innerWidth - tip.offsetWidth - 8);
    const below = event.clientY + 20;
    const above = event.clientY - tip.offsetHeight - 12;
    tip.style.transform = `translate(${left}px, ${below + tip.offsetHeight > innerHeight ? above : below}px)`;
}

export function hide_tip() {
    by_id("tip").hidden = true;
}
