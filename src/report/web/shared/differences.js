// Differences of two pictures.

/// |a - b| / (|a| + |b|), the mean of the three channels, 0 where both are 0.
export function smape_picture(a, b) {
    const data = new Float32Array(a.width * a.height);
    for (let i = 0; i < data.length * 3; ++i) {
        const sum = Math.abs(a.data[i]) + Math.abs(b.data[i]);
        if (sum > 0) data[Math.trunc(i / 3)] += Math.abs(a.data[i] - b.data[i]) / sum / 3;
    }
    return { width: a.width, height: a.height, channels: 1, data };
}

/// (a - b) / (|a| + |b|): positive if the first is brighter; 0 if both are 0.
export function signed_difference(a, b) {
    const sum = Math.abs(a) + Math.abs(b);
    return sum > 0 ? (a - b) / sum : 0;
}

/// The signed differences of luminance between two pictures of one size, one channel.
export function signed_picture(a, b) {
    const data = new Float32Array(a.width * a.height);
    const y = ({ data: d }, i) => 0.2126 * d[3 * i] + 0.7152 * d[3 * i + 1] + 0.0722 * d[3 * i + 2];
    for (let i = 0; i < data.length; ++i) data[i] = signed_difference(y(a, i), y(b, i));
    return { width: a.width, height: a.height, channels: 1, data };
}

/// Figures of a picture against the reference, over all pixels and channels.
export function difference_figures(a, b) {
    let squares = 0,
        relative = 0,
        sum_a = 0,
        sum_b = 0;
    for (let i = 0; i < a.data.length; ++i) {
        const x = a.data[i],
            y = b.data[i],
            size = Math.abs(x) + Math.abs(y);
        squares += (x - y) ** 2;
        relative += size > 0 ? Math.abs(x - y) / size : 0;
        sum_a += x;
        sum_b += y;
    }
    const count = a.data.length;
    return {
        rms: Math.sqrt(squares / count) / (sum_b / count),
        relative: relative / count,
        bias: sum_a / sum_b - 1,
    };
}
