// Ways to paint a picture: as light, as signed values, as an error, as a share, as charts.

import { gain, tone_curves, view, write_colour, write_error } from "../shared/colour.js";
import { element } from "../shared/elements.js";

/// Signed errors: blue where the bake is too dark, black where it is right, orange where it is too bright.
const k_too_dark = [
    [0, 0, 0],
    [12, 60, 140],
    [64, 140, 232],
    [190, 225, 255],
];
const k_too_bright = [
    [0, 0, 0],
    [140, 48, 8],
    [242, 130, 36],
    [255, 228, 176],
];

export function ramp_colour(ramp, t) {
    const position = Math.max(0, Math.min(1, t)) * (ramp.length - 1);
    const below = Math.min(Math.floor(position), ramp.length - 2);
    return ramp[below].map((x, k) => x + (ramp[below + 1][k] - x) * (position - below));
}

export const css_ramp = (ramp) => ramp.map((rgb) => `rgb(${rgb.join(" ")})`).join(", ");
export const signed_gradient = () =>
    `linear-gradient(to right, ${css_ramp([...k_too_dark].reverse())}, ${css_ramp(k_too_bright.slice(1))})`;

export function write_signed_error(value, scale, out, at) {
    const rgb = ramp_colour(value < 0 ? k_too_dark : k_too_bright, Math.abs(value) / scale);
    for (let k = 0; k < 3; ++k) out[at + k] = rgb[k];
}

/// A colour of its own for each chart: hues a golden angle apart, in three lightnesses.
export function chart_colour(chart) {
    const hue = (chart * 137.508) % 360,
        lightness = 0.52 + 0.12 * ((chart % 3) - 1);
    const channel = (n) => {
        const k = (n + hue / 30) % 12;
        return 255 * (lightness - 0.42 * Math.min(lightness, 1 - lightness) * Math.max(-1, Math.min(k - 3, 9 - k, 1)));
    };
    return [channel(0), channel(8), channel(4)];
}

/// Functions (data, i, out, at) that write the pixel of the value at i, by kind of layer.
export const pixel_writers = {
    light: (factor) => {
        const scale = gain() * factor,
            curve = tone_curves[view.tone];
        return (data, i, out, at) => write_colour(data[i], data[i + 1], data[i + 2], scale, curve, out, at);
    },
    // 0 is a middle grey, as in pictures of normals.
    signed: (factor) => {
        const scale = gain() * factor;
        return (data, i, out, at) => {
            for (let k = 0; k < 3; ++k) {
                const x = data[i + k] * scale;
                out[at + k] = 127.5 * (1 + x / (1 + Math.abs(x)));
            }
        };
    },
    signed_error: (factor) => (data, i, out, at) => write_signed_error(data[i], factor, out, at),
    error: (factor) => (data, i, out, at) => write_error(data[i], factor, out, at),
    // From white at 1 over yellow to red at 0.
    share: () => (data, i, out, at) => {
        const x = data[i];
        out[at] = 225 * Math.min(1, 0.85 + 0.15 * x);
        out[at + 1] = 225 * x ** 1.2;
        out[at + 2] = 225 * x ** 3;
    },
    charts: () => (data, i, out, at) => {
        const rgb = chart_colour(data[i]);
        for (let k = 0; k < 3; ++k) out[at + k] = rgb[k];
    },
    // Ready for the screen, as preflight pictures are.
    plain: () => (data, i, out, at) => {
        for (let k = 0; k < 3; ++k) out[at + k] = 255 * data[i + k];
    },
};

/// One pixel for each value; `alpha(i)` in [0, 255] of pixel i, where given.
export function paint_picture(canvas, picture, write, alpha = null) {
    if (canvas.width !== picture.width) canvas.width = picture.width;
    if (canvas.height !== picture.height) canvas.height = picture.height;
    const context = canvas.getContext("2d");
    const image = context.createImageData(picture.width, picture.height);
    for (let i = 0; i < picture.width * picture.height; ++i) {
        write(picture.data, i * picture.channels, image.data, i * 4);
        image.data[i * 4 + 3] = alpha ? alpha(i) : 255;
    }
    context.putImageData(image, 0, 0);
}

/// A colour scale with its ends and middle.
export function scale_bar(gradient, ticks) {
    return element(
        "div.scale",
        element("div.bar", { style: `background: ${gradient}` }),
        element("div.ticks.number", ...ticks.map((text) => element("span", text))),
    );
}
