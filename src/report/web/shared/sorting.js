// Rows in order.

/// What is missing comes last in both orders.
export function compare_values(a, b, sign) {
    if (typeof a === "string") return sign * a.localeCompare(b, "en", { numeric: true });
    const missing_a = !Number.isFinite(a);
    const missing_b = !Number.isFinite(b);
    return missing_a || missing_b ? missing_a - missing_b : sign * (a - b);
}
