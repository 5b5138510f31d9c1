// Shader code in a browser: the WGSL and the GLSL ES of every basis, evaluator and storage compiles in Chromium, and that
// of every basis and evaluator gives the numbers of `lobelia eval`.
//   node tests/web/shader_test.mjs LOBELIA
// LOBELIA is the program. Exit code 77 if Chromium or playwright-core is not installed.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { launch } from "./chromium.mjs";

const [, , lobelia] = process.argv;
const browser = await launch(["--enable-unsafe-webgpu"]);
const work = mkdtempSync(join(tmpdir(), "lobelia-shaders-"));
writeFileSync(join(work, "page.html"), "<!doctype html><title>shaders</title>");

/// The code, or null for what has none: exit code 2.
function code(language, codec, ...options) {
    try {
        return execFileSync(lobelia, ["shader", codec, "--language", language, ...options], { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] });
    } catch (error) {
        assert.equal(error.status, 2, `${codec}: ${error}`);
        return null;
    }
}

/// Each basis with each evaluator once, and each storage with codecs that it may suit.
const codecs = execFileSync(lobelia, ["list"], { encoding: "utf8" }).trim().split("\n");
const parts = codecs.map((name) => name.split("/"));
const evaluators = codecs.filter((_, i) => parts.findIndex(([basis, , evaluator]) => basis === parts[i][0] && evaluator === parts[i][2]) === i);
/// Each basis once, and its specular evaluators.
const bases = parts.filter(([basis], i) => parts.findIndex((other) => other[0] === basis) === i);
const speculars = new Map();
const axes = execFileSync(lobelia, ["list", "--axes"], { encoding: "utf8" });
const section = axes.split(/^specular evaluators$/m)[1].split("\n").slice(1);
for (const line of section.slice(0, section.findIndex((text) => !text.startsWith("  ")))) {
    const [, name, list] = line.match(/^ {2}(\S+) +(.*)$/);
    for (const basis of list.split(", ")) speculars.set(basis, [...(speculars.get(basis) ?? []), name]);
}
const storages = ["float32", "float16", "ycocg", "rgb9e5", "rgbe", "rgbm", "logluv", "bc6h", "bc6h-signed", "ratio8", "ratio10", "bc6h-ratio8"];
function texts(language) {
    const list = evaluators.map((codec) => [codec, code(language, codec, "--need", "irradiance,radiance")]);
    list.push(["sh2 of probes", code(language, "sh2/moments/convolution", "--need", "irradiance,probes")]);
    for (const [basis, encoder, evaluator] of bases)
        for (const specular of speculars.get(basis) ?? []) {
            const codec = `${basis}/${encoder}/${evaluator}`;
            list.push([`${codec} with ${specular}`, code(language, codec, "--need", "specular", "--specular", specular)]);
        }
    for (const codec of ["sh1/moments/geomerics", "sg12/nnls/hill"])
        for (const storage of storages) list.push([`${codec} as ${storage}`, code(language, codec, "--storage", storage)]);
    return list.filter(([, text]) => text !== null);
}

const page = await browser.newPage();
page.setDefaultTimeout(120_000);
await page.goto(pathToFileURL(join(work, "page.html")).href);

// A module with an entry point, so that functions are checked; messages name the codec.
const wgsl = await page.evaluate(async (list) => {
    const device = await (await navigator.gpu?.requestAdapter())?.requestDevice();
    if (!device) return null;
    const faults = [];
    for (const [name, text] of list) {
        const module = device.createShaderModule({ code: `${text}\n@compute @workgroup_size(1) fn main() {}` });
        for (const message of (await module.getCompilationInfo()).messages)
            if (message.type === "error") faults.push(`${name}, line ${message.lineNum}: ${message.message}`);
    }
    return { count: list.length, faults };
}, texts("wgsl"));
if (wgsl) assert.deepEqual(wgsl.faults, []);
console.log(wgsl ? `WGSL: ${wgsl.count} texts compile` : "WGSL: skipped, this Chromium has no WebGPU");

const essl = await page.evaluate((list) => {
    const gl = document.createElement("canvas").getContext("webgl2");
    if (!gl) return null;
    const faults = [];
    for (const [name, text] of list) {
        const shader = gl.createShader(gl.FRAGMENT_SHADER);
        gl.shaderSource(shader, `#version 300 es\nprecision highp float;\nprecision highp int;\n${text}\nvoid main() {}\n`);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) faults.push(`${name}: ${gl.getShaderInfoLog(shader)}`);
        gl.deleteShader(shader);
    }
    return { count: list.length, faults };
}, texts("essl"));
if (essl) assert.deepEqual(essl.faults, []);
console.log(essl ? `GLSL ES: ${essl.count} texts compile` : "GLSL ES: skipped, this Chromium has no WebGL 2");

// Numbers: coefficients of a sky, E and L in the directions of a grid, as the library evaluates them.
const grid = [32, 16], allowed = 2e-5;
function jobs() {
    const list = [];
    for (const codec of evaluators) {
        const [basis, , evaluator] = codec.split("/");
        if (/^oct(16|24|32|64)$/.test(basis)) continue; // long texts; the others run the same functions
        const file = join(work, `${basis}.json`);
        try {
            readFileSync(file);
        } catch {
            execFileSync(lobelia, ["encode", "sky", "--sky-size", "32x16", "--codec", codec, "-o", file]);
        }
        const c = JSON.parse(readFileSync(file, "utf8")).coefficients.flat();
        for (const need of ["irradiance", "radiance"]) {
            if (need === "radiance" && list.some((job) => job.name === `${basis} radiance`)) continue;
            const text = Object.fromEntries(["wgsl", "essl"].map((language) => [language, code(language, codec, "--need", need)]));
            if (!text.wgsl) continue;
            const csv = join(work, "values.csv");
            execFileSync(lobelia, ["eval", file, "--evaluator", evaluator, `--${need}`, "--latlong", grid.join("x"), "-o", csv]);
            const rows = readFileSync(csv, "utf8").trim().split("\n").slice(1).map((row) => row.split(",").map(Number));
            list.push({ name: need === "radiance" ? `${basis} radiance` : `${basis} ${evaluator} irradiance`, need, c, text,
                directions: rows.flatMap((row) => row.slice(0, 3)), expected: rows.flatMap((row) => row.slice(3)) });
        }
    }
    return list;
}
const all = jobs();

/// Difference relative to the largest value; what is not a number is infinite.
const off = (found, expected) => {
    const largest = Math.max(1e-30, ...expected.map(Math.abs));
    return Math.max(...expected.map((value, i) => (Number.isFinite(found[i]) ? Math.abs(found[i] - value) / largest : Infinity)));
};

const byWebGPU = wgsl && (await page.evaluate(async (list) => {
    const device = await (await navigator.gpu.requestAdapter()).requestDevice();
    const results = [];
    for (const { text, need, c, directions } of list) {
        const count = directions.length / 3;
        const module = device.createShaderModule({ code: `${text.wgsl}
@group(0) @binding(0) var<storage, read> input_c: array<f32>;
@group(0) @binding(1) var<storage, read> input_w: array<f32>;
@group(0) @binding(2) var<storage, read_write> output: array<f32>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
    var light: Coefficients;
    for (var i = 0u; i < ${c.length / 3}u; i++) {
        light.c[i] = vec3f(input_c[3u * i], input_c[3u * i + 1u], input_c[3u * i + 2u]);
    }
    let at = 3u * id.x;
    let value = ${need}(light, vec3f(input_w[at], input_w[at + 1u], input_w[at + 2u]));
    output[at] = value.x;
    output[at + 1u] = value.y;
    output[at + 2u] = value.z;
}` });
        const pipeline = await device.createComputePipelineAsync({ layout: "auto", compute: { module, entryPoint: "main" } });
        const buffer = (data, usage, size = data.length) => {
            const made = device.createBuffer({ size: 4 * size, usage, mappedAtCreation: Boolean(data) });
            if (data) {
                new Float32Array(made.getMappedRange()).set(data);
                made.unmap();
            }
            return made;
        };
        const input = buffer(c, GPUBufferUsage.STORAGE), where = buffer(directions, GPUBufferUsage.STORAGE);
        const output = buffer(null, GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC, 3 * count);
        const back = buffer(null, GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST, 3 * count);
        const encoder = device.createCommandEncoder(), pass = encoder.beginComputePass();
        pass.setPipeline(pipeline);
        pass.setBindGroup(0, device.createBindGroup({ layout: pipeline.getBindGroupLayout(0),
            entries: [input, where, output].map((each, binding) => ({ binding, resource: { buffer: each } })) }));
        pass.dispatchWorkgroups(count / 64);
        pass.end();
        encoder.copyBufferToBuffer(output, 0, back, 0, 12 * count);
        device.queue.submit([encoder.finish()]);
        await back.mapAsync(GPUMapMode.READ);
        results.push([...new Float32Array(back.getMappedRange())]);
        for (const each of [input, where, output, back]) each.destroy();
    }
    return results;
}, all.map(({ text, need, c, directions }) => ({ text, need, c, directions }))));

const byWebGL = essl && (await page.evaluate((list) => {
    const gl = document.createElement("canvas").getContext("webgl2");
    if (!gl.getExtension("EXT_color_buffer_float")) return null;
    const results = [];
    const texture = (width, data) => {
        const made = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, made);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, 1, 0, gl.RGBA, gl.FLOAT, data);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
        return made;
    };
    const four = (values) => Float32Array.from({ length: (4 * values.length) / 3 }, (_, i) => (i % 4 === 3 ? 0 : values[3 * Math.floor(i / 4) + (i % 4)]));
    for (const { text, need, c, directions } of list) {
        const count = directions.length / 3, program = gl.createProgram();
        const add = (kind, source) => {
            const shader = gl.createShader(kind);
            gl.shaderSource(shader, source);
            gl.compileShader(shader);
            gl.attachShader(program, shader);
        };
        add(gl.VERTEX_SHADER, "#version 300 es\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }");
        add(gl.FRAGMENT_SHADER, `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
${text.essl}
uniform sampler2D input_c;
uniform sampler2D input_w;
out vec4 result;
void main() {
    Coefficients light;
    for (int i = 0; i < ${c.length / 3}; i++) light.c[i] = texelFetch(input_c, ivec2(i, 0), 0).xyz;
    result = vec4(${need}(light, texelFetch(input_w, ivec2(int(gl_FragCoord.x), 0), 0).xyz), 1.0);
}`);
        gl.linkProgram(program);
        gl.useProgram(program);
        const textures = [texture(c.length / 3, four(c)), texture(count, four(directions)), texture(count, null)];
        const target = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, target);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, textures[2], 0);
        textures.slice(0, 2).forEach((each, i) => {
            gl.activeTexture(gl.TEXTURE0 + i);
            gl.bindTexture(gl.TEXTURE_2D, each);
            gl.uniform1i(gl.getUniformLocation(program, i ? "input_w" : "input_c"), i);
        });
        gl.viewport(0, 0, count, 1);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
        const pixels = new Float32Array(4 * count);
        gl.readPixels(0, 0, count, 1, gl.RGBA, gl.FLOAT, pixels);
        results.push([...pixels].filter((_, i) => i % 4 !== 3));
        textures.forEach((each) => gl.deleteTexture(each));
        gl.deleteFramebuffer(target);
        gl.deleteProgram(program);
    }
    return results;
}, all.map(({ text, need, c, directions }) => ({ text, need, c, directions }))));

console.log(`${"largest difference, of the largest value".padEnd(44)}    WGSL GLSL ES`);
const faults = [];
all.forEach(({ name, expected }, i) => {
    const columns = [byWebGPU, byWebGL].map((results) => (results ? off(results[i], expected) : null));
    console.log(`${name.padEnd(44)} ${columns.map((value) => (value === null ? "-" : value.toExponential(1)).padStart(7)).join(" ")}`);
    if (columns.some((value) => value !== null && !(value < allowed))) faults.push(name);
});
assert.deepEqual(faults, []);

assert.ok(wgsl || essl, "neither WebGPU nor WebGL 2 runs here");
await browser.close();
rmSync(work, { recursive: true });
