// From linear light to pixels: exposure, tone curve, sRGB; and the colour scale of errors.

/// Display settings of all pictures. `exposure` is in EV above the automatic one, `turn` in degrees from it.
export const view = {
    exposure: 0,
    tone: "clamp",
    mark_negative: true,
    turn: 0,
    error_scale: { radiance: 1, irradiance: 1 }, // the error at the end of the colour scale
};

export const luminance = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

/// The factor at 0 EV: it shows `mean_luminance` as a quarter of white, which leaves the brighter half two stops of room.
export let automatic_gain = 1;
export function expose_for(mean_luminance) {
    automatic_gain = mean_luminance > 0 ? 0.25 / mean_luminance : 1;
}
export const gain = () => automatic_gain * 2 ** view.exposure;

/// Linear to linear in [0, 1].
export const tone_curves = {
    clamp: (x) => Math.min(x, 1),
    reinhard: (x) => x / (1 + x),
    filmic: (x) => Math.min((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 1), // Narkowicz 2016, fits ACES
};

/// sRGB codes of 2^16 linear steps: rounding to a step moves a result by less than 1/19 of a code, where the curve is
/// steepest (12.92 * 255 / 65535).
const k_linear_steps = 65535;
export const srgb_codes = Uint8ClampedArray.from({ length: k_linear_steps + 1 }, (_, i) => {
    const x = i / k_linear_steps;
    return Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
});

const k_negative_colour = [230, 30, 170];

/// Writes the sRGB pixel of a linear colour to `out` at `at`; alpha is left alone.
export function write_colour(r, g, b, scale, curve, out, at) {
    const least = Math.min(r, g, b);
    if (view.mark_negative && !(least >= 0)) {
        // Keep the magnitude visible: the more negative, the brighter. Not-a-number is marked alike, at full strength.
        const strength = Number.isNaN(least) ? 1 : 0.4 + 0.6 * curve(-least * scale) ** (1 / 2.4);
        for (let k = 0; k < 3; ++k) out[at + k] = k_negative_colour[k] * strength;
        return;
    }
    out[at] = srgb_codes[(curve(Math.max(r * scale, 0)) * k_linear_steps + 0.5) | 0];
    out[at + 1] = srgb_codes[(curve(Math.max(g * scale, 0)) * k_linear_steps + 0.5) | 0];
    out[at + 2] = srgb_codes[(curve(Math.max(b * scale, 0)) * k_linear_steps + 0.5) | 0];
}

/// Inferno at nine equal steps: perceptually uniform, dark where there is no error.
const k_inferno = [
    [0, 0, 4],
    [31, 12, 72],
    [85, 15, 109],
    [136, 34, 106],
    [186, 54, 85],
    [227, 89, 51],
    [249, 140, 10],
    [249, 201, 50],
    [252, 255, 164],
];

/// Its 256 colours, packed r, g, b.
export const error_colours = Uint8ClampedArray.from({ length: 256 * 3 }, (_, i) => {
    const position = (Math.trunc(i / 3) / 255) * (k_inferno.length - 1);
    const below = Math.min(Math.floor(position), k_inferno.length - 2),
        t = position - below;
    return Math.round(k_inferno[below][i % 3] * (1 - t) + k_inferno[below + 1][i % 3] * t);
});

export function write_error(error, scale, out, at) {
    const entry = 3 * Math.min(255, Math.round((error / scale) * 255));
    for (let k = 0; k < 3; ++k) out[at + k] = error_colours[entry + k];
}

export const k_error_scales = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1];
/// The least of the scales that leaves room above what is typical.
export const error_scale_for = (typical) => k_error_scales.find((scale) => scale >= 2 * typical) ?? 1;

export function error_gradient() {
    return `linear-gradient(to right, ${k_inferno.map((rgb) => `rgb(${rgb.join(" ")})`).join(", ")})`;
}
