// Rows in order.

/// Compares for sorting; missing values come last in both orders.
export function compare_values(a, b, sign) {
    if (typeof a === "string") return sign * a.localeCompare(b, "en", { numeric: true });
    const missing_a = !Number.isFinite(a);
    const missing_b = !Number.isFinite(b);
    return missing_a || missing_b ? missing_a - missing_b : sign * (a - b);
}
