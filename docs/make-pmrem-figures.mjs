// Measures three.js' PMREMGenerator against the exact sums of `lobelia prefilter`, at the centres of its texels.
//   node docs/make-pmrem-figures.mjs LOBELIA ENVIRONMENT.hdr
// Prints a table for docs/prefilter.md. Needs Chromium, playwright-core and three (npm ci --prefix tools).
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { launch } from "../tests/web/chromium.mjs";
import { serve } from "../tests/web/server.mjs";

const [, , lobelia, environment] = process.argv;
const root = join(dirname(fileURLToPath(import.meta.url)), "..");
const work = mkdtempSync(join(tmpdir(), "lobelia-pmrem-"));
execFileSync(lobelia, ["prefilter", environment, "--size", "256", "--levels", "6", "--format", "rgba32f", "-o", join(work, "probe")], { stdio: "ignore" });
copyFileSync(environment, join(work, "environment.hdr"));
writeFileSync(join(work, "page.html"), `<!doctype html><title>pmrem</title><link rel="icon" href="data:,">
<script type="importmap">{"imports": {"three": "/three/build/three.module.js", "three/addons/": "/three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from "three";
import { HDRLoader } from "three/addons/loaders/HDRLoader.js";
import { read } from "three/addons/libs/ktx-parse.module.js";
window.measure = async (levels) => {
    const renderer = new THREE.WebGLRenderer();
    const equirect = await new HDRLoader().setDataType(THREE.FloatType).loadAsync("environment.hdr");
    equirect.mapping = THREE.EquirectangularReflectionMapping;
    const map = new THREE.PMREMGenerator(renderer).fromEquirectangular(equirect).texture;
    const maxLod = map.mipmaps.length - 1; // a cube map with Filament's levels
    const file = read(new Uint8Array(await (await fetch("probe/specular.ktx2")).arrayBuffer()));
    const places = [(s, t) => [1, -t, -s], (s, t) => [-1, -t, s], (s, t) => [s, 1, t], (s, t) => [s, -1, -t], (s, t) => [s, -t, 1], (s, t) => [-s, -t, -1]];
    return levels.map(({ size, roughness }, level) => {
        const count = 6 * size * size, directions = new Float32Array(4 * count);
        for (let i = 0; i < count; ++i) {
            const at = (k) => (2 * (k + 0.5)) / size - 1;
            const [x, y, z] = places[Math.floor(i / (size * size))](at(i % size), at(Math.floor(i / size) % size));
            // The centre of the image is -z there and +x in three.js.
            directions.set([-z, y, x, 0], 4 * i);
        }
        const input = new THREE.DataTexture(directions, size, 6 * size, THREE.RGBAFormat, THREE.FloatType);
        input.needsUpdate = true;
        const target = new THREE.WebGLRenderTarget(size, 6 * size, { type: THREE.FloatType });
        const material = new THREE.ShaderMaterial({
            glslVersion: THREE.GLSL3,
            uniforms: { map: { value: map }, input_w: { value: input }, lod: { value: maxLod * roughness * (2 - roughness) } },
            vertexShader: "void main() { gl_Position = vec4(position, 1.0); }",
            fragmentShader: "uniform samplerCube map;\\nuniform sampler2D input_w;\\nuniform float lod;\\nout vec4 result;\\nvoid main() { result = textureLod(map, normalize(texelFetch(input_w, ivec2(gl_FragCoord.xy), 0).xyz), lod); }",
        });
        const scene = new THREE.Scene().add(new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material));
        renderer.setRenderTarget(target);
        renderer.render(scene, new THREE.Camera());
        const found = new Float32Array(4 * count);
        renderer.readRenderTargetPixels(target, 0, 0, size, 6 * size, found);
        const data = file.levels[level].levelData, exact = new Float32Array(data.slice().buffer);
        let off = 0, all = 0;
        for (let i = 0; i < exact.length; ++i) {
            if (i % 4 === 3) continue;
            off += (found[i] - exact[i]) ** 2;
            all += exact[i] ** 2;
        }
        return Math.sqrt(off / all);
    });
};
window.ready = true;
</script>`);
const server = await serve({ "/three/": join(root, "tools/node_modules/three"), "/": work });
const browser = await launch(["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]);
try {
    const page = await browser.newPage();
    page.setDefaultTimeout(240_000);
    page.on("console", (message) => message.type() === "error" && console.error(message.text()));
    page.on("pageerror", (error) => console.error(String(error)));
    await page.goto(`${server.url}/page.html`);
    await page.waitForFunction(() => window.ready);
    const { levels } = JSON.parse(readFileSync(join(work, "probe/prefilter.json")));
    const errors = await page.evaluate((l) => window.measure(l), levels);
    levels.forEach(({ size, roughness }, i) => console.log(`| ${size} x ${size} | ${roughness} | ${errors[i].toFixed(4)} |`));
} finally {
    await browser.close();
    server.close();
    rmSync(work, { recursive: true });
}
