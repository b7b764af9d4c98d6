// node check_meshes.mjs WRITER FOLDER
// Has the sample program write binary glTF and checks it with the Khronos glTF validator: no errors
// and no warnings, and as many meshes and triangles as were written. Exit status 77 (skipped) where
// `npm ci` has not been run here.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

if (!existsSync(join(dirname(fileURLToPath(import.meta.url)), "node_modules", "gltf-validator"))) {
  console.log("skipped: node_modules is absent; run `npm ci` in tests/npm");
  process.exit(77);
}
const { default: validator } = await import("gltf-validator");
const [writer, folder] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
execFileSync(writer, [folder], { stdio: "inherit" });

// 8 corners: 16 triangles between two sections.
const wanted = { "meshes.glb": [3, 16 * (4 + 5 + 6)], "large.glb": [1, 16 * 8999] };
for (const [name, [meshes, triangles]] of Object.entries(wanted)) {
  const bytes = new Uint8Array(readFileSync(join(folder, name)));
  const report = await validator.validateBytes(bytes);
  const { numErrors, numWarnings, messages } = report.issues;
  assert.deepEqual([numErrors, numWarnings], [0, 0], JSON.stringify(messages, null, 1));
  assert.equal(report.mimeType, "model/gltf-binary");
  assert.equal(report.info.drawCallCount, meshes);
  assert.equal(report.info.totalTriangleCount, triangles);

  // What the validator must see: an index beyond the vertices.
  const broken = Uint8Array.from(bytes);
  broken.fill(0xff, broken.length - 8, broken.length);
  assert.ok((await validator.validateBytes(broken)).issues.numErrors > 0, `${name}: not seen`);
}
console.log("2 glTF files are valid");
