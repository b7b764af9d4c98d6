// node check_mavlink.mjs SAMPLES FOLDER
// MAVLink frames of ours, read by node-mavlink, and frames of node-mavlink, read by us: every message, every field.
// Exit status 77 (skipped) where `npm ci` has not been run here.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { Readable } from "node:stream";
import { fileURLToPath } from "node:url";

if (!existsSync(join(dirname(fileURLToPath(import.meta.url)), "node_modules", "node-mavlink"))) {
  console.log("skipped: node_modules is absent; run `npm ci` in tests/npm");
  process.exit(77);
}
const { MavLinkPacketParser, MavLinkPacketSplitter, MavLinkProtocolV1, MavLinkProtocolV2, ardupilotmega, common, minimal, standard } =
  (await import("node-mavlink")).default;
const registry = { ...minimal.REGISTRY, ...standard.REGISTRY, ...common.REGISTRY, ...ardupilotmega.REGISTRY };

const [samples, folder] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
execFileSync(samples, ["write", folder], { stdio: "inherit" });
const ours = JSON.parse(readFileSync(join(folder, "frames.json")));
const plain = (value) => (typeof value === "bigint" ? String(value) : value);

// Layout: check byte, length, and every field with its type by the length of what lies before it.
for (const message of ours) {
  const definition = registry[message.id];
  assert.ok(definition, `${message.name} exists`);
  assert.equal(definition.MSG_NAME, message.name);
  assert.equal(definition.MAGIC_NUMBER, message.crc_extra, `check byte of ${message.name}`);
  for (const field of Object.keys(message.fields)) {
    assert.ok(definition.FIELDS.some((known) => known.source === field), `${message.name} has ${field}`);
  }
  // Extensions that we do not use may be missing; all else may not.
  for (const known of definition.FIELDS) assert.ok(known.extension || known.source in message.fields, `${message.name}.${known.source}`);
}

// Ours, cut into pieces of seven bytes, read there.
const bytes = readFileSync(join(folder, "frames.bin"));
const pieces = Array.from({ length: Math.ceil(bytes.length / 7) }, (_, k) => bytes.subarray(7 * k, 7 * k + 7));
const read = [];
for await (const packet of Readable.from(pieces).pipe(new MavLinkPacketSplitter()).pipe(new MavLinkPacketParser())) {
  assert.deepEqual([packet.header.sysid, packet.header.compid, packet.header.seq], [42, 7, read.length]);
  const data = packet.protocol.data(packet.payload, registry[packet.header.msgid]);
  const wanted = ours[read.length];
  assert.equal(packet.header.msgid, wanted.id);
  for (const { source, name } of registry[wanted.id].FIELDS) {
    if (!(source in wanted.fields)) continue;
    const value = Array.isArray(data[name]) ? data[name].map(plain) : plain(data[name]);
    assert.deepEqual(value, wanted.fields[source], `${wanted.name}.${source}`);
  }
  read.push(wanted.name);
}
assert.equal(read.length, ours.length);

// Theirs, in both versions of the protocol, read here. Version 1 has neither long numbers nor extensions.
for (const [name, protocol] of [["v2", new MavLinkProtocolV2(9, 3)], ["v1", new MavLinkProtocolV1(9, 3)]]) {
  const chosen = ours.filter(({ id }) => name === "v2" || id < 256);
  const theirs = chosen.map(({ id, fields }, k) => {
    const message = new registry[id]();
    for (const { source, name: key, type } of registry[id].FIELDS) {
      if (!(source in fields)) continue;
      const value = fields[source];
      message[key] = /int64/.test(type) ? (Array.isArray(value) ? value.map(BigInt) : BigInt(value)) : value;
    }
    return protocol.serialize(message, k);
  });
  const file = join(folder, `theirs_${name}.bin`);
  writeFileSync(file, Buffer.concat(theirs));
  const back = JSON.parse(execFileSync(samples, ["read", file]));
  assert.equal(back.length, chosen.length);
  back.forEach((message, k) => {
    const { id, fields } = chosen[k];
    assert.equal(message.id, id);
    for (const { source, extension } of registry[id].FIELDS) {
      if (source in fields && !(extension && name === "v1")) assert.deepEqual(message.fields[source], fields[source], `${message.name}.${source}`);
    }
  });
  console.log(`${name}: ${back.length} messages of node-mavlink are read as written`);
}
console.log(`${read.length} messages, ${bytes.length} bytes: node-mavlink reads what was written`);
