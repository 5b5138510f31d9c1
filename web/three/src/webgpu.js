// Node materials of WebGPURenderer lit by lightmaps. Needs three/webgpu and three/tsl.
import { IrradianceNode, MeshPhysicalNodeMaterial, MeshStandardNodeMaterial } from "three/webgpu";
import { int, normalGeometry, normalWorld, normalWorldGeometry, texture, uv, wgsl, wgslFn } from "three/tsl";

import { BakeError } from "./errors.js";

/// Returns the node of irradiance [W/m^2] at the mapped normal. light: of Bake.light(), with WGSL.
export function irradianceNode(light) {
    if (!light.wgsl) throw new BakeError(`${light.storage}: its bytes are decoded by the shader, which node materials cannot do here; use another storage`);
    const at = uv(1);
    const texels = {};
    for (const { name, sampler, layer } of light.samplers) {
        const node = texture(light.textures[sampler], at);
        texels[`texel_${name}`] = layer === null ? node : node.depth(int(layer));
    }
    const evaluate = wgslFn(light.wgsl.entry, [wgsl(light.wgsl.functions)]);
    return evaluate({ ...texels, normal: normalWorld, smoothNormal: normalWorldGeometry ?? normalGeometry });
}

/// Returns a node material with the properties of a standard or a physical one; a node material itself.
function asNodeMaterial(material) {
    if (material.isNodeMaterial) return material;
    const copy = material.isMeshPhysicalMaterial ? new MeshPhysicalNodeMaterial() : new MeshStandardNodeMaterial();
    for (const key in material) if (key !== "type" && key !== "uuid" && !key.startsWith("is")) copy[key] = material[key];
    return copy;
}

/// Lights a material of WebGPURenderer. Returns the material, as a node material.
export function lightNodeMaterial(standard, light) {
    const material = asNodeMaterial(standard), node = irradianceNode(light);
    material.setupLightMap = () => new IrradianceNode(node);
    material.needsUpdate = true;
    return material;
}
