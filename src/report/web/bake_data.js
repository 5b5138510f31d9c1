// The bake's data as the page uses it.
"use strict";

const bake = JSON.parse(document.getElementById("bake-data").textContent);
const stored_pictures = JSON.parse(document.getElementById("picture-data").textContent);

/// The picture stored under a name, decoded once; null where there is none.
const picture_of = (name) => made_once(`stored ${name}`, () => decode(stored_pictures[name]));

/// What the page shows now. `object`: the number of the one that is picked out, or null.
const shown = {
    camera: 0,
    form: "wipe", // of the stage
    split: 0.5,
    error_form: "signed",
    error_scale: 0.1,
    page: 0,
    layer: 0,
    object: null,
};

const percent_text = (share) => (Number.isFinite(share) ? `${share_text(share)} %` : "–");

/// Whether the bake's luminance is above (1) or below (-1) the truth's, as a share of their sum.
function signed_difference(a, b) {
    const sum = Math.abs(a) + Math.abs(b);
    return sum > 0 ? (a - b) / sum : 0;
}

/// The signed differences of luminance between two pictures of one size, one channel.
function signed_picture(a, b) {
    const data = new Float32Array(a.width * a.height);
    const y = ({ data: d }, i) => 0.2126 * d[3 * i] + 0.7152 * d[3 * i + 1] + 0.0722 * d[3 * i + 2];
    for (let i = 0; i < data.length; ++i) data[i] = signed_difference(y(a, i), y(b, i));
    return { width: a.width, height: a.height, channels: 1, data };
}

/// Figures of a picture against the truth, over all pixels and channels.
function difference_figures(a, b) {
    let squares = 0,
        relative = 0,
        sum_a = 0,
        sum_b = 0;
    for (let i = 0; i < a.data.length; ++i) {
        const x = a.data[i],
            y = b.data[i],
            size = Math.abs(x) + Math.abs(y);
        squares += (x - y) ** 2;
        relative += size > 0 ? Math.abs(x - y) / size : 0;
        sum_a += x;
        sum_b += y;
    }
    const count = a.data.length;
    return {
        rms: Math.sqrt(squares / count) / (sum_b / count),
        relative: relative / count,
        bias: sum_a / sum_b - 1,
    };
}
