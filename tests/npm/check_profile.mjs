// node check_profile.mjs COMMAND SCENARIO.yaml FOLDER
// `vinerow run --profile`: its table is consistent, and speedscope opens its trace in a headless Chromium. Pictures go into FOLDER.
// Exit status 77 (skipped) without Chromium, or where `npm ci` has not been run here.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { dirname, extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { chromiumOrSkip } from "./chromium.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const viewer = join(here, "node_modules", "speedscope", "dist", "release");
const program = chromiumOrSkip("ws", "speedscope");
const { Browser } = await import("./browser.mjs");

const [command, scenario, folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const step = (words) => console.log("ok: " + words);

const out = join(folder, "run");
const run = spawnSync(command, ["run", scenario, "--profile", "--set", "duration_s=20", "--no-pictures", "--quiet", "--out", out], { encoding: "utf8" });
assert.ok(run.status === 0 || run.status === 1, run.stderr);  // a run that is cut short may miss a criterion
assert.match(run.stdout, /profile of \d+\.\d\d s\n +share +time, s +part/);

// The table: parts, stages and phases; its parts of a tick agree with the cost of the summary.
const summary = JSON.parse(readFileSync(join(out, "summary.json"), "utf8"));
const lines = readFileSync(join(out, "profile.csv"), "utf8").trim().split("\n");
assert.equal(lines[0], "part,phase,stage,calls,time_s,us_per_call,longest_us,allocations");
const rows = lines.slice(1).map((line) => {
  const [part, phase, stage, calls, time_s, , longest_us, allocations] = line.split(",");
  return { part, phase, stage, calls: +calls, time_s: +time_s, longest_us: +longest_us, allocations: +allocations };
});
for (let i = 1; i < rows.length; ++i) assert.ok(rows[i - 1].time_s >= rows[i].time_s, "by falling time");
for (const task of summary.cost.filter((task) => task.ticks > 0)) {
  const found = rows.filter((row) => row.part === task.task);
  assert.equal(found.reduce((sum, row) => sum + row.calls, 0), task.ticks, task.task);
}
assert.deepEqual(new Set(rows.map((row) => row.phase)), new Set(["all", "set-up", "run", "results"]));
const steps = rows.find((row) => row.part === "rigid bodies");
assert.equal(steps.calls, summary.steps);
assert.ok(rows.some((row) => row.part === "world" && row.allocations > 100), "allocations are counted");
assert.ok(rows.some((row) => row.part === "report" && row.stage === "results"));
assert.ok(summary.profile.length > 20);
// Two cores save some of the ticks' time, half of it at most.
const ticks_s = summary.cost.reduce((sum, task) => sum + task.wall_s, 0);
assert.ok(summary.two_cores_save_s > 0 && summary.two_cores_save_s < ticks_s / 2, `${summary.two_cores_save_s} of ${ticks_s} s`);
assert.ok(run.stdout.includes(`two cores would save ${summary.two_cores_save_s.toFixed(2)} s at most`), run.stdout);
assert.match(readFileSync(join(out, "report.html"), "utf8"), /<th[^>]*>longest, µs<\/th>/);
step(`the table has ${rows.length} rows, and as many ticks as the summary`);

// Its trace.
const trace = JSON.parse(readFileSync(join(out, "profile.json"), "utf8")).traceEvents;
const spans = trace.filter((event) => event.ph === "X" && event.tid === 1);
const open = [];
for (const { ts, dur, name } of spans) {
  while (open.length && open.at(-1) <= ts + 1e-3) open.pop();
  assert.ok(!open.length || ts + dur <= open.at(-1) + 2e-3, `'${name}' ends within the span around it`);
  open.push(ts + dur);
}
const simulated = trace.filter((event) => event.cat === "simulated time");
assert.equal(simulated.length, 80, "slices of a quarter of a second");

const types = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".json": "application/json", ".wasm": "application/wasm" };
const server = createServer((request, response) => {
  const name = normalize(new URL(request.url, "http://localhost").pathname);
  const file = name === "/profile.json" ? join(out, "profile.json") : join(viewer, name);
  if (!file.startsWith(folder) && !file.startsWith(viewer) || !existsSync(file)) return response.writeHead(404).end();
  response.writeHead(200, { "content-type": types[extname(file)] ?? "application/octet-stream" }).end(readFileSync(file));
});
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
const address = `http://127.0.0.1:${server.address().port}/`;
const browser = await Browser.open(program);
try {
  await browser.size(1280, 800);
  await browser.go(`${address}index.html#profileURL=${encodeURIComponent(address + "profile.json")}`);
  // One of three tracks: work, phases, simulated time.
  await browser.until('document.body.innerText.includes("work") && document.body.innerText.includes("(1/3)")', 60);
  await browser.picture(join(folder, "time_order.png"));
  step("speedscope opens the trace");
  await browser.evaluate('[...document.querySelectorAll("div")].filter((e) => /Sandwich$/.test(e.textContent) && !e.children.length || e.textContent === "🥪Sandwich").at(-1).click()');
  await browser.until('[...document.querySelectorAll("table")].some((table) => /Symbol Name/.test(table.innerText))', 30);
  const shown = await browser.evaluate('document.body.innerText');
  for (const part of ["report", "world", "rigid bodies"]) assert.ok(shown.includes(part), shown);
  await browser.picture(join(folder, "sandwich.png"));
  step("its sandwich view lists the parts");
} finally {
  await browser.close();
  server.close();
}
