// node check_replay.mjs COMMAND FOLDER
// Has the command run a mission and write its replay, and checks the glTF scene inside with the Khronos glTF
// validator: no errors and no warnings. Exit status 77 (skipped) where `npm ci` has not been run here, or where the
// command was built without three.js.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
if (!existsSync(join(here, "node_modules", "gltf-validator"))) {
  console.log("skipped: node_modules is absent; run `npm ci` in tests/npm");
  process.exit(77);
}
const { default: validator } = await import("gltf-validator");
const [command, folder] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const call = (...args) => {
  const result = spawnSync(command, args, { encoding: "utf8" });
  if (result.stderr.includes("built without three.js")) {
    console.log("skipped: " + result.stderr.trim());
    process.exit(77);
  }
  assert.equal(result.status, 0, result.stdout + result.stderr);
};
const scenario = join(here, "../../assets/scenarios/vineyard_quadrotor_two_rows.yaml");
call("run", scenario, "--no-pictures", "--quiet", "--set", "duration_s=2", "--set", "criteria=[]", "--set",
  "world.row_count=4", "--set", "world.row_length_m=30", "--out", folder);
call("replay", folder);

const page = readFileSync(join(folder, "replay.html"), "utf8");
const bytes = new Uint8Array(Buffer.from(/id="vinerow-replay-scene">([^<]*)</.exec(page)[1], "base64"));
const report = await validator.validateBytes(bytes);
const { numErrors, numWarnings, messages } = report.issues;
assert.deepEqual([numErrors, numWarnings], [0, 0], JSON.stringify(messages.slice(0, 5), null, 1));
assert.equal(report.mimeType, "model/gltf-binary");
assert.ok(report.info.drawCallCount > 50);
assert.deepEqual(report.info.extensionsUsed, ["KHR_mesh_quantization"]);
console.log(`the replay's scene is valid: ${report.info.totalTriangleCount} triangles`);
