// Which methods the picture table shows.

import { domains, methods } from "./data.js";
import { representative_methods } from "./ranking.js";

/// `chosen` by rule; `shown` now: the reader pins methods to the table and removes them.
export const selection = { chosen: representative_methods(methods, domains), shown: [] };
selection.shown = [...selection.chosen];

export const is_pinned = (method) => selection.shown.includes(method);

const announce = () => document.dispatchEvent(new CustomEvent("pins-changed"));

export function toggle_pin(method) {
    const { shown } = selection;
    if (is_pinned(method)) shown.splice(shown.indexOf(method), 1);
    else shown.push(method);
    announce();
}

export function restore_choice() {
    selection.shown = [...selection.chosen];
    announce();
}
