// Lobelia's bakes in three.js: see README.md.
export { loadBake, BakeError } from "./bake.js";
export { lightMaterial } from "./webgl.js";
export { ProbeVolume } from "./probes.js";
