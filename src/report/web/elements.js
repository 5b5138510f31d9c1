// Elements of the page, and values as text.
"use strict";

const by_id = (id) => document.getElementById(id);

/// Makes an element: "tag.class.class"; perhaps attributes by name, with `on...` listeners as functions, where true is
/// an empty attribute and false, null or undefined are none; then children, nodes or text, where null is none.
function element(tag_and_classes, ...content) {
    const [tag, ...classes] = tag_and_classes.split(".");
    const made = document.createElement(tag);
    made.classList.add(...classes);
    const has_attributes = content[0]?.constructor === Object;
    for (const [name, value] of Object.entries(has_attributes ? content.shift() : {})) {
        if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
        else if (value === true) made.setAttribute(name, "");
        else if (value !== false && value != null) made.setAttribute(name, value);
    }
    made.append(...content.filter((child) => child != null));
    return made;
}

/// A button that does not submit anything.
const button = (classes, attributes, ...content) =>
    element(classes ? `button.${classes}` : "button", { type: "button", ...attributes }, ...content);

/// A select of [value, title] pairs.
function select_element(options, value, change, attributes = {}) {
    const list = options.map(([key, title]) => element("option", { value: key, selected: key === value }, title));
    return element("select", { ...attributes, onchange: (event) => change(event.target.value) }, ...list);
}

const capitalised = (text) => text[0].toUpperCase() + text.slice(1);

/// Three significant digits, or a dash.
function figure_text(value) {
    if (!Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    if (size === 0) return "0";
    if (size >= 1e6 || size < 1e-4)
        return value.toExponential(1).replace("e-", "e−").replace("e+", "e").replace(/^-/, "−");
    if (size >= 1000) return count_text(Math.round(value));
    return value.toPrecision(3).replace(/^-/, "−");
}

/// A share as percent, without the sign.
const share_text = (value) =>
    !Number.isFinite(value) ? "–" : value === 0 ? "0" : value < 0.001 ? "< 0.1" : (value * 100).toFixed(1);

const signed_text = (value, digits) => (value < 0 ? "−" : "+") + Math.abs(value).toFixed(digits);
const vector_text = (values, digits = 2) => values.map((x) => x.toFixed(digits).replace("-", "−")).join("  ");

/// A count, in groups of three digits.
const count_text = (value) => (Number.isFinite(value) ? value.toLocaleString("en").replaceAll(",", "\u202f") : "–");
