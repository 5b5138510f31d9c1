// The logic of the reports' scripts, without a browser: node --test tests/web/logic_test.mjs
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

const web = new URL("../../src/report/web/", import.meta.url);
const from_web = (path) => import(new URL(path, web));

const { automatic_gain, error_colours, error_scale_for, expose_for, gain, luminance, srgb_codes, tone_curves, view, write_colour } =
    await from_web("shared/colour.js");
const { decode, made_once, resized } = await from_web("shared/picture_data.js");
const { difference_figures, signed_difference, signed_picture, smape_picture } = await from_web("shared/differences.js");
const { count_text, figure_text, percent_text, share_text, signed_text, vector_text } = await from_web("shared/format.js");
const { even_ticks, log_ticks, plain_tick, power_tick } = await from_web("shared/ticks.js");
const { compare_values } = await from_web("shared/sorting.js");
const ranking = await from_web("comparison/ranking.js");
const { direction_of, position_of, sample_picture, sphere_points } = await from_web("comparison/latlong.js");
const { pareto_front, spread_apart } = await from_web("comparison/pareto.js");
const { columns_of_table, is_numeric, least_rows } = await from_web("study/tables.js");

const near = (a, b, tolerance = 1e-6) => assert.ok(Math.abs(a - b) <= tolerance, `${a} is not ${b}`);

// ---- Pictures

/// Base64 of 16-bit values, little-endian.
const base64_of = (words) => Buffer.from(Uint16Array.from(words).buffer).toString("base64");

test("every half float decodes to its value by IEEE 754", () => {
    const words = Array.from({ length: 65536 }, (_, bits) => bits);
    const { data } = decode({ width: 256, height: 256, channels: 1, half: base64_of(words) });
    for (const bits of words) {
        const exponent = (bits >> 10) & 31, mantissa = bits & 1023, sign = bits & 0x8000 ? -1 : 1;
        if (exponent === 31) assert.ok(mantissa ? Number.isNaN(data[bits]) : data[bits] === sign * Infinity);
        else assert.equal(data[bits], sign * (exponent ? (1 + mantissa / 1024) * 2 ** (exponent - 15) : mantissa / 1024 * 2 ** -14));
    }
});

test("whole numbers decode to themselves, and a missing picture to null", () => {
    assert.deepEqual([...decode({ width: 3, height: 1, channels: 1, whole: base64_of([0, 1, 65535]) }).data], [0, 1, 65535]);
    assert.equal(decode(undefined), null);
    assert.equal(decode({ width: 3, height: 1 }), null);
});

test("a picture has three channels unless it says otherwise", () => {
    const picture = decode({ width: 1, height: 1, half: base64_of([0x3c00, 0x4000, 0xc000]) });
    assert.equal(picture.channels, 3);
    assert.deepEqual([...picture.data], [1, 2, -2]);
});

test("values are made once for each key", () => {
    let count = 0;
    const make = () => ++count;
    assert.equal(made_once("test key", make), 1);
    assert.equal(made_once("test key", make), 1);
});

const ramp = (width, height, value) => ({
    width, height, channels: 1, data: Float32Array.from({ length: width * height }, (_, i) => value(i % width, Math.trunc(i / width))),
});

test("reduced pictures keep the mean, enlarged ones the values", () => {
    const picture = ramp(8, 4, (x, y) => x + 10 * y);
    const mean = ({ data }) => data.reduce((a, b) => a + b) / data.length;
    near(mean(resized(picture, 4, 2)), mean(picture));
    assert.equal(resized(picture, 4, 2).data[0], (0 + 1 + 10 + 11) / 4);
    assert.deepEqual(new Set(resized(ramp(2, 1, (x) => x), 6, 3).data), new Set([0, 1]));
    assert.equal(resized(picture, 8, 4), picture);
});

// ---- Differences

const rgb_picture = (...pixels) => ({ width: pixels.length, height: 1, channels: 3, data: Float32Array.from(pixels.flat()) });

test("sMAPE lies between 0 and 1, and is 0 for equal and for black pixels", () => {
    const a = rgb_picture([1, 2, 3], [0, 0, 0], [1, 1, 1]), b = rgb_picture([1, 2, 3], [0, 0, 0], [0, 0, 0]);
    const { data, channels } = smape_picture(a, b);
    assert.equal(channels, 1);
    [0, 0, 1].forEach((value, i) => near(data[i], value));
});

test("signed differences are positive where the first is brighter", () => {
    assert.equal(signed_difference(3, 1), 0.5);
    assert.equal(signed_difference(1, 3), -0.5);
    assert.equal(signed_difference(0, 0), 0);
    near(signed_picture(rgb_picture([3, 3, 3]), rgb_picture([1, 1, 1])).data[0], 0.5);
});

test("figures of a difference: RMS and brightness over the mean of the reference", () => {
    const { rms, bias, relative } = difference_figures(rgb_picture([1, 1, 1], [3, 3, 3]), rgb_picture([2, 2, 2], [2, 2, 2]));
    near(rms, 0.5);
    near(bias, 0);
    near(relative, (1 / 3 + 1 / 5) / 2);
    near(difference_figures(rgb_picture([1, 1, 1]), rgb_picture([2, 2, 2])).bias, -0.5);
});

// ---- Colour

test("tone curves map 0 to 0, rise, and stay within 1", () => {
    for (const [name, curve] of Object.entries(tone_curves)) {
        assert.equal(curve(0), 0, name);
        for (let x = 0, before = 0; x < 100; x = x * 1.3 + 0.01) {
            const y = curve(x);
            assert.ok(y >= before && y <= 1, `${name} at ${x}`);
            before = y;
        }
    }
});

test("sRGB codes are those of the exact curve", () => {
    assert.equal(srgb_codes[0], 0);
    assert.equal(srgb_codes[65535], 255);
    for (const code of [1, 10, 11, 64, 128, 200, 254]) {
        const v = code / 255, linear = v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
        assert.equal(srgb_codes[Math.round(linear * 65535)], code);
    }
});

test("the automatic exposure shows the mean as a quarter of white", () => {
    view.exposure = 0;
    expose_for(2);
    near(gain() * 2, 0.25);
    view.exposure = 1;
    near(gain() * 2, 0.5);
    view.exposure = 0;
    expose_for(0);
    assert.equal(gain(), 1);
});

test("negative colours are marked only if asked, and never written below 0", () => {
    const out = new Uint8ClampedArray(4);
    view.mark_negative = true;
    write_colour(-1, 0.5, 0.5, 1, tone_curves.clamp, out, 0);
    assert.ok(out[0] > out[1] && out[2] > out[1], "magenta");
    view.mark_negative = false;
    write_colour(-1, 1, 0, 1, tone_curves.clamp, out, 0);
    assert.deepEqual([...out.slice(0, 3)], [0, 255, 0]);
    view.mark_negative = true;
});

test("luminance is that of Rec. 709", () => near(luminance([1, 1, 1]), 1));

test("error colours go from dark to bright, and scales leave room", () => {
    const brightness = (i) => luminance(error_colours.slice(3 * i, 3 * i + 3));
    for (let i = 1; i < 256; ++i) assert.ok(brightness(i) >= brightness(i - 1) - 1);
    assert.equal(error_scale_for(0.004), 0.01);
    assert.equal(error_scale_for(0.03), 0.1);
    assert.equal(error_scale_for(3), 1);
});

// ---- Text

test("figures have three digits, and real minus signs", () => {
    assert.equal(figure_text(0), "0");
    assert.equal(figure_text(1.23456), "1.23");
    assert.equal(figure_text(-1.23456), "−1.23");
    assert.equal(figure_text(0.000012345), "1.2e−5");
    assert.equal(figure_text(123456), "123\u202f456");
    assert.equal(figure_text(12345678), "1.2e7");
    for (const none of [NaN, Infinity, undefined, null]) assert.equal(figure_text(none), "–");
});

test("shares are in per cent", () => {
    assert.equal(share_text(0), "0");
    assert.equal(share_text(0.0005), "< 0.1");
    assert.equal(share_text(0.1234), "12.3");
    assert.equal(share_text(51.317), "5\u202f132");
    assert.equal(percent_text(0.1234), "12.3 %");
    assert.equal(percent_text(NaN), "–");
});

test("counts, signed numbers and vectors", () => {
    assert.equal(count_text(1234567), "1\u202f234\u202f567");
    assert.equal(count_text(undefined), "–");
    assert.equal(signed_text(1.25, 1), "+1.3");
    assert.equal(signed_text(-1.25, 1), "−1.3");
    assert.equal(vector_text([0.5, -1, 0]), "0.50  −1.00  0.00");
});

// ---- Ticks

test("even ticks are round and enclose the range", () => {
    for (const [low, high] of [[0, 1], [-3, 17], [0.001, 0.0042], [1e5, 3e5]]) {
        const ticks = even_ticks(low, high);
        assert.ok(ticks[0] <= low + 1e-12 && ticks.at(-1) >= high - 1e-9 * high, `${ticks}`);
        assert.ok(ticks.length >= 3 && ticks.length <= 11, `${ticks}`);
    }
    assert.deepEqual(even_ticks(0, 90, 30), [0, 30, 60, 90]);
});

test("logarithmic ticks: powers of two, or round numbers", () => {
    assert.deepEqual(log_ticks(3, 20, true), [2, 4, 8, 16, 32]);
    assert.ok(log_ticks(0.001, 1000, false).every((tick) => Number.isInteger(Math.round(Math.log10(tick) * 1e6) / 1e6)));
    assert.ok(log_ticks(0.9, 1.1, false).length >= 3);
});

test("ticks as text", () => {
    assert.equal(plain_tick(-0.25), "−0.25");
    assert.equal(power_tick(1e-5), "10⁻⁵");
    assert.equal(power_tick(3e4), "3·10⁴");
    assert.equal(power_tick(2), "2");
    assert.equal(power_tick(20), "20");
});

// ---- Tables

test("rows sort by numbers in names, and missing figures come last in both orders", () => {
    assert.deepEqual(["sh10", "sh2", "sg1"].sort((a, b) => compare_values(a, b, 1)), ["sg1", "sh2", "sh10"]);
    for (const sign of [1, -1]) {
        const sorted = [NaN, 2, undefined, 1].sort((a, b) => compare_values(a, b, sign));
        assert.deepEqual(sorted.slice(0, 2), sign > 0 ? [1, 2] : [2, 1]);
        assert.ok(sorted.slice(2).every((x) => !Number.isFinite(x)));
    }
});

const method = (basis, floats, irradiance, radiance = 1, more = {}) => ({
    name: `${basis}/e${irradiance}/r`, basis, encoder: `e${irradiance}`, evaluator: "r", domain: "sphere", floats,
    bytes: 4 * floats, irradiance_over_pi_rms: irradiance, radiance_rms: radiance, ...more,
});

test("the best of each basis is the one of the least irradiance error", () => {
    const methods = [method("a", 3, 5), method("b", 3, 4), method("a", 3, 2), method("b", 3, NaN), method("c", 3, NaN)];
    assert.deepEqual(ranking.best_of_bases(methods).map(({ name }) => name), ["b/e4/r", "a/e2/r", "c/eNaN/r"]);
});

test("errors are shares of the mean over channels", () => {
    const report = { environment: { mean_radiance: [1, 2, 3] } };
    assert.equal(ranking.mean_value(report), 2);
    assert.equal(ranking.relative_error(method("a", 3, 0.5), "irradiance", 2), 0.25);
    assert.ok(Number.isNaN(ranking.mean_value({})));
    assert.ok(Number.isNaN(ranking.relative_error(method("a", 3, 0.5), "irradiance", NaN)));
});

test("representatives: the front by size, and the sharpest, in order of size", () => {
    const methods = [method("small", 3, 9), method("worse", 6, 10), method("middle", 12, 4), method("large", 48, 1), method("sharp", 96, 2, 0.1)];
    assert.deepEqual(ranking.representatives_of(methods, 7).map(({ basis }) => basis), ["small", "middle", "large", "sharp"]);
    assert.ok(ranking.representatives_of(methods, 2).length <= 2);
    assert.deepEqual(ranking.representatives_of([], 5), []);
    assert.deepEqual(ranking.irradiance_front(methods).map(({ basis }) => basis), ["small", "middle", "large"]);
    assert.deepEqual(ranking.spread_over([1, 2, 3, 4, 5], 3), [1, 3, 5]);
    assert.deepEqual(ranking.spread_over([1], 3), [1]);
    assert.deepEqual(ranking.representative_methods(methods, ["sphere"]), methods);
});

test("bases that differ in numbers only are one family", () => {
    const family_of = ranking.family_finder([{ basis: "sh1" }, { basis: "sh2" }, { basis: "hl2" }]);
    assert.deepEqual(["sh1", "sh2", "hl2"].map((basis) => family_of({ basis })), ["sh", "sh", "hl2"]);
});

test("the main axis is the first that differs", () => {
    assert.equal(ranking.main_axis_of([method("a", 3, 1), method("b", 3, 1)]), "basis");
    assert.equal(ranking.main_axis_of([method("a", 3, 1), method("a", 3, 2)]), "encoder");
    assert.equal(ranking.main_axis_of([]), "basis");
});

test("every word of a filter must be part of the name", () => {
    assert.ok(ranking.name_matches("sg12/least-squares/hill", "SG least"));
    assert.ok(ranking.name_matches("sg12/least-squares/hill", ""));
    assert.ok(!ranking.name_matches("sg12/least-squares/hill", "sg moments"));
});

test("the least values win, unless many share them", () => {
    const value = (x) => x;
    assert.deepEqual(ranking.winners_of([3, 1, 2, NaN], value), [1]);
    assert.deepEqual(ranking.winners_of([1, 1, 2, 3], value), []);
    assert.deepEqual(ranking.winners_of([1], value), []);
});

test("the Pareto front falls in error as sizes rise", () => {
    const points = [[4, 3], [1, 5], [2, 6], [8, 1], [8, 2], [2, 4]].map(([bytes, y]) => ({ bytes, y }));
    assert.deepEqual(pareto_front(points).map(({ bytes, y }) => [bytes, y]), [[1, 5], [2, 4], [4, 3], [8, 1]]);
});

test("groups of one size stand apart by at most 8 %", () => {
    const points = ["a", "b", "c"].map((group) => ({ group, bytes: 100 }));
    spread_apart(points, ["a", "b", "c"], ({ group }) => group);
    assert.equal(new Set(points.map(({ x }) => x)).size, 3);
    for (const { x } of points) assert.ok(Math.abs(x / 100 - 1) < 0.08);
});

test("study tables: lists become columns, numbers are told from text, the least is found", () => {
    const table = { title: "errors at N = 16 / 64", columns: ["encoder", "excess"], rows: [["a", "3 / 1"], ["b", "2 / 4"], ["c", "5 / 6"]] };
    const columns = columns_of_table(table);
    assert.deepEqual(columns.map(({ name }) => name), [null, "16", "64"]);
    assert.deepEqual(table.rows.map((row) => columns[2].text_of(row)), ["1", "4", "6"]);
    assert.ok(!is_numeric(columns[0], table.rows) && is_numeric(columns[1], table.rows));
    assert.deepEqual(least_rows(columns[1], table.rows), [table.rows[1]]);
});

// ---- Latitude-longitude pictures

test("positions and directions are inverse", () => {
    for (const u of [0.05, 0.3, 0.75])
        for (const v of [0.1, 0.5, 0.8]) {
            const direction = direction_of(u, v);
            near(Math.hypot(...direction), 1);
            position_of(direction).forEach((x, k) => near(x, [u, v][k]));
        }
    near(direction_of(0.5, 0)[1], 1);
});

test("samples are bilinear, go around the seam and hold at the poles", () => {
    const picture = ramp(4, 2, (x) => x);
    const value = [0];
    const at = (u, v) => (sample_picture(picture, u, v, value), value[0]);
    near(at(1.5 / 4, 0.5), 1);
    near(at(2 / 4, 0.25), 1.5);
    near(at(0, 0.5), 1.5); // between 3 and 0
    near(at(0.5 / 4, 0), 0);
});

test("points of a sphere lie within it and see the front", () => {
    const { u, v, cover } = sphere_points(32);
    assert.equal(sphere_points(32).u, u);
    const middle = 16 * 32 + 16;
    assert.equal(cover[middle], 1);
    assert.equal(cover[0], 0);
    const [, , z] = direction_of(u[middle], v[middle]);
    near(z, 1, 0.02);
});

// ---- Modules

const modules = ["shared", "comparison", "bake", "study"].flatMap((folder) =>
    readdirSync(new URL(folder, web)).filter((name) => name.endsWith(".js")).map((name) => `${folder}/${name}`),
);

test("modules keep to the form that the program joins", () => {
    for (const path of modules) {
        const text = readFileSync(new URL(path, web), "utf8");
        assert.match(text, /^\/\/ \S/, `${path} says what it is for`);
        assert.doesNotMatch(text, /export default|import \*|\bimport\(|^export \{/m, path);
        for (const [statement] of text.matchAll(/^import[^;]*;/gm))
            assert.match(statement, /^import \{[\w\s,]+\} from "\.{1,2}\/[\w./]+\.js";$/, `${path}: ${statement}`);
    }
});

test("top-level names are unique among the modules of a report, and imports name what is exported", () => {
    for (const folder of ["comparison", "bake", "study"]) {
        const owner = new Map();
        for (const path of modules.filter((name) => name.startsWith("shared/") || name.startsWith(`${folder}/`)))
            for (const [, name] of readFileSync(new URL(path, web), "utf8").matchAll(/^(?:export )?(?:function|const|let|class) (\w+)/gm)) {
                assert.ok(!owner.has(name), `${name} in ${path} and ${owner.get(name)}`);
                owner.set(name, path);
            }
    }
    for (const path of modules)
        for (const [, names, from] of readFileSync(new URL(path, web), "utf8").matchAll(/^import \{([^}]*)\} from "([^"]*)";/gm)) {
            const text = readFileSync(new URL(from, new URL(path, web)), "utf8");
            for (const name of names.split(",").map((part) => part.trim()).filter(Boolean))
                assert.match(text, new RegExp(`^export (function|const|let|class) ${name}\\b`, "m"), `${path} imports ${name} from ${from}`);
        }
});

test("no module imports one that imports it", () => {
    const imports = (path) =>
        [...readFileSync(new URL(path, web), "utf8").matchAll(/from "([^"]*)";/g)].map(([, from]) =>
            new URL(from, new URL(path, web)).href.slice(web.href.length));
    const visit = (path, above) => {
        assert.ok(!above.includes(path), [...above, path].join(" -> "));
        for (const next of imports(path)) visit(next, [...above, path]);
    };
    for (const path of modules) visit(path, []);
});

assert.ok(automatic_gain > 0);
