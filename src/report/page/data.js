// The report's data as the page uses it: its methods, pictures decoded from half floats, and errors between pictures.
"use strict";

const report = JSON.parse(document.getElementById("report-data").textContent);
const stored_pictures = JSON.parse(document.getElementById("picture-data").textContent);
const methods = report.methods ?? [];
const method_by_name = new Map(methods.map((method) => [method.name, method]));
const domains = [...new Set(methods.map((method) => method.domain))].sort().reverse(); // the sphere first

/// What pictures show, and which of a method's figures judge it.
const quantities = {
    radiance: { title: "Radiance", stored: "radiance", rms: "radiance_rms", smape: "radiance_smape" },
    irradiance: {
        title: "Irradiance / π",
        stored: "irradiance_over_pi",
        rms: "irradiance_over_pi_rms",
        smape: "irradiance_smape",
    },
};

// ---- Methods

/// Bases whose names differ in numbers only, in size that is, are one family; a family of one has its basis's name.
const family_of = (() => {
    const bases_of_stem = new Map(),
        stem = (basis) => basis.replace(/\d+/g, "");
    for (const { basis } of methods)
        bases_of_stem.set(stem(basis), (bases_of_stem.get(stem(basis)) ?? new Set()).add(basis));
    return ({ basis }) => (bases_of_stem.get(stem(basis)).size > 1 && stem(basis) ? stem(basis) : basis);
})();

/// The first part of the name that tells methods apart.
const main_axis =
    ["basis", "encoder", "evaluator"].find((axis) => methods.some((method) => method[axis] !== methods[0][axis])) ??
    "basis";

/// A figure for ordering: what is missing or not a number comes last.
const figure_or_last = (method, key) => (Number.isFinite(method[key]) ? method[key] : Infinity);

/// The methods that the picture table shows at first: all where they are few; else some of each domain.
function representative_methods() {
    const few = 12;
    if (methods.length <= few) return [...methods];
    return domains.flatMap((domain) =>
        representatives_of(
            methods.filter((method) => method.domain === domain),
            domains.length > 1 ? 4 : 6,
        ),
    );
}

/// For each family its smallest method whose irradiance error is within a tenth of the family's lowest; then, as long
/// as there is room, the best of each further basis, small ones first. In order of size.
function representatives_of(candidates, most) {
    const error = (method) => figure_or_last(method, quantities.irradiance.rms);
    const by_error = [...candidates].sort((a, b) => error(a) - error(b));
    const by_size = [...by_error].sort((a, b) => a.floats - b.floats); // stable: the best of a size comes first
    const chosen = [];
    for (const family of new Set(by_error.map(family_of))) {
        const lowest = error(by_error.find((method) => family_of(method) === family));
        chosen.push(
            by_size.find((method) => family_of(method) === family && error(method) <= 1.1 * lowest) ?? by_size[0],
        );
    }
    for (const method of by_size) if (!chosen.some(({ basis }) => basis === method.basis)) chosen.push(method);
    return chosen.slice(0, most).sort((a, b) => a.floats - b.floats);
}

// ---- Pictures: { width, height, channels, data }, row by row; null where the report has none

/// The float of each of the 65536 halves.
const float_from_half = Float32Array.from({ length: 65536 }, (_, bits) => {
    const sign = bits & 0x8000 ? -1 : 1,
        exponent = (bits >> 10) & 31,
        mantissa = bits & 1023;
    if (exponent === 31) return mantissa ? NaN : sign * Infinity;
    return sign * (exponent ? (1024 + mantissa) * 2 ** (exponent - 25) : mantissa * 2 ** -24);
});

function decode(stored) {
    if (!stored?.half) return null;
    const bytes = atob(stored.half);
    const data = new Float32Array(bytes.length / 2);
    for (let i = 0; i < data.length; ++i)
        data[i] = float_from_half[bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8)];
    return { width: stored.width, height: stored.height, channels: 3, data };
}

/// What was made under a key, or else what `make` makes now.
const made = new Map();
function made_once(key, make) {
    if (!made.has(key)) made.set(key, make());
    return made.get(key);
}

function reference_picture(domain, quantity) {
    const { stored } = quantities[quantity];
    return made_once(`reference ${domain} ${quantity}`, () => decode(stored_pictures.references[domain]?.[stored]));
}

/// Radiance does not depend on how irradiance is evaluated, hence its shorter key.
function method_picture(method, quantity) {
    const key = quantity === "radiance" ? `${method.basis}/${method.encoder}` : method.name;
    return made_once(`${quantity} ${key}`, () => decode(stored_pictures[quantities[quantity].stored][key]));
}

/// `picture` at another size: each texel is the mean of those whose centres it holds, or else the nearest.
function resized(picture, width, height) {
    if (picture.width === width && picture.height === height) return picture;
    const { channels, data } = picture;
    const range = (i, to, from) => {
        const begin = Math.ceil((i * from) / to - 0.5),
            end = Math.ceil(((i + 1) * from) / to - 0.5);
        return end > begin
            ? [begin, end]
            : [Math.floor(((i + 0.5) * from) / to), Math.floor(((i + 0.5) * from) / to) + 1];
    };
    const out = new Float32Array(width * height * channels);
    for (let y = 0; y < height; ++y) {
        const [top, bottom] = range(y, height, picture.height);
        for (let x = 0; x < width; ++x) {
            const [left, right] = range(x, width, picture.width);
            const share = 1 / ((bottom - top) * (right - left));
            const at = (y * width + x) * channels;
            for (let row = top; row < bottom; ++row)
                for (let i = (row * picture.width + left) * channels; i < (row * picture.width + right) * channels; ++i)
                    out[at + (i % channels)] += data[i] * share;
        }
    }
    return { width, height, channels, data: out };
}

/// |a - b| / (|a| + |b|), the mean of the three channels, 0 where both are 0.
function smape_picture(a, b) {
    const data = new Float32Array(a.width * a.height);
    for (let i = 0; i < data.length * 3; ++i) {
        const sum = Math.abs(a.data[i]) + Math.abs(b.data[i]);
        if (sum > 0) data[Math.trunc(i / 3)] += Math.abs(a.data[i] - b.data[i]) / sum / 3;
    }
    return { width: a.width, height: a.height, channels: 1, data };
}

function error_picture(method, quantity) {
    return made_once(`error ${quantity} ${method.name}`, () => {
        const picture = method_picture(method, quantity);
        const reference = reference_picture(method.domain, quantity);
        if (!picture || !reference) return null;
        return smape_picture(picture, resized(reference, picture.width, picture.height));
    });
}

/// The direction of the position (u, v), and back; the footer has the mapping in words.
function direction_of(u, v) {
    const theta = Math.PI * (2 * u - 1);
    const phi = Math.PI * v;
    return [Math.sin(phi) * Math.sin(theta), Math.cos(phi), -Math.sin(phi) * Math.cos(theta)];
}
function position_of([x, y, z]) {
    return [(1 + Math.atan2(x, -z) / Math.PI) / 2, Math.acos(Math.max(-1, Math.min(1, y))) / Math.PI];
}
