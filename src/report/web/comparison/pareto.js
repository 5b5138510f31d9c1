// Points of size and error: the front, and points of one size set apart.

/// The points that no other beats in both bytes and error, from small to large.
export function pareto_front(points) {
    const front = [];
    for (const point of [...points].sort((a, b) => a.bytes - b.bytes || a.y - b.y))
        if (!front.length || point.y < front.at(-1).y) front.push(point);
    return front;
}

/// Groups of one size would hide each other: they stand apart by 1 % of the size, all of them by no more than 8 %.
export function spread_apart(points, groups, group_of) {
    const spread = 1 + Math.min(0.01 * groups.length, 0.08);
    const apart = (point) => spread ** ((groups.indexOf(group_of(point)) + 0.5) / groups.length - 0.5);
    for (const point of points) point.x = point.bytes * apart(point);
}
