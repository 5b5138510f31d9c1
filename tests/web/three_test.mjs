// The three.js package in headless Chromium: pictures of bakes against `lobelia render` of the same camera, every storage
// that three.js can hold, and bad bakes.
//   node tests/web/three_test.mjs LOBELIA [FOLDER]
// With FOLDER the pictures stay there, as PNG. Exit code 77 if Chromium, playwright-core or three is not installed.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { launch, skip } from "./chromium.mjs";
import { serve } from "./server.mjs";

const [, , lobelia, kept] = process.argv;
const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
const three = join(root, "tools/node_modules/three");
if (!existsSync(three)) skip("no three: npm ci --prefix tools");
const work = mkdtempSync(join(tmpdir(), "lobelia-three-"));
const run = (...args) => execFileSync(lobelia, args, { cwd: work, stdio: ["ignore", "ignore", "pipe"] });
if (kept) mkdirSync(kept, { recursive: true });

const width = 240, height = 160, side = 4; // side x side samples in a pixel
const bake = (scene, folder, ...options) => run("bake", scene, "--size", "256x256", "--samples", "32", "--no-report", ...options, "-o", folder);
const render = (folder, picture, camera = "0") => run("render", folder, "--size", `${width}x${height}`, "--samples", "256", "--camera", camera, "-o", picture);

/// Writes an embedded scene without specular layers, which three.js and Lobelia model differently.
function matt(scene, name) {
    run("scene", scene, "-o", name);
    const bytes = readFileSync(join(work, name)), length = bytes.readUInt32LE(12);
    const json = JSON.parse(bytes.subarray(20, 20 + length));
    for (const material of json.materials) (material.extensions ??= {}).KHR_materials_specular = { specularFactor: 0 };
    json.extensionsUsed = [...new Set([...(json.extensionsUsed ?? []), "KHR_materials_specular"])];
    let text = Buffer.from(JSON.stringify(json));
    text = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, " ")]);
    const head = Buffer.from(bytes.subarray(0, 20)), rest = bytes.subarray(20 + length);
    head.writeUInt32LE(20 + text.length + rest.length, 8);
    head.writeUInt32LE(text.length, 12);
    writeFileSync(join(work, name), Buffer.concat([head, text, rest]));
}

writeFileSync(join(work, "page.html"), `<!doctype html><title>three</title><link rel="icon" href="data:,">
<script type="importmap">{"imports": {"three": "/three/build/three.module.js", "three/webgpu": "/three/build/three.webgpu.js",
"three/tsl": "/three/build/three.tsl.js", "three/addons/": "/three/examples/jsm/", "lobelia-three": "/package/src/index.js",
"lobelia-three/webgpu": "/package/src/webgpu.js"}}</script>
<script type="module">
import * as THREE from "three";
import { EXRLoader } from "three/addons/loaders/EXRLoader.js";
import { loadBake, lightMaterial } from "lobelia-three";

/// Linear radiance of a picture file, rows from the bottom as WebGL has them.
async function reference(url) {
    const loader = new EXRLoader().setDataType(THREE.FloatType);
    const texture = await loader.loadAsync(url);
    return texture.image.data;
}

function averaged(pixels, width, height, side) {
    const out = new Float32Array(4 * width * height);
    for (let y = 0; y < height * side; ++y)
        for (let x = 0; x < width * side; ++x)
            for (let k = 0; k < 4; ++k)
                out[4 * (Math.floor(y / side) * width + Math.floor(x / side)) + k] += pixels[4 * (y * width * side + x) + k] / (side * side);
    return out;
}

/// PSNR in linear radiance over the pixels that lit surfaces cover wholly: what has no lightmap, such as the back of a
/// two-sided surface, \`lobelia render\` path traces. Lamps would set the peak: both pictures are cut at the reference's 98th percentile, which is the peak.
function psnr(picture, expected, lit) {
    const counts = (i) => i % 4 !== 3 && lit[i - (i % 4)] > 0.999;
    const values = [...expected].filter((_, i) => counts(i));
    const peak = values.sort((a, b) => a - b)[Math.floor(0.98 * values.length)];
    let sum = 0, count = 0;
    for (let i = 0; i < expected.length; ++i) {
        if (!counts(i)) continue;
        sum += (Math.min(picture[i], peak) - Math.min(expected[i], peak)) ** 2;
        ++count;
    }
    return { psnr: 10 * Math.log10(peak * peak / (sum / count)), share: (4 * count) / (3 * expected.length) };
}

const png = (pixels, width, height, peak) => {
    const canvas = Object.assign(document.createElement("canvas"), { width, height }), context = canvas.getContext("2d");
    const image = context.createImageData(width, height);
    for (let y = 0; y < height; ++y)
        for (let x = 0; x < width; ++x)
            for (let k = 0; k < 4; ++k)
                image.data[4 * (y * width + x) + k] = k === 3 ? 255 : 255 * Math.pow(Math.min(Math.max(pixels[4 * ((height - 1 - y) * width + x) + k] / peak, 0), 1), 1 / 2.2);
    context.putImageData(image, 0, 0);
    return canvas.toDataURL("image/png").split(",")[1];
};

window.draw = async ({ url, storage, picture, width, height, side, spoil }) => {
    const renderer = new THREE.WebGLRenderer();
    renderer.toneMapping = THREE.NoToneMapping;
    const bake = await loadBake(url, { storage, light: false });
    if (spoil) for (const light of bake.lights) light.glsl = light.glsl.replace(...spoil);
    bake.light((material, light) => lightMaterial(material, light));
    const camera = bake.cameras[0];
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    const target = new THREE.WebGLRenderTarget(width * side, height * side, { type: THREE.FloatType, colorSpace: THREE.LinearSRGBColorSpace });
    renderer.setRenderTarget(target);
    renderer.setClearColor(0x000000, 0);
    bake.scene.updateMatrixWorld(true);
    const pixels = () => {
        renderer.render(bake.scene, camera);
        const all = new Float32Array(4 * width * height * side * side);
        renderer.readRenderTargetPixels(target, 0, 0, width * side, height * side, all);
        return averaged(all, width, height, side);
    };
    const drawn = pixels(), expected = await reference(picture);
    bake.scene.background = null;
    // The sides that have light: a bake holds it for front faces.
    const sides = (shade, side) => new THREE.ShaderMaterial({
        side,
        vertexShader: "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
        fragmentShader: \`void main() { gl_FragColor = vec4(vec3(gl_FrontFacing ? \${shade} : 0.0), 1.0); }\`,
    });
    bake.scene.traverse((mesh) => mesh.isMesh && (mesh.material = sides("0.0", mesh.material.side)));
    bake.eachLit((mesh) => (mesh.material = sides("1.0", mesh.material.side)));
    const lit = pixels();
    const peak = 1.5 * [...drawn].sort((a, b) => a - b)[Math.floor(0.9 * drawn.length)] || 1;
    const result = { ...psnr(drawn, expected, lit), drawn: png(drawn, width, height, peak), expected: png(expected, width, height, peak) };
    target.dispose();
    bake.dispose();
    renderer.dispose();
    renderer.forceContextLoss();
    return result;
};
/// The same by WebGPURenderer; null where the browser has no WebGPU.
window.drawByWebGPU = async ({ url, storage, picture, width, height, side }) => {
    if (!(await navigator.gpu?.requestAdapter())) return null;
    const { WebGPURenderer } = await import("three/webgpu");
    const { lightNodeMaterial } = await import("lobelia-three/webgpu");
    const renderer = new WebGPURenderer();
    await renderer.init();
    renderer.toneMapping = THREE.NoToneMapping;
    const bake = await loadBake(url, { storage, light: false });
    bake.light(lightNodeMaterial);
    const camera = bake.cameras[0];
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    const target = new THREE.RenderTarget(width * side, height * side, { type: THREE.FloatType, colorSpace: THREE.LinearSRGBColorSpace });
    renderer.setRenderTarget(target);
    renderer.render(bake.scene, camera);
    const top = await renderer.readRenderTargetPixelsAsync(target, 0, 0, width * side, height * side);
    // Rows from the top, which WebGL has from the bottom.
    const pixels = new Float32Array(top.length), row = 4 * width * side;
    for (let y = 0; y < height * side; ++y) pixels.set(top.subarray(y * row, (y + 1) * row), (height * side - 1 - y) * row);
    const drawn = averaged(pixels, width, height, side), expected = await reference(picture);
    const result = psnr(drawn, expected, drawn.map(() => 1));
    const peak = 1.5 * [...drawn].sort((a, b) => a - b)[Math.floor(0.9 * drawn.length)] || 1;
    return { ...result, drawn: png(drawn, width, height, peak) };
};
window.refused = async (url, options) => {
    try {
        await loadBake(url, options);
        return "loaded";
    } catch (error) {
        return error.name + ": " + error.message;
    }
};
window.probe = async (url, [x, y, z]) => {
    const bake = await loadBake(url);
    return [...bake.probes.at(new THREE.Vector3(x, y, z))];
};
window.ready = true;
</script>`);

const server = await serve({ "/three/": three, "/package/": join(root, "web/three"), "/": work });
const browser = await launch(["--enable-unsafe-webgpu", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]);
const page = await browser.newPage();
page.setDefaultTimeout(240_000);
const errors = [];
// Drivers say that reading pixels takes time.
page.on("console", (message) => ["error", "warning"].includes(message.type()) && !message.text().includes("GL Driver Message") && errors.push(message.text()));
page.on("pageerror", (error) => errors.push(String(error)));
await page.goto(`${server.url}/page.html`);
await page.waitForFunction(() => window.ready, null, { timeout: 60_000 });

async function compared(name, url, picture, options = {}) {
    const { storage, spoil } = options;
    const result = await page.evaluate((job) => window.draw(job), { url, storage, picture, width, height, side, spoil });
    if (kept && !spoil) {
        writeFileSync(join(kept, `${name}-three.png`), Buffer.from(result.drawn, "base64"));
        writeFileSync(join(kept, `${name}-render.png`), Buffer.from(result.expected, "base64"));
    }
    return result;
}
const rows = [];
async function held(name, folder, options) {
    const { psnr, share } = await compared(name, `/${folder}`, `/${folder}.exr`, options);
    rows.push([name, psnr, share]);
    assert.ok(psnr > 40 && share > 0.3, `${name}: PSNR ${psnr.toFixed(1)} dB over ${(100 * share).toFixed(0)} % of the pixels`);
}

try {
    // The same model: cornell is matt. A codec in the world's frame and one in the tangent frame.
    bake("cornell", "cornell", "--storage", "float16", "--storage", "ratio8", "--storage", "ycocg");
    render("cornell", "cornell.exr");
    await held("cornell", "cornell");
    await held("cornell-ratio8", "cornell", { storage: "ratio8" });
    await held("cornell-ycocg", "cornell", { storage: "ycocg" });
    bake("cornell", "tangent", "--codec", "ahd/moments/punctual", "--storage", "float16", "--zstd");
    render("tangent", "tangent.exr");
    await held("cornell-ahd-zstd", "tangent");
    bake("cornell", "lobes", "--codec", "sg12/nnls/odd-exact-2", ...["rgb9e5", "rgbe", "logluv"].flatMap((s) => ["--storage", s]));
    render("lobes", "lobes.exr");
    for (const storage of ["rgb9e5", "rgbe", "logluv"]) await held(`cornell-sg12-${storage}`, "lobes", { storage });
    matt("colonnade", "colonnade.glb");
    bake("colonnade.glb", "colonnade", "--env", "sky", "--storage", "float16");
    render("colonnade", "colonnade.exr");
    await held("colonnade", "colonnade");

    // WebGPURenderer draws the same; the lamp's edges count here.
    const gpu = await page.evaluate((job) => window.drawByWebGPU(job), { url: "/cornell", picture: "/cornell.exr", width, height, side });
    if (gpu && kept) writeFileSync(join(kept, "cornell-webgpu.png"), Buffer.from(gpu.drawn, "base64"));
    if (gpu) rows.push(["cornell by WebGPURenderer", gpu.psnr, gpu.share]);
    else console.log("WebGPURenderer: skipped, this Chromium has no WebGPU");
    assert.ok(!gpu || gpu.psnr > 40, `WebGPURenderer: PSNR ${gpu?.psnr} dB`);

    // A wrong sign in the shader code is seen.
    const spoiled = await compared("spoiled", "/cornell", "/cornell.exr", { spoil: ["n.y", "(-n.y)"] });
    rows.push(["cornell, a wrong sign", spoiled.psnr, spoiled.share]);
    assert.ok(!(spoiled.psnr > 35), `a wrong sign gives ${spoiled.psnr} dB`);
    assert.deepEqual(errors, []);

    // lobelia view: a folder that shows itself.
    run("view", "colonnade", "--three", three, "-o", "view");
    await page.goto(`${server.url}/view/index.html`);
    await page.waitForFunction(() => document.body.dataset.shown, null, { timeout: 120_000 });
    assert.deepEqual(errors, []);
    if (kept) await page.screenshot({ path: join(kept, "view.png") });
    assert.equal(await page.textContent("#message"), "colonnade, sh2/moments/convolution\nDrag to look around.");
    await page.goto(`${server.url}/view/index.html?bake=../nothing`);
    await page.waitForFunction(() => document.getElementById("message").textContent.includes("404"));
    errors.length = 0;
    await page.goto(`${server.url}/page.html`);
    await page.waitForFunction(() => window.ready);

    // Bad bakes are refused with the file and the reason.
    const refused = (url, options) => page.evaluate(([u, o]) => window.refused(u, o), [url, options]);
    assert.match(await refused("/nothing"), /BakeError: .*\/nothing\/bake.json: 404/);
    assert.match(await refused("/cornell", { storage: "float17" }), /no textures in the storage "float17"; it has float16, ratio8, ycocg/);
    const broken = (name, change) => {
        cpSync(join(work, "cornell"), join(work, name), { recursive: true });
        change(join(work, name));
    };
    broken("later", (folder) => {
        const file = join(folder, "bake.json");
        writeFileSync(file, readFileSync(file, "utf8").replace('"lobelia_bake": 3', '"lobelia_bake": 4'));
    });
    assert.match(await refused("/later"), /version 4, but this loader reads versions 2 to 3/);
    broken("cut", (folder) => writeFileSync(join(folder, "page-0.float16.rgba16f.ktx2"), "KTX"));
    assert.match(await refused("/cut"), /page-0.float16.rgba16f.ktx2: not a KTX 2.0 file/);
    broken("text", (folder) => writeFileSync(join(folder, "bake.json"), "{"));
    assert.match(await refused("/text"), /bake.json: not JSON/);

    // Probes: on a probe of the grid, its own coefficients.
    bake("cornell", "probes", "--storage", "float16", "--probes", "0.2,0.2,-0.4,0.8,0.8,0.2", "--probe-spacing", "0.3");
    const probes = JSON.parse(readFileSync(join(work, "probes/probes.json"))), bytes = readFileSync(join(work, "probes/probes.bin"));
    const valid = probes.validity.findIndex((v) => v > 0.99), [nx, ny] = probes.grid.count;
    const steps = [valid % nx, Math.floor(valid / nx) % ny, Math.floor(valid / nx / ny)];
    const found = await page.evaluate(([url, at]) => window.probe(url, at), ["/probes", steps.map((s, k) => probes.grid.origin[k] + s * probes.grid.spacing[k])]);
    found.forEach((value, i) => assert.ok(Math.abs(value - bytes.readFloatLE(4 * (found.length * valid + i))) < 1e-4 + 1e-3 * Math.abs(value), `coefficient ${i}`));
    for (const [name, value, share] of rows) console.log(`${name.padEnd(28)} ${value.toFixed(1)} dB over ${(100 * share).toFixed(0)} % of the pixels`);
} finally {
    await browser.close();
    server.close();
    rmSync(work, { recursive: true });
}
