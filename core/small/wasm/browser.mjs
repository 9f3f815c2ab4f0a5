// The report of files by page.html in headless Chromium: node browser.mjs FOLDER-OF-MODULES FILE...

import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const [modules, ...files] = process.argv.slice(2);
const here = fileURLToPath(new URL(".", import.meta.url));
const TYPES = { html: "text/html", mjs: "text/javascript", wasm: "application/wasm" };
const pages = new Map([
    ...["page.html", "sig.mjs", "report.mjs"].map(name => [`/${name}`, join(here, name)]),
    ...[16, 32].map(bits => [`/sig${bits}.wasm`, join(modules, `sig${bits}.wasm`)]),
    ...files.map((file, number) => [`/${number}.sigc`, file]),
]);

const profile = mkdtempSync(join(tmpdir(), "sig-page-"));
const server = createServer(async (request, response) => {
    const path = new URL(request.url, "http://localhost").pathname;
    if (request.method === "POST" && path === "/lines") {
        let lines = "";
        for await (const part of request) lines += part;
        response.end(() => finish(lines, 0));
    } else if (pages.has(path)) {
        response.setHeader("content-type", TYPES[path.split(".").pop()] ?? "application/octet-stream");
        response.end(readFileSync(pages.get(path)));
    } else {
        response.writeHead(404).end();
    }
});

let chromium;
function finish(lines, status) {
    console.log(lines);
    chromium.once("exit", () => {
        try {
            rmSync(profile, { recursive: true, force: true, maxRetries: 25, retryDelay: 200 });
        } catch (error) {
            console.error(`the profile of Chromium is left: ${error.message}`);
        }
        process.exit(status);
    });
    // With its children, which would go on writing to the profile.
    process.kill(-chromium.pid, "SIGKILL");
}

server.listen(0, "127.0.0.1", () => {
    const query = files.map((_, number) => `file=${number}.sigc`).join("&");
    const address = `http://127.0.0.1:${server.address().port}/page.html?${query}`;
    const flags = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", `--user-data-dir=${profile}`];
    chromium = spawn("chromium", [...flags, address], { stdio: ["ignore", "ignore", "ignore"], detached: true });
    setTimeout(() => finish("Chromium did not answer", 1), 120_000);
});
