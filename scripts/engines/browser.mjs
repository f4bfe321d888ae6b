// A server of pages and a Chromium without a window that goes through them.

import { spawn } from "node:child_process";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import path from "node:path";

import { patience } from "../patience.mjs";

const TYPES = { ".js": "text/javascript", ".json": "application/json", ".png": "image/png" };

const page = ({ imports, script, job }) => `<!doctype html>
<meta charset="utf-8">
<script type="importmap">${JSON.stringify({ imports })}</script>
<script type="application/json" id="job">${JSON.stringify(job)}</script>
<script>
  async function answer(values) {
    const response = await fetch("/answer", { method: "POST", body: JSON.stringify({ id: ${job.id}, ...values }) });
    const next = await response.text();
    if (next) location.href = next;
  }
  // Modules that do not load or do not fit.
  addEventListener("error", ({ message, target }) => answer({ error: message ?? target.src + " does not load" }), true);
</script>
<script type="module" src="${script}"></script>
`;

/** What the page of each job sends, in their order. `folders` are those that pages read, by the beginning of the path. */
export async function render(jobs, folders) {
  const answers = [];
  let done;
  let answered = () => {};
  const all = new Promise((resolve) => (done = resolve));

  async function file(pathname) {
    const [prefix, folder] = Object.entries(folders).find(([prefix]) => pathname.startsWith(prefix));
    const root = path.resolve(folder);
    const name = path.resolve(root, pathname.slice(prefix.length));
    if (!name.startsWith(root + path.sep)) throw new Error("outside the folder");
    return { name, bytes: await readFile(name) };
  }

  const server = createServer(async (request, response) => {
    const pathname = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
    if (request.method === "POST") {
      let body = "";
      for await (const part of request) body += part;
      const { id, ...answer } = JSON.parse(body);
      // A page that failed twice over has one answer.
      const isNew = answers[id] === undefined;
      if (isNew) answers[id] = answer;
      answered();
      if (process.env.VERBOSE) console.error(`page ${id + 1} of ${jobs.length}: ${answer.error ?? "done"}`);
      response.end(isNew && id + 1 < jobs.length ? `/job/${id + 1}` : "");
      if (isNew && id + 1 === jobs.length) done();
      return;
    }
    try {
      const number = pathname.match(/^\/job\/(\d+)$/)?.[1];
      const { name, bytes } = number ? { name: ".html", bytes: page(jobs[number]) } : await file(pathname);
      response.setHeader("Content-Type", number ? "text/html" : (TYPES[path.extname(name)] ?? "application/octet-stream"));
      response.end(bytes);
    } catch {
      response.statusCode = 404;
      response.end();
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));

  const profile = await mkdtemp(path.join(tmpdir(), "luthier-browser-"));
  const flags = ["--headless=new", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-first-run", `--user-data-dir=${profile}`];
  // The sandbox of Chromium does not start as root.
  if (process.getuid?.() === 0) flags.push("--no-sandbox");
  const address = `http://127.0.0.1:${server.address().port}/job/0`;
  const browser = spawn(process.env.CHROMIUM ?? "chromium", [...flags, address], { stdio: "ignore" });
  const failed = new Promise((_, reject) => {
    browser.on("error", reject);
    browser.on("exit", (code) => reject(new Error(`the browser ended with ${code} before all pages had answered`)));
  });
  const { failed: hung, progress } = patience(browser.pid);
  answered = progress;
  try {
    await Promise.race([all, failed, hung]);
    return answers;
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
