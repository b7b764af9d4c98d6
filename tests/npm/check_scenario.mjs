// node check_scenario.mjs COMMAND SCENARIO.yaml FOLDER [--set KEY=VALUE]... [--layout FILE] [--shots]
// Runs a shipped scenario and checks its log with the official readers: every message by the
// definitions inside the log, every frame reached from "map". --layout: a Foxglove layout whose
// panels Foxglove must have, and whose topics and fields must be in the log; --shots: pictures of
// the ground must be in it.
// Exit status 77 (skipped) where `npm ci` has not been run here.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, rmSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
if (!existsSync(join(here, "node_modules", "@foxglove", "schemas"))) {
  console.log("skipped: node_modules is absent or old; run `npm ci` in tests/npm");
  process.exit(77);
}
const { readLog } = await import("./mcap_log.mjs");

const [command, scenario, folder, ...options] = process.argv.slice(2);
const settings = options.flatMap((word, i) => (word === "--set" ? ["--set", options[i + 1]] : []));
const layoutAt = options.indexOf("--layout");

rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const run = spawnSync(
  command,
  ["run", scenario, "--out", folder, "--no-pictures", "--no-report", "--quiet", "--set", "criteria=[]", ...settings],
  { encoding: "utf8" },
);
// 1: a short run ends before its mission does.
assert.ok(run.status === 0 || run.status === 1, run.stdout + run.stderr);

const log = await readLog(join(folder, "log.mcap"));
assert.equal(log.complete, true);
assert.deepEqual(log.lostFrames, [], "frames without a transform");
assert.ok(log.counts["/run/scene"] === 1, "the scene is in the log once");
const entities = log.last["/run/scene"].entities;
for (const { id, triangles } of entities) {
  for (const { points, indices } of triangles) {
    assert.ok(indices.length > 0 && indices.length % 3 === 0, id);
    assert.ok(indices.every((index) => index < points.length), id);
    assert.ok(points.every((p) => [p.x, p.y, p.z].every(Number.isFinite)), id);
  }
}
if (options.includes("--shots")) {
  const shots = Object.entries(log.types).filter(([, type]) => type === "vinerow_msgs/msg/CameraShot");
  assert.ok(shots.some(([topic]) => log.counts[topic] > 0), "no picture was taken");
}

/** Value at "a.b.c" of a message; undefined where it has none. */
const at = (message, path) => path.split(".").reduce((value, name) => value?.[name], message);

// Panels of Foxglove that need neither an extension nor a subscription (the list of Foxglove Studio 1.87).
const panelTypes = new Set(
  ("3D CallService DiagnosticStatusPanel DiagnosticSummary Gauge GlobalVariableSliderPanel Image Indicator NodePlayground " +
    "Parameters Plot Publish RawMessages RosOut SourceInfo StateTransitions Tab Table Teleop TopicGraph map").split(" "),
);
/** Names of the panels in a tree of splits. */
const placed = (node) => (typeof node === "string" ? [node] : [...placed(node.first), ...placed(node.second)]);

if (layoutAt >= 0) {
  const { configById, layout } = JSON.parse(readFileSync(options[layoutAt + 1], "utf8"));
  assert.deepEqual(placed(layout).sort(), Object.keys(configById).sort(), "panels with a place and with settings");
  const wanted = [];
  for (const [name, panel] of Object.entries(configById)) {
    const [type] = name.split("!");
    assert.ok(panelTypes.has(type), `Foxglove has no panel ${type}`);
    wanted.push(...Object.keys(panel.topics ?? {}), ...(panel.paths ?? []).map(({ value }) => value));
    if (panel.topicToRender) wanted.push(panel.topicToRender);
    // Panels that send: topics of commands are channels of the log too, services have JSON requests.
    if (type === "Teleop" || type === "Publish") {
      assert.match(log.types[panel.topic ?? panel.topicName] ?? "absent", /^geometry_msgs\/msg\/Twist(Stamped)?$/, name);
    }
    if (type === "CallService") assert.equal(typeof JSON.parse(panel.requestPayload), "object", name);
  }
  assert.ok(wanted.length > 10);
  for (const path of wanted) {
    const [topic, ...fields] = path.split(".");
    assert.ok(topic in log.counts, `${topic} of the layout is not in the log`);
    if (fields.length === 0) continue;
    assert.ok(log.counts[topic] > 0, `${topic} of the layout has no message`);
    assert.equal(typeof at(log.last[topic], fields.join(".")), "number", `${path} is no number`);
  }
  // Whose frames the view follows must be there.
  const followed = Object.values(configById).flatMap(({ followTf }) => followTf ?? []);
  for (const frame of followed) {
    const topic = `/${frame.split("/")[0]}/links`;
    assert.ok(log.last[topic].transforms.some(({ child_frame_id: child }) => child === frame), frame);
  }
}
rmSync(folder, { recursive: true, force: true });
const total = Object.values(log.counts).reduce((a, b) => a + b, 0);
console.log(`${Object.keys(log.counts).length} topics, ${total} messages, ${entities.length} things in the scene`);
