// Draws latitude-longitude pictures and lit spheres.

import { gain, luminance, tone_curves, view, write_colour, write_error } from "../shared/colour.js";
import { made_once } from "../shared/picture_data.js";
import { reference_picture } from "./data.js";
import { sample_picture, sphere_points } from "./latlong.js";

/// A function (data, i, out, at) that writes the pixel of texel value i, for colours or for errors of `quantity`.
function texel_writer(picture, quantity) {
    if (picture.channels === 1) {
        const scale = view.error_scale[quantity];
        return (data, i, out, at) => write_error(data[i], scale, out, at);
    }
    const scale = gain();
    const curve = tone_curves[view.tone];
    return (data, i, out, at) => write_colour(data[i], data[i + 1], data[i + 2], scale, curve, out, at);
}

/// One pixel for each texel; the browser does the scaling. Errors are shown only where `measured(v)`.
export function paint_lat_long(canvas, picture, quantity, measured) {
    canvas.width = picture.width;
    canvas.height = picture.height;
    const context = canvas.getContext("2d");
    const image = context.createImageData(picture.width, picture.height);
    const write = texel_writer(picture, quantity);
    for (let i = 0; i < picture.width * picture.height; ++i) {
        write(picture.data, i * picture.channels, image.data, i * 4);
        image.data[i * 4 + 3] = picture.channels > 1 || measured((Math.trunc(i / picture.width) + 0.5) / picture.height) ? 255 : 0;
    }
    context.putImageData(image, 0, 0);
}

/// A hemisphere sees what is above the horizon: the upper half of a latitude-longitude picture.
export const measured_positions = (domain) => (domain === "hemisphere" ? (v) => v < 0.5 : () => true);

/// The turn of spheres of a domain at 0 degrees, as a share of a full turn: the brightest side of the reference
/// comes half left, so that the shading shows.
function automatic_turn(domain) {
    const picture = reference_picture(domain, "irradiance");
    if (!picture) return 0;
    const equator = Math.floor(picture.height / 2 - 1) * picture.width;
    const light = (x) => luminance(picture.data.subarray((equator + x) * 3, (equator + x) * 3 + 3));
    let brightest = 0;
    for (let x = 1; x < picture.width; ++x) if (light(x) > light(brightest)) brightest = x;
    return (brightest + 0.5) / picture.width - 1 / 8;
}

/// A white diffuse sphere lit by E/pi in `picture`, or the error over it; what is not measured is hatched.
export function paint_sphere(canvas, picture, quantity, domain) {
    const size = Math.max(16, Math.min(400, Math.round(canvas.clientWidth * devicePixelRatio)));
    canvas.width = canvas.height = size;
    const context = canvas.getContext("2d");
    const image = context.createImageData(size, size);
    const { u, v, cover } = sphere_points(size);
    const out = image.data;
    const write = texel_writer(picture, quantity);
    const value = [0, 0, 0];
    const turn = view.turn / 360 + made_once(`turn ${domain}`, () => automatic_turn(domain));
    const measured = measured_positions(domain);
    for (let i = 0; i < size * size; ++i) {
        if (cover[i] === 0) continue;
        const turned = u[i] + turn - Math.floor(u[i] + turn);
        if (measured(v[i])) {
            sample_picture(picture, turned, v[i], value);
            write(value, 0, out, i * 4);
            out[i * 4 + 3] = cover[i] * 255;
        } else {
            const stripe =
                ((i % size) + Math.trunc(i / size)) % Math.round(7 * devicePixelRatio) < 1.5 * devicePixelRatio;
            out.fill(128, i * 4, i * 4 + 3);
            out[i * 4 + 3] = cover[i] * (stripe ? 120 : 50);
        }
    }
    context.putImageData(image, 0, 0);
}
