import type { Camera, Group, LightProbe, Material, Mesh, Scene, Texture, Vector3 } from "three";

/** A bake that cannot be shown; the message names the file and what to do. */
export class BakeError extends Error {}

/** Where one texture of a storage is: in which of the light's textures, and in which layer of it. */
export interface TexelSampler {
    name: string;
    scale: number;
    /** The shader decodes the bytes; they are not to be filtered. */
    decoded: boolean;
    sampler: number;
    layer: number | null;
}

/** The light of one page: textures, and shader code that evaluates them. */
export interface PageLight {
    readonly storage: string;
    readonly samplers: TexelSampler[];
    readonly textures: Texture[];
    /** GLSL ES 3.00: uniforms, and lobelia_irradiance_at(uv, normal, smoothNormal), E [W/m^2]. */
    readonly glsl: string;
    /** WGSL; null for storages whose bytes the shader decodes. */
    readonly wgsl: { functions: string; entry: string } | null;
}

export interface Bake {
    /** bake.json. */
    readonly manifest: any;
    readonly gltf: { scene: Group; cameras: Camera[] };
    readonly scene: Scene;
    readonly cameras: Camera[];
    readonly storage: string;
    /** By page. */
    readonly lights: PageLight[];
    readonly probes: ProbeVolume | null;
    /** Calls visit for each mesh that has a lightmap. */
    eachLit(visit: (mesh: Mesh, page: number) => void): void;
    /** Replaces each lit mesh's material by a copy that lightWith patches (default: for WebGLRenderer). */
    light(lightWith?: (material: Material, light: PageLight) => Material): void;
    /** Shows the environment that lit the scene as its background. */
    showEnvironment(): Promise<void>;
    dispose(): void;
}

export interface LoadOptions {
    /** One of the bake's storages; default: float16 if there is one, else the first. */
    storage?: string;
    /** false: leave the materials as they are. */
    light?: boolean;
    /** false: do not show the environment. */
    background?: boolean;
}

/** Loads a bake: the address of its folder or of its bake.json. Rejects with a BakeError. */
export function loadBake(url: string, options?: LoadOptions): Promise<Bake>;

/** Lights a material of WebGLRenderer: MeshStandardMaterial, MeshPhysicalMaterial, MeshLambertMaterial. */
export function lightMaterial<M extends Material>(material: M, light: PageLight): M;

/** Probes of a bake on a regular grid. */
export class ProbeVolume {
    readonly description: any;
    readonly coefficients: Float32Array;
    static load(url: string): Promise<ProbeVolume>;
    /** Coefficients at a place [m], 3 floats each; null where no probe around is valid. */
    at(position: Vector3): Float32Array | null;
    /** For spherical harmonics: a light probe to add to the scene. */
    lightProbe(position: Vector3): LightProbe;
}
