// node check_clouds.mjs WRITER FOLDER
// Has the sample program write LAS files and reads them with copc.js: header, CRS record and every
// point. Exit status 77 (skipped) where `npm ci` has not been run here.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

if (!existsSync(join(dirname(fileURLToPath(import.meta.url)), "node_modules", "copc"))) {
  console.log("skipped: node_modules is absent; run `npm ci` in tests/npm");
  process.exit(77);
}
const { Las } = await import("copc");
const [writer, folder] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
execFileSync(writer, [folder], { stdio: "inherit" });

const wanted = (k) => [500000.125 + k, 4649000.5 - 2.25 * k, -3.5 + 0.125 * k];
for (const [name, format] of [["plain.las", 0], ["colour.las", 2]]) {
  const bytes = readFileSync(join(folder, name));
  const header = Las.Header.parse(bytes);
  assert.deepEqual([header.majorVersion, header.minorVersion], [1, 2]);
  assert.equal(header.pointDataRecordFormat, format);
  assert.equal(header.pointCount, 1000);
  assert.deepEqual(header.pointCountByReturn.slice(0, 5), [1000, 0, 0, 0, 0]);
  const [first, last] = [wanted(0), wanted(999)];
  assert.deepEqual(header.min, [first[0], last[1], first[2]]);
  assert.deepEqual(header.max, [last[0], first[1], last[2]]);

  const get = async (begin, end) => bytes.subarray(begin, end);
  const records = await Las.Vlr.walk(get, header);
  assert.equal(records.length, 1);
  const keys = Las.Vlr.find(records, "LASF_Projection", 34735);
  const numbers = await Las.Vlr.fetch(get, keys);
  assert.equal(numbers.readUInt16LE(22), 25832);

  const view = Las.View.create(bytes.subarray(header.pointDataOffset), header);
  const [x, y, z, kind] = ["X", "Y", "Z", "Classification"].map((d) => view.getter(d));
  const colours = format === 2 ? ["Red", "Green", "Blue"].map((d) => view.getter(d)) : [];
  for (let k = 0; k < 1000; ++k) {
    // Multiples of 1/8 m in steps of 1 mm: only the last bits may differ.
    [x(k), y(k), z(k)].forEach((v, axis) => assert.ok(Math.abs(v - wanted(k)[axis]) < 1e-6));
    assert.equal(kind(k), k % 12);
    const rgb = [k % 256, 255 - (k % 256), 7];
    colours.forEach((c, i) => assert.equal(c(k), 257 * rgb[i]));
  }
}
console.log("2 LAS files agree");
