// A static HTTP server on 127.0.0.1 for pages that tests open.
import { createReadStream, existsSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize, sep } from "node:path";

const types = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".json": "application/json" };

/// Serves folders under paths: { "/bake/": "/tmp/bake", ... }. Returns { url, close }.
export async function serve(folders) {
    const server = createServer((request, response) => {
        const path = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
        const prefix = Object.keys(folders).sort((a, b) => b.length - a.length).find((p) => path.startsWith(p));
        const rest = normalize(path.slice(prefix?.length ?? 0) || "index.html");
        const file = prefix && !rest.startsWith("..") && !rest.startsWith(sep) ? join(folders[prefix], rest) : "";
        if (!file || !existsSync(file) || !statSync(file).isFile()) return response.writeHead(404).end();
        response.writeHead(200, { "Content-Type": types[extname(file)] ?? "application/octet-stream" });
        createReadStream(file).pipe(response);
    });
    await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
    return { url: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}
