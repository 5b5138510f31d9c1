// Draws latitude-longitude pictures and lit spheres.
"use strict";

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

/// One pixel for each texel; the browser does the scaling. Errors are shown only where `judged(v)`.
function paint_lat_long(canvas, picture, quantity, judged) {
    canvas.width = picture.width;
    canvas.height = picture.height;
    const context = canvas.getContext("2d");
    const image = context.createImageData(picture.width, picture.height);
    const write = texel_writer(picture, quantity);
    for (let i = 0; i < picture.width * picture.height; ++i) {
        write(picture.data, i * picture.channels, image.data, i * 4);
        image.data[i * 4 + 3] = picture.channels > 1 || judged((Math.trunc(i / picture.width) + 0.5) / picture.height) ? 255 : 0;
    }
    context.putImageData(image, 0, 0);
}

/// The visible points of a sphere that fills `size` x `size` pixels, seen along -z without perspective: position (u, v)
/// of the normal, and the share of the pixel that the sphere covers.
const sphere_points = (() => {
    const made = new Map();
    return (size) => {
        if (!made.has(size)) made.set(size, make_sphere_points(size));
        return made.get(size);
    };
})();

function make_sphere_points(size) {
    const radius = size / 2 - 1;
    const u = new Float32Array(size * size);
    const v = new Float32Array(size * size);
    const cover = new Float32Array(size * size);
    for (let i = 0; i < size * size; ++i) {
        const x = ((i % size) + 0.5 - size / 2) / radius;
        const y = (size / 2 - Math.trunc(i / size) - 0.5) / radius;
        const distance = Math.hypot(x, y);
        cover[i] = Math.max(0, Math.min(1, (1 - distance) * radius + 0.5));
        // Pixels whose centre is just outside belong to the rim.
        const inside = Math.max(1, distance * 1.00001);
        const z = Math.sqrt(Math.max(0, 1 - (distance / inside) ** 2));
        [u[i], v[i]] = position_of([x / inside, y / inside, z]);
    }
    return { u, v, cover };
}

/// Bilinear texel values at (u, v), around the seam and held at the poles, into `out`.
function sample_picture({ width, height, channels, data }, u, v, out) {
    const x = u * width - 0.5;
    const y = Math.max(0, Math.min(height - 1, v * height - 0.5));
    const left = Math.floor(x);
    const top = Math.min(Math.floor(y), Math.max(height - 2, 0));
    const fx = x - left;
    const fy = y - top;
    const x0 = ((left % width) + width) % width;
    const x1 = (x0 + 1) % width;
    const below = Math.min(top + 1, height - 1);
    for (let k = 0; k < channels; ++k) {
        const a = data[(top * width + x0) * channels + k];
        const b = data[(top * width + x1) * channels + k];
        const c = data[(below * width + x0) * channels + k];
        const d = data[(below * width + x1) * channels + k];
        out[k] = (a * (1 - fx) + b * fx) * (1 - fy) + (c * (1 - fx) + d * fx) * fy;
    }
}

/// A hemisphere sees what is above the horizon: the upper half of a latitude-longitude picture.
const judged_positions = (domain) => (domain === "hemisphere" ? (v) => v < 0.5 : () => true);

/// How far spheres of a domain are turned at 0 degrees, as a share of a full turn: the brightest side of the reference
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

/// A white diffuse sphere lit by E/pi in `picture`, or the error over it; what is not judged is hatched.
function paint_sphere(canvas, picture, quantity, domain) {
    const size = Math.max(16, Math.min(400, Math.round(canvas.clientWidth * devicePixelRatio)));
    canvas.width = canvas.height = size;
    const context = canvas.getContext("2d");
    const image = context.createImageData(size, size);
    const { u, v, cover } = sphere_points(size);
    const out = image.data;
    const write = texel_writer(picture, quantity);
    const value = [0, 0, 0];
    const turn = view.turn / 360 + made_once(`turn ${domain}`, () => automatic_turn(domain));
    const judged = judged_positions(domain);
    for (let i = 0; i < size * size; ++i) {
        if (cover[i] === 0) continue;
        const turned = u[i] + turn - Math.floor(u[i] + turn);
        if (judged(v[i])) {
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
