// node live_cdr_test.mjs CDR_JS FOLDER_OF_NODE_MODULES LOG...
// The page's CDR decoder against the official one, on every message of logs.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import vm from "node:vm";

const [script, modules, ...logs] = process.argv.slice(2);
vm.runInThisContext(readFileSync(script, "utf8"));
const Live = globalThis.VinerowLive;
const require = createRequire(resolve(join(modules, "package.json")));
const { McapStreamReader } = require("@mcap/core");
const rosmsg = require("@foxglove/rosmsg"), rosmsg2 = require("@foxglove/rosmsg2-serialization");
const lz4 = require("@foxglove/wasm-lz4"), zstd = require("@foxglove/wasm-zstd");
await Promise.all([lz4.isLoaded, zstd.isLoaded]);
const decompressHandlers = {
  lz4: (bytes, size) => lz4(bytes, Number(size)),
  zstd: (bytes, size) => zstd.decompress(bytes, Number(size)),
};

/** The official reader's message in our terms: its name of nanoseconds, its 64-bit numbers. */
function ours(value) {
  if (typeof value === "bigint") return Number(value);
  if (ArrayBuffer.isView(value)) return Array.from(value, ours);
  if (Array.isArray(value)) return value.map(ours);
  if (value === null || typeof value !== "object") return value;
  return Object.fromEntries(Object.entries(value).map(([key, part]) => [key === "nsec" ? "nanosec" : key, ours(part)]));
}

let messages = 0, spent_ms = 0;
const types = new Set();
for (const log of logs) {
  const schemas = new Map(), channels = new Map();
  const reader = new McapStreamReader({ decompressHandlers });
  reader.append(new Uint8Array(readFileSync(log)));
  const seen = new Map();
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Schema") {
      const text = new TextDecoder().decode(record.data);
      schemas.set(record.id, {
        name: record.name, own: Live.parseSchema(text),
        official: new rosmsg2.MessageReader(rosmsg.parse(text, { ros2: true })),
      });
    } else if (record.type === "Channel") {
      channels.set(record.id, { topic: record.topic, ...schemas.get(record.schemaId) });
    } else if (record.type === "Message") {
      const channel = channels.get(record.channelId), count = (seen.get(channel.topic) ?? 0) + 1;
      seen.set(channel.topic, count);
      types.add(channel.name);
      const { data } = record, before = performance.now();
      const message = channel.own.read(new DataView(data.buffer, data.byteOffset, data.byteLength));
      spent_ms += performance.now() - before;
      messages++;
      // Comparing takes most of the time: the first messages and every fiftieth.
      if (count < 20 || count % 50 === 0) assert.deepEqual(ours(message), ours(channel.official.readMessage(data)), channel.topic);
      // Cut anywhere: an error or a shorter message, but neither a hang nor a crash.
      if (count === 1 && data.byteLength < 4000) {
        for (let size = 0; size < data.byteLength; ++size) {
          try {
            channel.own.read(new DataView(data.buffer, data.byteOffset, size));
          } catch (error) {
            assert.ok(error instanceof Error);
          }
        }
      }
    }
  }
  for (const { topic } of channels.values()) if (!seen.has(topic)) console.log(`no message of ${topic} in ${log}`);
}

// Big endian, bounds, defaults, constants and comments, which the logs lack.
const odd = Live.parseSchema("# c\nuint8 A=3\nint32 x 7 # d\nstring<=5 s \"a # b\"\nfloat64[<=3] v\nbool[2] b\nint64 big\nstring[] names");
const view = new DataView(new ArrayBuffer(64));
view.setInt32(4, -5); view.setUint32(8, 3); view.setUint8(12, 104); view.setUint8(13, 105);
view.setUint32(16, 1); view.setFloat64(20, 2.5); view.setUint8(28, 1); view.setBigInt64(36, -9n); view.setUint32(44, 0);
assert.deepEqual(odd.read(view), { x: -5, s: "hi", v: [2.5], b: [true, false], big: -9, names: [] });
assert.throws(() => odd.read(new DataView(new Uint8Array([0, 9, 0, 0]).buffer)), /encapsulation/);
assert.throws(() => Live.parseSchema("pkg/Missing m"), /lacks type/);
console.log(`${messages} messages of ${types.size} types agree; ${(1000 * spent_ms / messages).toFixed(1)} us per message`);
