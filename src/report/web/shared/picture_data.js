// Pictures as numbers: decoded from half floats, and resized.

// A picture is { width, height, channels, data }, row by row.

/// The float of each of the 65536 halves.
const float_from_half = Float32Array.from({ length: 65536 }, (_, bits) => {
    const sign = bits & 0x8000 ? -1 : 1,
        exponent = (bits >> 10) & 31,
        mantissa = bits & 1023;
    if (exponent === 31) return mantissa ? NaN : sign * Infinity;
    return sign * (exponent ? (1024 + mantissa) * 2 ** (exponent - 25) : mantissa * 2 ** -24);
});

/// From base64 of 16-bit values: half floats, or whole numbers.
export function decode(stored) {
    const text = stored?.half ?? stored?.whole;
    if (!text) return null;
    const bytes = atob(text);
    const value_of = stored.half ? (bits) => float_from_half[bits] : (bits) => bits;
    const data = new Float32Array(bytes.length / 2);
    for (let i = 0; i < data.length; ++i)
        data[i] = value_of(bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8));
    return { width: stored.width, height: stored.height, channels: stored.channels ?? 3, data };
}

/// Returns the value of a key; calls `make` for it the first time only.
const made = new Map();
export function made_once(key, make) {
    if (!made.has(key)) made.set(key, make());
    return made.get(key);
}

/// `picture` at another size: each texel is the mean of those whose centres it holds, or else the nearest.
export function resized(picture, width, height) {
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

