// Methods in order: families, the best of each basis, representatives for the pictures.

/// The quantities of a report: its stored pictures, and the figures that measure a method by it.
export const quantities = {
    radiance: { title: "Radiance", stored: "radiance", rms: "radiance_rms", smape: "radiance_smape" },
    irradiance: {
        title: "Irradiance / π",
        stored: "irradiance_over_pi",
        rms: "irradiance_over_pi_rms",
        smape: "irradiance_smape",
    },
};

/// A figure for ordering: missing figures and NaN come last.
export const figure_or_last = (method, key) => (Number.isFinite(method[key]) ? method[key] : Infinity);

/// The mean over channels of the environment's mean radiance, which is the mean of E/π, too; NaN if it is not known.
export function mean_value(report) {
    const mean = report.environment?.mean_radiance ?? [];
    return mean.length === 3 ? (mean[0] + mean[1] + mean[2]) / 3 : NaN;
}

/// A method's RMS error of a quantity as a share of the mean; NaN if the mean is not known.
export const relative_error = (method, quantity, mean) => (mean > 0 ? method[quantities[quantity].rms] / mean : NaN);

/// A function that gives the family of a method. Bases whose names differ in numbers only (their size) are one family; a
/// family of one basis has the basis's name.
export function family_finder(methods) {
    const stem = (basis) => basis.replace(/\d+/g, "");
    const bases_of_stem = new Map();
    for (const { basis } of methods)
        bases_of_stem.set(stem(basis), (bases_of_stem.get(stem(basis)) ?? new Set()).add(basis));
    return ({ basis }) => (bases_of_stem.get(stem(basis)).size > 1 && stem(basis) ? stem(basis) : basis);
}

/// The first part of the name that tells methods apart.
export const main_axis_of = (methods) =>
    ["basis", "encoder", "evaluator"].find((axis) => methods.some((method) => method[axis] !== methods[0][axis])) ??
    "basis";

/// The method of the least irradiance error for each basis, in the given order.
export function best_of_bases(methods) {
    const best = new Map();
    const error = (method) => figure_or_last(method, quantities.irradiance.rms);
    for (const method of methods) {
        const known = best.get(method.basis);
        if (!known || error(method) < error(known)) best.set(method.basis, method);
    }
    return methods.filter((method) => best.get(method.basis) === method);
}

/// The methods that no smaller or equal one beats in irradiance, in order of size.
export function irradiance_front(candidates) {
    const error = (method) => figure_or_last(method, quantities.irradiance.rms);
    const by_size = [...candidates].sort((a, b) => a.floats - b.floats || error(a) - error(b));
    let least = Infinity;
    return by_size.filter((method) => {
        const better = error(method) < least;
        least = Math.min(least, error(method));
        return better;
    });
}

/// At most `most` entries of a list, spread evenly from its first to its last.
export function spread_over(list, most) {
    const count = Math.min(list.length, most);
    return Array.from({ length: count }, (_, i) => list[Math.round((i * (list.length - 1)) / (count - 1 || 1))]);
}

/// Some of the irradiance front, and the method of the least radiance error; at most `most`, in order of size.
export function representatives_of(candidates, most) {
    if (!candidates.length) return [];
    const radiance_error = (method) => figure_or_last(method, quantities.radiance.rms);
    const sharpest = candidates.reduce((best, method) => (radiance_error(method) < radiance_error(best) ? method : best));
    const front = spread_over(irradiance_front(candidates), most - 1);
    return [...new Set([...front, sharpest])].sort((a, b) => a.floats - b.floats);
}

/// The methods of the first pictures: all if they are few, else representatives of each domain.
export function representative_methods(methods, domains) {
    const few = 12;
    if (methods.length <= few) return [...methods];
    return domains.flatMap((domain) =>
        representatives_of(
            methods.filter((method) => method.domain === domain),
            domains.length > 1 ? 5 : 7,
        ),
    );
}

/// True if every word of the text is part of the name.
export const name_matches = (name, text) =>
    text
        .toLowerCase()
        .split(/\s+/)
        .every((word) => name.toLowerCase().includes(word));

/// The entries with the least finite value; none if so many share it that it says nothing.
export function winners_of(entries, value) {
    const least = Math.min(...entries.map(value).filter(Number.isFinite));
    const winners = entries.filter((entry) => value(entry) === least);
    return entries.length < 2 || winners.length > Math.max(1, entries.length / 4) ? [] : winners;
}
