// Shader code of a bake: the functions of decode.STORAGE with names of their own, and the sampling of its textures.

/// Formats whose bytes the shader decodes: they are filtered after decoding.
export const decodedFormats = new Set(["rgbe8", "rgbm8", "logluv32"]);

/// Gives every struct and function that a text declares the prefix "lobelia_", so that it fits into any shader.
export function withOwnNames(text) {
    const names = new Set();
    for (const line of text.split("\n")) {
        const found = line.match(/^(?:struct|fn)\s+(\w+)/) ?? line.match(/^(?:\w+)\s+(\w+)\s*\(/) ?? line.match(/^const\s+(?:\w+\s+)?(\w+)/);
        if (found) names.add(found[1]);
    }
    return text.replace(/\/\/.*$|\b\w+\b/gm, (word) => (names.has(word) ? `lobelia_${word}` : word));
}

/// The textures of one storage on a page, in the order of bake.json, with the sampler that holds each.
///   entries: of layout.pages[].textures[]; files: for each file { isArray, first }, `first` its first sampler.
export function samplersOf(entries, files) {
    return entries.map((entry) => {
        const file = files.get(entry.file), layer = entry.layer ?? 0;
        return {
            name: entry.name,
            scale: entry.scale,
            decoded: decodedFormats.has(entry.format),
            sampler: file.first + (file.isArray ? 0 : layer),
            layer: file.isArray ? layer : null,
        };
    });
}

const literal = (value) => (Number.isInteger(value) ? `${value}.0` : `${value}`);

/// GLSL ES 3.00: uniforms, the functions, and
///   vec3 lobelia_irradiance_at(vec2 uv, vec3 normal, vec3 smoothNormal)       E [W/m^2], directions in the world
///   vec3 lobelia_radiance_at(vec2 uv, vec3 direction, vec3 smoothNormal)      if the code has radiance()
/// kinds: for each sampler "2d" or "array".
export function glslOf(code, samplers, kinds, isTangent) {
    const fetch = ({ sampler, layer }, at) =>
        layer === null ? `texelFetch(lobelia_texture${sampler}, ${at}, 0)` : `texelFetch(lobelia_texture${sampler}, ivec3(${at}, ${layer}), 0)`;
    const sample = ({ sampler, layer }) =>
        layer === null ? `texture(lobelia_texture${sampler}, uv)` : `texture(lobelia_texture${sampler}, vec3(uv, ${layer}.0))`;
    const uniforms = kinds.map((kind, i) => `uniform highp ${kind === "array" ? "sampler2DArray" : "sampler2D"} lobelia_texture${i};`);
    const members = samplers.map((s) =>
        s.decoded
            ? `    t.${s.name} = ${fetch(s, "at")};\n    t.${s.name}_scale = ${literal(s.scale)};`
            : `    t.${s.name} = ${s.scale === 1 ? "" : `${literal(s.scale)} * `}${sample(s)};`);
    const light = samplers.some((s) => s.decoded)
        ? `lobelia_Coefficients lobelia_light_of(ivec2 at, ivec2 size) {
    at = clamp(at, ivec2(0), size - 1);
    lobelia_Texel t;
${members.join("\n")}
    return lobelia_unpack(t);
}
lobelia_Coefficients lobelia_light_at(vec2 uv) {
    ivec2 size = textureSize(lobelia_texture0, 0).xy;
    vec2 place = uv * vec2(size) - 0.5;
    ivec2 at = ivec2(floor(place));
    vec2 f = place - floor(place);
    lobelia_Coefficients a = lobelia_light_of(at, size), b = lobelia_light_of(at + ivec2(1, 0), size);
    lobelia_Coefficients c = lobelia_light_of(at + ivec2(0, 1), size), d = lobelia_light_of(at + ivec2(1, 1), size);
    for (int i = 0; i < a.c.length(); i++) a.c[i] = mix(mix(a.c[i], b.c[i], f.x), mix(c.c[i], d.c[i], f.x), f.y);
    return a;
}`
        : `lobelia_Coefficients lobelia_light_at(vec2 uv) {
    lobelia_Texel t;
${members.join("\n")}
    return lobelia_unpack(t);
}`;
    const own = withOwnNames(code);
    const local = (direction) => (isTangent ? `lobelia_to_tangent(smoothNormal, ${direction})` : direction);
    const radiance = own.includes("lobelia_radiance(")
        ? `vec3 lobelia_radiance_at(vec2 uv, vec3 direction, vec3 smoothNormal) {
    return max(lobelia_radiance(lobelia_light_at(uv), ${local("direction")}), vec3(0.0));
}`
        : "";
    return `${uniforms.join("\n")}
${own}
${light}
vec3 lobelia_irradiance_at(vec2 uv, vec3 normal, vec3 smoothNormal) {
    return lobelia_irradiance(lobelia_light_at(uv), ${local("normal")});
}
${radiance}
`;
}

/// WGSL: the functions, and the signature of one that takes sampled values:
///   fn lobelia_irradiance_of(NAME: vec4f, ..., normal: vec3f, smoothNormal: vec3f) -> vec3f
/// Errors: formats that only the shader decodes, which would need four reads.
export function wgslOf(code, samplers, isTangent) {
    if (samplers.some((s) => s.decoded)) return null;
    const parameters = samplers.map((s) => `texel_${s.name}: vec4<f32>`).join(", ");
    const members = samplers.map((s) => `    t.${s.name} = ${literal(s.scale)} * texel_${s.name};`).join("\n");
    const normal = isTangent ? "lobelia_to_tangent(smoothNormal, normal)" : "normal";
    return {
        functions: withOwnNames(code),
        entry: `fn lobelia_irradiance_of(${parameters}, normal: vec3<f32>, smoothNormal: vec3<f32>) -> vec3<f32> {
    var t: lobelia_Texel;
${members}
    return lobelia_irradiance(lobelia_unpack(t), ${normal});
}`,
    };
}
