// Elements of the page, and values as text.

export const by_id = (id) => document.getElementById(id);

/// Makes an element: "tag.class.class"; perhaps attributes by name, with `on...` listeners as functions, where true is
/// an empty attribute and false, null or undefined are none; then children, nodes or text, where null is none.
export function element(tag_and_classes, ...content) {
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
export const button = (classes, attributes, ...content) =>
    element(classes ? `button.${classes}` : "button", { type: "button", ...attributes }, ...content);

/// A select of [value, title] pairs.
export function select_element(options, value, change, attributes = {}) {
    const list = options.map(([key, title]) => element("option", { value: key, selected: key === value }, title));
    return element("select", { ...attributes, onchange: (event) => change(event.target.value) }, ...list);
}

export function segment_choice(name, options, value, change) {
    return options.map(([key, title]) =>
        element(
            "label",
            element("input", {
                type: "radio",
                name,
                value: key,
                checked: String(key) === String(value),
                onchange: () => change(key),
            }),
            element("span", title),
        ),
    );
}
