// Shader code in a browser: the WGSL and the GLSL ES of every basis, evaluator and storage compiles in Chromium.
//   node tests/web/shader_test.mjs LOBELIA
// LOBELIA is the program. Exit code 77 if Chromium or playwright-core is not installed.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
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
const storages = ["float32", "float16", "ycocg", "rgb9e5", "rgbe", "rgbm", "logluv", "bc6h", "bc6h-signed", "ratio8", "ratio10", "bc6h-ratio8"];
function texts(language) {
    const list = evaluators.map((codec) => [codec, code(language, codec, "--need", "irradiance,radiance")]);
    list.push(["sh2 of probes", code(language, "sh2/moments/convolution", "--need", "irradiance,probes")]);
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

assert.ok(wgsl || essl, "neither WebGPU nor WebGL 2 runs here");
await browser.close();
rmSync(work, { recursive: true });
