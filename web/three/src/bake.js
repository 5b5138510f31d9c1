// A bake's folder as a scene of three.js.
import * as THREE from "three";
import { EXRLoader } from "three/addons/loaders/EXRLoader.js";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

import { BakeError, fetched } from "./errors.js";
import { ProbeVolume } from "./probes.js";
import { decodedFormats, glslOf, samplersOf, wgslOf } from "./shader.js";
import { readTextures } from "./textures.js";
import { lightMaterial } from "./webgl.js";

export { BakeError };

const oldest = 2, newest = 3;

/// bake.json, checked as far as it is used here.
async function readManifest(url) {
    const text = await (await fetched(url)).text();
    let manifest;
    try {
        manifest = JSON.parse(text);
    } catch (error) {
        throw new BakeError(`${url}: not JSON (${error.message})`);
    }
    const version = manifest?.lobelia_bake;
    if (version === undefined) throw new BakeError(`${url}: not the bake.json of a bake`);
    if (!(version >= oldest && version <= newest))
        throw new BakeError(`${url}: version ${version}, but this loader reads versions ${oldest} to ${newest}`);
    if (!manifest.scene?.file) throw new BakeError(`${url}: the bake holds no copy of its scene`);
    if (!manifest.codec?.name) throw new BakeError(`${url}: a plain bake has no coefficients; use --export rgb and lightMap`);
    return manifest;
}

/// The light of one page in one storage.
class PageLight {
    constructor(storage, samplers, textures, glsl, wgsl) {
        Object.assign(this, { storage, samplers, textures, glsl, wgsl });
    }
}

class Bake {
    constructor(base, manifest, gltf, storage) {
        this.base = base;
        this.manifest = manifest;
        this.gltf = gltf;
        this.scene = new THREE.Scene().add(gltf.scene);
        this.cameras = gltf.cameras;
        this.storage = storage;
        /// The light of each page.
        this.lights = [];
        /// The probe volume, or null.
        this.probes = null;
    }

    url(file) {
        return new URL(file, this.base).href;
    }

    async readLights() {
        const code = async (extension) => (await fetched(this.url(`decode.${this.storage}.${extension}`))).text();
        const [glsl, wgsl] = await Promise.all([code("glsl"), code("wgsl")]);
        const isTangent = this.manifest.codec.frame === "tangent";
        for (const page of this.manifest.layout.pages) {
            const entries = page.textures.filter((entry) => entry.storage === this.storage);
            const names = [...new Set(entries.map((entry) => entry.file))];
            const read = await Promise.all(names.map((name) => {
                const { format } = entries.find((entry) => entry.file === name);
                return readTextures(this.url(name), decodedFormats.has(format));
            }));
            const files = new Map(), textures = [], kinds = [];
            read.forEach((file, i) => {
                files.set(names[i], { isArray: file.isArray, first: textures.length });
                textures.push(...file.textures);
                kinds.push(...file.textures.map(() => (file.isArray ? "array" : "2d")));
            });
            const samplers = samplersOf(entries, files);
            this.lights.push(new PageLight(this.storage, samplers, textures, glslOf(glsl, samplers, kinds, isTangent), wgslOf(wgsl, samplers, isTangent)));
        }
    }

    /// Calls `visit(mesh, page)` for each mesh that has a lightmap.
    eachLit(visit) {
        this.scene.traverse((node) => {
            const page = node.userData?.gltfExtensions?.LOBELIA_lightmap?.page ?? node.userData?.lobelia_lightmap?.page;
            if (page === undefined) return;
            node.traverse((mesh) => mesh.isMesh && visit(mesh, page));
        });
    }

    /// Lights the scene: replaces each lit mesh's material by a copy that `lightWith(copy, light)` patches; the default
    /// is for WebGLRenderer. Meshes of one material and page share the copy.
    light(lightWith = lightMaterial) {
        const copies = new Map();
        this.eachLit((mesh, page) => {
            const key = `${mesh.material.uuid} ${page}`;
            if (!copies.has(key)) copies.set(key, lightWith(mesh.material.clone(), this.lights[page]));
            mesh.material = copies.get(key);
        });
        // Baked light holds what these lamps give.
        this.scene.traverse((node) => node.isLight && (node.visible = false));
    }

    /// Shows the environment that lit the scene as the scene's background; does nothing if there was none.
    async showEnvironment() {
        const file = this.manifest.scene.environment;
        if (!file) return;
        const texture = await new EXRLoader().loadAsync(this.url(file));
        texture.mapping = THREE.EquirectangularReflectionMapping;
        this.scene.background = texture;
        // The centre of the image is -z here and +x in three.js.
        this.scene.backgroundRotation.y = Math.PI / 2;
    }

    dispose() {
        if (this.scene.background?.isTexture) this.scene.background.dispose();
        for (const light of this.lights) light.textures.forEach((texture) => texture.dispose());
    }
}

/// The storages of a bake that this loader shows.
const storagesOf = (manifest) => [...new Set(manifest.layout.pages.flatMap((page) => page.textures.map((entry) => entry.storage)))];

/// Loads a bake: `url` is its folder or its bake.json. Options:
///   storage     one of its storages (default: float16 if there is one, else the first)
///   light       false: do not light the scene's materials (call light() later, or light what you like with lights[])
///   background  false: do not show the environment
/// Errors: BakeError.
export async function loadBake(url, options = {}) {
    const page = globalThis.document?.baseURI ?? "http://localhost/";
    const address = new URL(/\.json(\?|$)/.test(url) ? url : url.replace(/\/?$/, "/bake.json"), page);
    const manifest = await readManifest(address.href);
    const storages = storagesOf(manifest);
    const storage = options.storage ?? (storages.includes("float16") ? "float16" : storages[0]);
    if (!storages.includes(storage))
        throw new BakeError(`${address.href}: no textures in the storage "${storage}"; it has ${storages.join(", ") || "none"}`);
    const base = new URL(".", address);
    const gltf = await new GLTFLoader().loadAsync(new URL(manifest.scene.file, base).href).catch((error) => {
        throw new BakeError(`${new URL(manifest.scene.file, base).href}: ${error.message}`);
    });
    const bake = new Bake(base, manifest, gltf, storage);
    await bake.readLights();
    if (manifest.probes) bake.probes = await ProbeVolume.load(bake.url(manifest.probes));
    if (options.light !== false) bake.light();
    if (options.background !== false) await bake.showEnvironment();
    return bake;
}
