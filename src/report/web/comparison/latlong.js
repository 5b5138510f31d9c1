// Latitude-longitude pictures: directions of positions, samples, the visible points of a sphere.

/// The direction of the position (u, v), and back; the footer has the mapping in words.
export function direction_of(u, v) {
    const theta = Math.PI * (2 * u - 1);
    const phi = Math.PI * v;
    return [Math.sin(phi) * Math.sin(theta), Math.cos(phi), -Math.sin(phi) * Math.cos(theta)];
}

export function position_of([x, y, z]) {
    return [(1 + Math.atan2(x, -z) / Math.PI) / 2, Math.acos(Math.max(-1, Math.min(1, y))) / Math.PI];
}

/// The visible points of a sphere that fills `size` x `size` pixels, seen along -z without perspective: position (u, v)
/// of the normal, and the share of the pixel that the sphere covers.
export const sphere_points = (() => {
    const made = new Map();
    return (size) => {
        if (!made.has(size)) made.set(size, make_sphere_points(size));
        return made.get(size);
    };
})();

export function make_sphere_points(size) {
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
export function sample_picture({ width, height, channels, data }, u, v, out) {
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
