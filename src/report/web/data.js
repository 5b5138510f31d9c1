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
            domains.length > 1 ? 5 : 7,
        ),
    );
}

/// Of the methods that none of their size or smaller beats in irradiance, some from the smallest to the largest; and
/// the one of the least radiance error. In order of size.
function representatives_of(candidates, most) {
    const error = (method) => figure_or_last(method, quantities.irradiance.rms);
    const by_size = [...candidates].sort((a, b) => a.floats - b.floats || error(a) - error(b));
    let least = Infinity;
    const front = by_size.filter((method) => {
        const better = error(method) < least;
        least = Math.min(least, error(method));
        return better;
    });
    const radiance_error = (method) => figure_or_last(method, quantities.radiance.rms);
    const sharpest = by_size.reduce((best, method) => (radiance_error(method) < radiance_error(best) ? method : best));
    const count = Math.min(front.length, most - 1);
    const spread = Array.from({ length: count }, (_, i) => front[Math.round((i * (front.length - 1)) / (count - 1 || 1))]);
    return [...new Set([...spread, sharpest])].sort((a, b) => a.floats - b.floats);
}

// ---- Pictures: null where the report has none

function reference_picture(domain, quantity) {
    const { stored } = quantities[quantity];
    return made_once(`reference ${domain} ${quantity}`, () => decode(stored_pictures.references[domain]?.[stored]));
}

/// Radiance does not depend on how irradiance is evaluated, hence its shorter key.
function method_picture(method, quantity) {
    const key = quantity === "radiance" ? `${method.basis}/${method.encoder}` : method.name;
    return made_once(`${quantity} ${key}`, () => decode(stored_pictures[quantities[quantity].stored][key]));
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
