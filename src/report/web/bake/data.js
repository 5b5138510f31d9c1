// The bake's data as the page uses it.

import { decode, made_once } from "../shared/picture_data.js";

export const bake = JSON.parse(document.getElementById("bake-data").textContent);
export const stored_pictures = JSON.parse(document.getElementById("picture-data").textContent);

/// The picture stored under a name, decoded once; null where there is none.
export const picture_of = (name) => made_once(`stored ${name}`, () => decode(stored_pictures[name]));

/// The state of the display. `object`: the number of the picked object, or null.
export const shown = {
    camera: 0,
    form: "wipe", // of the stage
    split: 0.5,
    error_form: "signed",
    error_scale: 0.1,
    page: 0,
    layer: 0,
    object: null,
};

