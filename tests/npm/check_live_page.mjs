// node check_live_page.mjs COMMAND SCENARIO.yaml FOLDER
// A headless Chromium opens the page of a live run and uses it as a person would. Pictures go into FOLDER.
// Exit status 77 (skipped) without Chromium, or where `npm ci` has not been run here.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdirSync, rmSync } from "node:fs";
import { join } from "node:path";
import { chromiumOrSkip } from "./chromium.mjs";

const program = chromiumOrSkip("ws");
const { Browser } = await import("./browser.mjs");

const [command, scenario, folder] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const step = (words) => console.log("ok: " + words);

const run = spawn(command, ["run", scenario, "--live", "--live-port", "0", "--live-token", "a b&c", "--out", join(folder, "run"), "--no-pictures", "--no-report", "--quiet"]);
let output = "";
for (const stream of [run.stdout, run.stderr]) stream.on("data", (bytes) => (output += bytes));
const ended = new Promise((resolve) => run.once("exit", resolve));
while (!/live +(\S+)/.test(output)) await pause(50);
const address = output.match(/live +(\S+)/)[1];
while ((await fetch(address)).status === 503) await pause(50);

const browser = await Browser.open(program);
const value = (expression) => browser.evaluate(expression);
const place = () => value('VinerowLive.app.view.scene.vehicles.find((v) => v.name === "rover").position.toArray()');
const away = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
try {
  await browser.size(1280, 800);
  await browser.go(address);
  await browser.until('document.querySelector("#vinerow-live")?.dataset.state === "ready"', 90);
  await browser.until('document.querySelector(".vl-link").textContent === "connected · seed 1"');
  await browser.until("VinerowLive.app.time > 1", 30);
  step("the page opens with its token and connects");

  await browser.click(".vr-play");
  await browser.until('document.querySelector(".vr-now").textContent === "Paused"');
  const paused = await value("VinerowLive.app.time");
  await value('document.querySelector(".vl-count").value = "200"');
  await browser.click(".vl-steps");
  // 200 steps of 1 ms.
  await browser.until(`Math.abs(VinerowLive.app.time - ${paused} - 0.2) < 1e-6`);
  await browser.click(".vr-play");
  await browser.until('document.querySelector(".vr-now").textContent === ""');
  step("pause, steps and resume");

  const before = await place();
  await browser.click(".vl-drive");
  await browser.key("keyDown", "w");
  await pause(4000);
  await browser.picture(join(folder, "driving.png"));
  await browser.key("keyUp", "w");
  await browser.until(`(() => { const p = VinerowLive.app.view.scene.vehicles[0].position.toArray(); return Math.hypot(p[0] - ${before[0]}, p[1] - ${before[1]}) > 0.8; })()`);
  await browser.press("Escape");
  assert.ok(away(before, await place()) > 0.8, "the rover has not moved");
  step("keys drive the rover");

  const choose = async (topic, path) => {
    await value(`(() => { const c = document.querySelector(".vl-channel"); c.value = "${topic}"; c.dispatchEvent(new Event("change")); })()`);
    await browser.until(`[...document.querySelector(".vl-field").options].some((o) => o.value === "${path}")`);
    await value(`document.querySelector(".vl-field").value = "${path}"`);
    await browser.click(".vl-add");
  };
  await choose("/rover/sonar_left", "range");
  await choose("/rover/truth", "twist.twist.linear.x");
  await pause(3000);
  assert.ok(await value('document.querySelectorAll(".vl-plot, .vl-legend li").length') >= 2);
  const frames = Number(await value('document.querySelector("#vinerow-live").dataset.frames')), start = Date.now();
  await pause(4000);
  const rate = (Number(await value('document.querySelector("#vinerow-live").dataset.frames')) - frames) / ((Date.now() - start) / 1000);
  console.log(`frame rate ${rate.toFixed(1)} per second at 1280 x 800, without a graphics card`);
  await browser.picture(join(folder, "plots.png"));
  step("plots of a range sensor and a speed");

  await browser.click(".vl-reset");
  await browser.until('/The run was reset/.test(document.querySelector(".vl-list").textContent)');
  await browser.until(`(() => { const p = VinerowLive.app.view.scene.vehicles[0].position.toArray(); return Math.hypot(p[0] - ${before[0]}, p[1] - ${before[1]}) < 0.3; })()`);
  step("a reset puts the rover back");

  await browser.size(390, 800, true);
  await pause(1500);
  assert.ok(await value("document.documentElement.scrollWidth <= 390"), "the page is wider than the screen");
  await browser.picture(join(folder, "narrow.png"));

  run.kill("SIGINT");
  assert.equal(await ended, 3, output);
  await browser.until('!/^connected/.test(document.querySelector(".vl-link").textContent)');
  step("the page says that the run has gone");
  const complaints = browser.complaints.filter((text) => !/WebSocket|ERR_CONNECTION/.test(text));
  assert.deepEqual(complaints, []);
} finally {
  await browser.close();
  run.kill("SIGKILL");
}
process.exit(0);
