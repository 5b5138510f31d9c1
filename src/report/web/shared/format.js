// Values as text.

export const capitalised = (text) => text[0].toUpperCase() + text.slice(1);

/// Three significant digits, or a dash.
export function figure_text(value) {
    if (!Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    if (size === 0) return "0";
    if (size >= 1e6 || size < 1e-4)
        return value.toExponential(1).replace("e-", "e−").replace("e+", "e").replace(/^-/, "−");
    if (size >= 1000) return count_text(Math.round(value));
    return value.toPrecision(3).replace(/^-/, "−");
}

/// A share in per cent, without the sign.
export function share_text(value) {
    if (!Number.isFinite(value)) return "–";
    if (value === 0) return "0";
    if (value < 0.001) return "< 0.1";
    return value < 10 ? (value * 100).toFixed(1) : count_text(Math.round(value * 100));
}

export const signed_text = (value, digits) => (value < 0 ? "−" : "+") + Math.abs(value).toFixed(digits);

export const vector_text = (values, digits = 2) => values.map((x) => x.toFixed(digits).replace("-", "−")).join("  ");

/// A count, in groups of three digits.
export const count_text = (value) => (Number.isFinite(value) ? value.toLocaleString("en").replaceAll(",", "\u202f") : "–");

export const percent_text = (share) => (Number.isFinite(share) ? `${share_text(share)} %` : "–");
