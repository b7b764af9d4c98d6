// node check_export.mjs WRITER FOLDER VINEROW
// Has the sample program write logs, exports every topic as CSV, and compares the last message of each, value by value, with
// what the official readers make of it. Exit status 77 (skipped) where `npm ci` has not been run here.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, rmSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

if (!existsSync(join(dirname(fileURLToPath(import.meta.url)), "node_modules", "@mcap"))) {
  console.log("skipped: node_modules is absent; run `npm ci` in tests/npm");
  process.exit(77);
}
const { readLog } = await import("./mcap_log.mjs");
const [writer, folder, vinerow] = process.argv.slice(2);
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
execFileSync(writer, [folder], { stdio: "inherit" });

/** Rows of a CSV file (RFC 4180) as objects. */
function readCsv(file) {
  const rows = [[""]];
  let quoted = false;
  const text = readFileSync(file, "utf8");
  for (let i = 0; i < text.length; i++) {
    const row = rows.at(-1);
    if (quoted) {
      if (text[i] !== '"') row[row.length - 1] += text[i];
      else if (text[i + 1] === '"') row[row.length - 1] += text[i++];
      else quoted = false;
    } else if (text[i] === '"') quoted = true;
    else if (text[i] === ",") row.push("");
    else if (text[i] === "\n") rows.push([""]);
    else row[row.length - 1] += text[i];
  }
  rows.pop();
  const names = rows.shift();
  return rows.map((row) => Object.fromEntries(names.map((name, i) => [name, row[i]])));
}

const isList = (value) => Array.isArray(value) || ArrayBuffer.isView(value);
const isMessage = (value) => typeof value === "object" && !isList(value);
const isSeconds = (value) => isMessage(value) && Object.keys(value).join() === "sec,nsec";

/** [name, value] of every field, named as the columns are; those of sequences of messages are left to the caller. */
function* leaves(message, prefix = "") {
  for (const [key, value] of Object.entries(message)) {
    const name = prefix + key;
    if (name === "header.stamp") continue;
    if (isSeconds(value)) yield [name, value.sec + value.nsec / 1e9];
    else if (isMessage(value)) yield* leaves(value, `${name}.`);
    else if (!isList(value)) yield [name, value];
    else if (value.length > 0 && isMessage(value[0])) for (const [i, item] of [...value].entries()) yield* leaves(item, `${name}[${i}].`);
    else for (const [i, item] of [...value].entries()) yield [`${name}[${i}]`, item];
  }
}

function checkCell(row, name, value, where) {
  assert.ok(name in row, `${where}: no column ${name}`);
  const cell = row[name];
  if (typeof value === "number") {
    // The shortest digits of a float32 are not those of its double.
    const told = cell === "nan" ? NaN : cell === "inf" ? Infinity : cell === "-inf" ? -Infinity : Number(cell);
    assert.ok(Object.is(told, value) || told === value || Math.fround(told) === value, `${where} ${name}: ${cell} is not ${value}`);
  } else if (typeof value === "boolean") assert.equal(cell, value ? "True" : "False", `${where} ${name}`);
  else assert.equal(cell, String(value), `${where} ${name}`);
}

let checked = 0;
const log = join(folder, "zstd.mcap");
execFileSync(vinerow, ["export", log, "--topic", "*", "--topic", "*/exact", "-o", join(folder, "tables")], { stdio: ["ignore", "ignore", "inherit"] });
const { last, counts } = await readLog(log);
for (const [topic, message] of Object.entries(last)) {
  const file = join(folder, "tables", topic.slice(1).replace(/[^A-Za-z0-9-]/g, "_") + ".csv");
  if (!existsSync(file)) continue; // more columns than a table may have
  const rows = readCsv(file);
  if ("element" in rows[0]) {
    const lists = Object.entries(message).filter(([, value]) => isList(value) && value.length > 0 && isMessage(value[0]));
    for (const [name, list] of lists) {
      const of_last = rows.slice(rows.length - Math.max(...Object.values(message).filter(isList).map((l) => l.length)));
      for (const [i, item] of list.entries())
        for (const [field, value] of leaves(item, `${name}.`)) {
          checkCell(of_last[i], field, value, topic);
          checked++;
        }
    }
    continue;
  }
  assert.equal(rows.length, counts[topic], topic);
  const pairs = message.name && message.value ? [...message.name].map((name, i) => [name, message.value[i]]) : leaves(message);
  for (const [name, value] of pairs) {
    checkCell(rows.at(-1), name, value, topic);
    checked++;
  }
}
assert.ok(checked > 1000, `only ${checked} values`);
console.log(`${checked} values of ${Object.keys(last).length} topics are the same`);
