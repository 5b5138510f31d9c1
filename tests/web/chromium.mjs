// Debian's Chromium by playwright-core, for tests that need a browser.
import { existsSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

/// Ends a test that cannot run here: ctest takes exit code 77 for skipped.
export function skip(reason) {
    console.log(`skipped: ${reason}`);
    process.exit(77);
}

/// Starts the browser, or skips the test.
export async function launch(args = []) {
    const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
    if (!executablePath) skip("no Chromium: setup/packages test installs it");
    let chromium;
    try {
        const installed = createRequire(new URL("../../tools/package.json", import.meta.url));
        ({ chromium } = await import(pathToFileURL(installed.resolve("playwright-core"))).then((module) => module.default ?? module));
    } catch {
        skip("no playwright-core: npm ci --prefix tools");
    }
    return chromium.launch({ executablePath, args: ["--no-sandbox", ...args] });
}
