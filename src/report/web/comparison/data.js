// The report as its scripts use it: methods, pictures decoded from half floats, errors between pictures.

import { smape_picture } from "../shared/differences.js";
import { decode, made_once, resized } from "../shared/picture_data.js";
import { family_finder, main_axis_of, mean_value, quantities } from "./ranking.js";

export const report = JSON.parse(document.getElementById("report-data").textContent);
const stored_pictures = JSON.parse(document.getElementById("picture-data").textContent);
export const methods = report.methods ?? [];
export const method_by_name = new Map(methods.map((method) => [method.name, method]));
export const domains = [...new Set(methods.map((method) => method.domain))].sort().reverse(); // the sphere first

export const family_of = family_finder(methods);
export const main_axis = main_axis_of(methods);
export const mean = mean_value(report);

// ---- Pictures: null where the report has none

export function reference_picture(domain, quantity) {
    const { stored } = quantities[quantity];
    return made_once(`reference ${domain} ${quantity}`, () => decode(stored_pictures.references[domain]?.[stored]));
}

/// Radiance does not depend on how irradiance is evaluated, hence its shorter key.
export function method_picture(method, quantity) {
    const key = quantity === "radiance" ? `${method.basis}/${method.encoder}` : method.name;
    return made_once(`${quantity} ${key}`, () => decode(stored_pictures[quantities[quantity].stored][key]));
}

export function error_picture(method, quantity) {
    return made_once(`error ${quantity} ${method.name}`, () => {
        const picture = method_picture(method, quantity);
        const reference = reference_picture(method.domain, quantity);
        if (!picture || !reference) return null;
        return smape_picture(picture, resized(reference, picture.width, picture.height));
    });
}

