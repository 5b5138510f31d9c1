import type { Material } from "three";
import type { Node, NodeMaterial } from "three/webgpu";
import type { PageLight } from "./index.js";

/** The node of irradiance E [W/m^2] at the mapped normal. */
export function irradianceNode(light: PageLight): Node;

/** Lights a material of WebGPURenderer; standard and physical materials become node materials. */
export function lightNodeMaterial(material: Material, light: PageLight): NodeMaterial;
