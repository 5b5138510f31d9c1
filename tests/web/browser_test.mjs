// The reports in a browser: no errors on the console, tables sort and filter, the wipe moves, keys work, nothing is wider
// than a phone.
//   node tests/web/browser_test.mjs LOBELIA [FOLDER]
// LOBELIA is the program; with FOLDER, screenshots of desktop and phone, light and dark, are written there. Exit code 77
// if Chromium or playwright-core is not installed.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { launch } from "./chromium.mjs";

const [, , lobelia, screenshots] = process.argv;
const work = mkdtempSync(join(tmpdir(), "lobelia-browser-"));

/// Reports small enough to make in seconds, or whole ones for screenshots.
function make_reports() {
    const run = (...args) => execFileSync(lobelia, args, { cwd: work, stdio: ["ignore", "ignore", "inherit"] });
    const some = screenshots ? [] : ["--sky-size", "64x32", ...["sh1", "sh2", "sg12", "ahd"].flatMap((basis) => ["--basis", basis])];
    run("compare", "sky", ...some, "-o", "compare");
    run("study", "irradiance", "-o", "study");
    const quick = ["--size", "128x128", "--samples", "64", "--picture-size", "96x72", "--picture-samples", "4"];
    run("bake", screenshots ? "colonnade" : "cornell", ...(screenshots ? [] : quick), "--probes", "scene", "--probe-spacing", screenshots ? "2" : "1", "-o", "bake");
}

const reports = { compare: "compare/report.html", study: "study/irradiance.html", bake: "bake/bake.html" };

const browser = await launch();

/// Opens a report from the disk; `errors` collects what the console says.
async function open(name, options = {}) {
    const context = await browser.newContext({ viewport: { width: 1400, height: 900 }, ...options });
    const page = await context.newPage();
    page.setDefaultTimeout(120_000); // machines that do other work, too
    const errors = [];
    page.on("console", (message) => ["error", "warning"].includes(message.type()) && errors.push(message.text()));
    page.on("pageerror", (error) => errors.push(String(error)));
    page.on("request", (request) => /^https?:/.test(request.url()) && errors.push(`loads ${request.url()}`));
    await page.goto(pathToFileURL(join(work, reports[name])).href);
    await page.waitForTimeout(300);
    return { page, errors, close: () => context.close() };
}

const tests = [];
const test = (name, run) => tests.push([name, run]);

/// Cells of a column of the table of methods.
const column = (page, key) => page.$$eval(`#methods tbody td[data-key="${key}"]`, (cells) => cells.map((cell) => cell.textContent));
const numbers = (texts) => texts.map((text) => Number(text.replace("< ", "").replace("e−", "e-").replaceAll("\u202f", "")));

for (const name of Object.keys(reports)) {
    test(`${name}: no errors, and nothing is loaded`, async () => {
        const { page, errors, close } = await open(name);
        for (let y = 0; y < 6; ++y) {
            await page.mouse.wheel(0, 900);
            await page.waitForTimeout(50);
        }
        assert.deepEqual(errors, []);
        assert.notEqual(await page.textContent("h1"), "");
        await close();
    });
    for (const [width, height] of [[1400, 900], [390, 844]])
        test(`${name}: nothing is wider than ${width} pixels`, async () => {
            const { page, close } = await open(name, { viewport: { width, height } });
            assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= width);
            await close();
        });
}

test("compare: the glance shows the reference first, then spheres with errors in per cent", async () => {
    const { page, close } = await open("compare");
    const captions = await page.$$eval("#glance figcaption", (all) => all.map((caption) => caption.textContent));
    assert.match(captions[0], /^Reference/);
    assert.ok(captions.length >= 2);
    for (const caption of captions.slice(1)) assert.match(caption, /\d %/);
    // The spheres are painted.
    const lit = await page.$$eval("#glance canvas", (all) =>
        all.map((canvas) => canvas.getContext("2d").getImageData(canvas.width / 2, canvas.height / 2, 1, 1).data[3]));
    assert.ok(lit.every((alpha) => alpha === 255));
    await close();
});

test("compare: one row for each basis, then all", async () => {
    const { page, close } = await open("compare");
    const bases = await column(page, "basis");
    assert.equal(new Set(bases).size, bases.length);
    await page.click("#rows label:nth-of-type(2)");
    assert.ok((await column(page, "basis")).length > bases.length);
    await close();
});

test("compare: headings sort, in both directions", async () => {
    const { page, close } = await open("compare");
    await page.click("#rows label:nth-of-type(2)");
    await page.click('#methods th[data-key="floats"] button');
    const up = numbers(await column(page, "floats"));
    assert.deepEqual(up, [...up].sort((a, b) => a - b));
    await page.click('#methods th[data-key="floats"] button');
    assert.deepEqual(numbers(await column(page, "floats")), [...up].sort((a, b) => b - a));
    assert.equal(await page.getAttribute('#methods th[data-key="floats"]', "aria-sort"), "descending");
    await close();
});

test("compare: filters leave what matches", async () => {
    const { page, close } = await open("compare");
    await page.click("#rows label:nth-of-type(2)");
    await page.fill('#filters input[type="search"]', "sh least");
    const names = await page.$$eval("#methods tbody tr", (rows) => rows.map((row) => row.dataset.name));
    assert.ok(names.length > 0);
    for (const name of names) assert.ok(name.includes("sh") && name.includes("least"), name);
    await page.fill('#filters input[type="search"]', "no such method");
    assert.equal((await column(page, "basis")).length, 0);
    await close();
});

test("compare: keys move through the table, open and close details, and pin", async () => {
    const { page, errors, close } = await open("compare");
    await page.focus('#methods tbody tr[tabindex="0"]');
    const focused = () => page.evaluate(() => document.activeElement.dataset.name);
    const first = await focused();
    await page.keyboard.press("ArrowDown");
    assert.notEqual(await focused(), first);
    await page.keyboard.press("Enter");
    assert.ok(await page.isVisible("#detail"));
    await page.keyboard.press("Escape");
    assert.ok(!(await page.isVisible("#detail")));
    const pictures = () => page.$$eval("#pictures .subject", (all) => all.length);
    const before = await pictures();
    await page.keyboard.press("p");
    assert.equal(Math.abs((await pictures()) - before), 1);
    await page.keyboard.press("p");
    assert.equal(await pictures(), before);
    assert.deepEqual(errors, []);
    await close();
});

test("compare: exposure and tone curve repaint the pictures", async () => {
    const { page, close } = await open("compare");
    const middle = () => page.$eval("#glance canvas", (canvas) => [...canvas.getContext("2d").getImageData(canvas.width / 2, canvas.height / 2, 1, 1).data]);
    const before = await middle();
    await page.$eval("#exposure", (input) => {
        input.value = -3;
        input.dispatchEvent(new Event("input"));
    });
    await page.waitForTimeout(200);
    const after = await middle();
    assert.ok(after[0] < before[0] && after[1] < before[1], `${before} -> ${after}`);
    await close();
});

test("bake: the wipe follows pointer and keys", async () => {
    const { page, errors, close } = await open("bake");
    const split = () => page.$eval("#split", (input) => Number(input.value));
    const box = await (await page.$("#stage-frame")).boundingBox();
    await page.mouse.click(box.x + box.width / 4, box.y + box.height / 2);
    assert.ok(Math.abs((await split()) - 25) < 1);
    await page.mouse.move(box.x + box.width / 4, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width * 0.75, box.y + box.height / 2, { steps: 4 });
    await page.mouse.up();
    assert.ok(Math.abs((await split()) - 75) < 1);
    await page.keyboard.press("ArrowLeft");
    assert.ok((await split()) < 75);
    assert.deepEqual(errors, []);
    await close();
});

test("bake: reference and error show by themselves", async () => {
    const { page, close } = await open("bake");
    for (const form of ["reference", "error", "baked", "wipe"]) {
        await page.check(`#forms input[value="${form}"]`, { force: true });
        assert.equal(await page.$eval("#stage", (stage) => stage.dataset.form), form);
    }
    await close();
});

test("bake: objects sort, and Enter shows one in the lightmaps", async () => {
    const { page, close } = await open("bake");
    await page.click('#objects button[data-key="texels"]');
    const texels = numbers(await page.$$eval("#objects tbody tr td:nth-child(2)", (cells) => cells.map((cell) => cell.textContent)));
    assert.deepEqual(texels, [...texels].sort((a, b) => b - a));
    await page.focus("#objects tbody tr");
    await page.keyboard.press("Enter");
    assert.ok(await page.isVisible("#object-clear"));
    assert.equal(await page.getAttribute("#objects tbody tr", "aria-selected"), "true");
    await page.keyboard.press("Escape");
    assert.ok(!(await page.isVisible("#object-clear")));
    await close();
});

test("bake: keys zoom into the lightmap", async () => {
    const { page, close } = await open("bake");
    await page.focus("#viewer");
    const width = () => page.$eval("#viewer-canvas", (canvas) => canvas.getBoundingClientRect().width);
    const before = await width();
    await page.keyboard.press("+");
    assert.ok((await width()) > before);
    await page.keyboard.press("0");
    assert.equal(await width(), before);
    await close();
});

test("study: a legend hides its curve in all plots, and shows it again", async () => {
    const { page, errors, close } = await open("study");
    const entry = page.locator(".legend-entry").first();
    await entry.click();
    assert.equal(await entry.getAttribute("aria-pressed"), "false");
    await page.click("#show-all");
    assert.equal(await entry.getAttribute("aria-pressed"), "true");
    assert.deepEqual(errors, []);
    await close();
});

async function take_screenshots() {
    for (const name of Object.keys(reports))
        for (const [device, viewport] of Object.entries({ desktop: { width: 1400, height: 900 }, phone: { width: 390, height: 844 } }))
            for (const colorScheme of ["light", "dark"]) {
                const { page, close } = await open(name, { viewport, colorScheme });
                // Scroll through, so that everything is painted.
                const height = await page.evaluate(() => document.documentElement.scrollHeight);
                for (let y = 0; y < height; y += 700) {
                    await page.evaluate((to) => scrollTo(0, to), y);
                    await page.waitForTimeout(60);
                }
                await page.evaluate(() => scrollTo(0, 0));
                await page.waitForTimeout(150);
                await page.screenshot({ path: join(screenshots, `${name}-${device}-${colorScheme}.png`) });
                await page.screenshot({ path: join(screenshots, `${name}-${device}-${colorScheme}-full.png`), fullPage: true });
                await close();
            }
}

let failures = 0;
try {
    make_reports();
    if (screenshots) await take_screenshots();
    for (const [name, run] of tests) {
        try {
            await run();
            console.log(`ok    ${name}`);
        } catch (error) {
            failures += 1;
            console.log(`FAIL  ${name}\n${error.stack}`);
        }
    }
} finally {
    await browser.close();
    rmSync(work, { recursive: true, force: true });
}
console.log(failures ? `${failures} of ${tests.length} failed` : `all ${tests.length} passed`);
process.exit(failures ? 1 : 0);
