// The pictures of a study side by side: a row for each condition, the reference first; or how they differ from it.

import { by_id, element } from "../shared/elements.js";
import { capitalised } from "../shared/format.js";
import { is_reference } from "./data.js";
import { cell_text } from "./tables.js";

/// The first part of a caption says what a row of pictures has in common, the rest is the picture's own.
const caption_parts = ({ caption }) => {
    const comma = caption.indexOf(",");
    return comma < 0 ? [caption, ""] : [caption.slice(0, comma), caption.slice(comma + 1).trim()];
};

/// A line may not break between a number and its unit.
const figures_together = (text) => cell_text(text).replace(/(?<=\d) (?=\S)/g, "\u00a0");

function picture_image({ source, width, height }, attributes) {
    return element("img", { src: source, width, height, ...attributes });
}

/// The browser subtracts: the reference lies over the picture in the blend mode "difference", see the style.
function picture_figure(picture, reference) {
    const over = reference && reference !== picture ? picture_image(reference, { alt: "", class: "over" }) : null;
    const [, own] = caption_parts(picture);
    const frame = element(
        over ? "div.picture-frame.differs" : "div.picture-frame",
        picture_image(picture, { alt: `${picture.title}, ${picture.caption}` }),
        over,
    );
    return element(
        "figure",
        frame,
        element(
            "figcaption",
            element("strong", picture.title),
            own ? element("span.muted.number", figures_together(own)) : null,
        ),
    );
}

export function picture_groups(pictures) {
    const groups = new Map();
    for (const picture of pictures) {
        const [common] = caption_parts(picture);
        groups.set(common, [...(groups.get(common) ?? []), picture]);
    }
    return [...groups].map(([common, members]) => {
        const reference = members.find(({ title }) => is_reference(title));
        return element(
            "div.picture-group",
            common ? element("h3", capitalised(common)) : null,
            element("div.picture-row", ...members.map((picture) => picture_figure(picture, reference))),
        );
    });
}

export function connect_picture_form(pictures) {
    by_id("picture-form").hidden = !pictures.some(({ title }) => is_reference(title));
    by_id("picture-form").addEventListener("change", (event) => {
        by_id("pictures").dataset.form = event.target.value;
    });
}
