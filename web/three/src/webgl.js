// Materials of WebGLRenderer lit by lightmaps.

/// What a material reads at TEXCOORD_1, as code of GLSL and textures: made by Bake.light().
///   light: { glsl, textures }
///
/// The material's irradiance becomes the lightmap's at the mapped normal; its own lights still add to it. The material
/// must not have a lightMap of its own. Returns the material.
export function lightMaterial(material, light) {
    const before = material.onBeforeCompile;
    material.defines = { ...material.defines, USE_UV1: "" };
    material.onBeforeCompile = (shader, renderer) => {
        before?.call(material, shader, renderer);
        light.textures.forEach((texture, i) => (shader.uniforms[`lobelia_texture${i}`] = { value: texture }));
        shader.vertexShader = shader.vertexShader
            .replace("#include <uv_pars_vertex>", "#include <uv_pars_vertex>\nvarying vec2 lobelia_uv;")
            .replace("#include <uv_vertex>", "#include <uv_vertex>\n\tlobelia_uv = uv1;");
        shader.fragmentShader = shader.fragmentShader
            .replace("#include <lightmap_pars_fragment>", `#include <lightmap_pars_fragment>\nvarying vec2 lobelia_uv;\n${light.glsl}`)
            .replace("#include <lights_fragment_maps>", `#include <lights_fragment_maps>
	vec3 lobelia_normal = inverseTransformDirection(geometryNormal, viewMatrix);
	vec3 lobelia_smooth_normal = inverseTransformDirection(nonPerturbedNormal, viewMatrix);
	irradiance += lobelia_irradiance_at(lobelia_uv, lobelia_normal, lobelia_smooth_normal);`);
    };
    // Materials with the same code share a program; the textures are uniforms.
    const key = material.customProgramCacheKey;
    material.customProgramCacheKey = () => `${key?.call(material) ?? ""}|lobelia|${light.glsl}`;
    material.needsUpdate = true;
    return material;
}
