// Renders the page of an example in a Chromium without a window: node browser.mjs PAGE BAKE SCENE PNG
// PAGE is the folder of the example, or an HTML file in it. The page finds the folder of SCENE at /scene/. Figures that a page measures are printed as
// JSON. Without PNG it serves the page until it is stopped, for a browser with a window. The environment variable CHROMIUM names the program.

import { spawn } from "node:child_process";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import path from "node:path";

import { patience } from "../scripts/patience.mjs";

const TYPES = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".json": "application/json", ".wasm": "application/wasm" };

const [page, bake, scene, picture] = process.argv.slice(2);
if (!scene) {
  console.error("usage: node browser.mjs PAGE BAKE SCENE [PNG]");
  process.exit(2);
}
const isFile = page.endsWith(".html");
const folders = [
  ["/bake/", path.resolve(bake)],
  ["/scene/", path.dirname(path.resolve(scene))],
  ["/", isFile ? path.dirname(path.resolve(page)) : path.resolve(page)],
];

/** File behind a path of the page. */
function find(url) {
  if (url === "/") return isFile ? path.resolve(page) : path.resolve(page, "index.html");
  if (url === "/scene.json") return path.resolve(scene);
  const [prefix, folder] = folders.find(([prefix]) => url.startsWith(prefix));
  const file = path.resolve(folder, url.slice(prefix.length));
  if (!file.startsWith(folder + path.sep)) throw new Error("outside the folder");
  return file;
}

let saved;
const answer = new Promise((resolve) => (saved = resolve));
const server = createServer(async (request, response) => {
  const { pathname } = new URL(request.url, "http://localhost");
  if (request.method === "POST") {
    let body = "";
    for await (const part of request) body += part;
    response.end();
    saved(JSON.parse(body));
    return;
  }
  try {
    const file = find(decodeURIComponent(pathname));
    const bytes = await readFile(file);
    response.setHeader("Content-Type", TYPES[path.extname(file)] ?? "application/octet-stream");
    response.end(bytes);
  } catch {
    response.statusCode = 404;
    response.end();
  }
});
await new Promise((resolve) => server.listen(picture ? 0 : 8000, "127.0.0.1", resolve));
const address = `http://127.0.0.1:${server.address().port}/`;

if (!picture) {
  console.log(address);
} else {
  const profile = await mkdtemp(path.join(tmpdir(), "luthier-browser-"));
  const flags = ["--headless=new", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-first-run", `--user-data-dir=${profile}`];
  // WebGPU on the software driver, too.
  flags.push("--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader");
  // The sandbox of Chromium does not start as root.
  if (process.getuid?.() === 0) flags.push("--no-sandbox");
  const browser = spawn(process.env.CHROMIUM ?? "chromium", [...flags, `${address}?save`], { stdio: "ignore" });
  const failed = new Promise((_, reject) => {
    browser.on("error", reject);
    browser.on("exit", (code) => reject(new Error(`the browser ended with ${code} before there was a picture`)));
  });
  const { failed: hung } = patience(browser.pid);
  try {
    const { picture: data, driver, figures, error } = await Promise.race([answer, failed, hung]);
    if (error) throw new Error(error);
    await writeFile(picture, Buffer.from(data.split(",")[1], "base64"));
    console.error(driver);
    if (figures) console.log(JSON.stringify(figures));
  } catch (error) {
    console.error(`error: ${error.message}`);
    process.exitCode = 1;
  } finally {
    for (const late of [failed, hung]) late.catch(() => {});
    if (browser.exitCode === null && browser.pid) {
      const ended = new Promise((resolve) => browser.once("exit", resolve));
      browser.kill();
      await ended;
    }
    server.closeAllConnections();
    server.close();
    await rm(profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
  }
}
