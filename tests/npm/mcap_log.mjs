// Opens a log with the official readers and decodes every message: what both checks share.
import { readFile } from "node:fs/promises";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import rosmsg from "@foxglove/rosmsg";
import msgsCommon from "@foxglove/rosmsg-msgs-common";
import rosmsg2 from "@foxglove/rosmsg2-serialization";
import foxglove from "@foxglove/schemas/internal.js";
import lz4 from "@foxglove/wasm-lz4";
import zstd from "@foxglove/wasm-zstd";

async function loadDecompressHandlers() {
  await Promise.all([lz4.isLoaded, zstd.isLoaded]);
  return {
    lz4: (bytes, size) => lz4(bytes, Number(size)),
    zstd: (bytes, size) => zstd.decompress(bytes, Number(size)),
  };
}

const kinds = (definition) =>
  definition.definitions.map((field) => ({
    name: field.name,
    type: field.type,
    isArray: field.isArray ?? false,
    arrayLength: field.arrayLength,
    isConstant: field.isConstant ?? false,
    value: field.isConstant ? Number(field.value) : undefined,
  }));

/** Foxglove's own messages, as its package for ROS 2 has them, by name. */
const foxgloveTypes = new Map(
  Object.values(foxglove.foxgloveMessageSchemas).map((schema) => {
    const text = foxglove.generateRosMsgMergedSchema(schema, { rosVersion: 2 });
    return [`foxglove_msgs/${schema.name}`, rosmsg.parse(text, { ros2: true })[0]];
  }),
);

/** Compares a log's definitions of standard types, field by field, with ROS 2's and Foxglove's own. */
function checkStandardTypes(definitions) {
  for (const definition of definitions) {
    const name = definition.name.replace("/msg/", "/");
    if (name.startsWith("vinerow_msgs/")) continue;
    const release = msgsCommon.ros2humble;
    const standard = release[name] ?? release[name.replace("/", "/msg/")] ?? foxgloveTypes.get(name);
    if (!standard) throw new Error(`${name} is no type of ROS 2 Humble or Foxglove`);
    const [ours, theirs] = [definition, standard].map((d) => JSON.stringify(kinds(d)));
    if (ours !== theirs) throw new Error(`${name} differs from its definition:\n${ours}\n${theirs}`);
  }
}

/** Collects which frame stands in which, and which frames messages are in. */
class Frames {
  #parents = new Map();
  #used = new Map();

  add(topic, message) {
    for (const { header, child_frame_id: child } of message.transforms ?? []) {
      const before = this.#parents.get(child);
      if (before !== undefined && before !== header.frame_id) {
        throw new Error(`${topic}: frame ${child} stands in ${before} and in ${header.frame_id}`);
      }
      this.#parents.set(child, header.frame_id);
    }
    const names = (message.entities ?? []).map((entity) => entity.frame_id);
    for (const name of [message.header?.frame_id, ...names]) {
      if (name !== undefined) this.#used.set(name, topic);
    }
  }

  /** Frames of messages that no transform leads to from "map": viewers cannot place them. */
  lost() {
    const reaches = (frame) => {
      for (let at = frame; at !== undefined; at = this.#parents.get(at)) {
        if (at === "map") return true;
      }
      return false;
    };
    return [...this.#used].filter(([frame]) => !reaches(frame)).map(([frame, topic]) => `${frame} (${topic})`);
  }
}

/** Decodes messages; remembers counts per topic and the last message of each. */
class Decoder {
  #schemas = new Map();
  #channels = new Map();
  counts = {};
  types = {};
  first = {};
  last = {};
  frames = new Frames();

  addSchema(schema) {
    if (schema.encoding !== "ros2msg") throw new Error(`schema encoding ${schema.encoding}`);
    const definitions = rosmsg.parse(new TextDecoder().decode(schema.data), { ros2: true });
    definitions[0].name ??= schema.name.replace("/msg/", "/");
    checkStandardTypes(definitions);
    this.#schemas.set(schema.id, {
      name: schema.name,
      reader: new rosmsg2.MessageReader(definitions),
      writer: new rosmsg2.MessageWriter(definitions),
    });
  }

  addChannel(channel) {
    if (channel.messageEncoding !== "cdr") throw new Error(`encoding ${channel.messageEncoding}`);
    this.counts[channel.topic] ??= 0;
    this.types[channel.topic] = this.#schemas.get(channel.schemaId).name;
    this.#channels.set(channel.id, { topic: channel.topic, ...this.#schemas.get(channel.schemaId) });
  }

  addMessage(record) {
    const channel = this.#channels.get(record.channelId);
    const message = channel.reader.readMessage(record.data);
    // The same bytes again: no field is missing in the definition, none is left over.
    const again = channel.writer.writeMessage(message);
    if (Buffer.compare(again, record.data) !== 0) {
      throw new Error(`${channel.topic}: message and definition do not agree`);
    }
    const stamp =
      message.header?.stamp ??
      message.stamp ??
      message.transforms?.[0]?.header.stamp ??
      message.entities?.[0]?.timestamp;
    const stampNs = BigInt(stamp.sec) * 1_000_000_000n + BigInt(stamp.nsec ?? stamp.nanosec);
    if (stampNs !== record.publishTime) throw new Error(`${channel.topic}: stamp is not publish time`);
    this.counts[channel.topic]++;
    this.frames.add(channel.topic, message);
    this.first[channel.topic] ??= message;
    this.last[channel.topic] = message;
  }
}

const readableOf = (bytes) => ({
  size: async () => BigInt(bytes.byteLength),
  read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)),
});

async function readByIndex(bytes, decompressHandlers, decoder) {
  const reader = await McapIndexedReader.Initialize({ readable: readableOf(bytes), decompressHandlers });
  for (const schema of reader.schemasById.values()) decoder.addSchema(schema);
  for (const channel of reader.channelsById.values()) decoder.addChannel(channel);
  let lastTime = -1n;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    if (message.logTime < lastTime) throw new Error("messages out of order");
    lastTime = message.logTime;
    decoder.addMessage(message);
  }
  for (const [id, count] of reader.statistics.channelMessageCounts) {
    const { topic } = reader.channelsById.get(id);
    if (BigInt(decoder.counts[topic]) !== count) throw new Error(`${topic}: statistics say ${count}`);
  }
  const metadata = {};
  for await (const record of reader.readMetadata()) metadata[record.name] = Object.fromEntries(record.metadata);
  const attachments = {};
  for await (const record of reader.readAttachments({ validateCrcs: true })) {
    attachments[record.name] = record.data.byteLength;
  }
  return { profile: reader.header.profile, library: reader.header.library, metadata, attachments };
}

/** Walks the records from the front; a cut file just ends. @returns whether the end was there */
function readByStream(bytes, decompressHandlers, decoder) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(bytes);
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Schema") decoder.addSchema(record);
    if (record.type === "Channel") decoder.addChannel(record);
    if (record.type === "Message") decoder.addMessage(record);
  }
  return reader.done();
}

/**
 * @param file          path of a log
 * @param allowTruncated  read a log without summary (a killed run) from the front
 * @returns {complete, counts, types, first, last, ...}; throws where anything is wrong
 */
export async function readLog(file, { allowTruncated = false } = {}) {
  const bytes = new Uint8Array(await readFile(file));
  const handlers = await loadDecompressHandlers();
  const streamed = new Decoder();
  const complete = readByStream(bytes, handlers, streamed);
  if (!complete && !allowTruncated) throw new Error("the log is cut off");
  const { counts, types, first, last } = streamed;
  const result = { complete, counts, types, first, last, lostFrames: streamed.frames.lost() };
  if (!complete) return result;
  const indexed = new Decoder();
  Object.assign(result, await readByIndex(bytes, handlers, indexed));
  if (JSON.stringify(indexed.counts) !== JSON.stringify(counts)) {
    throw new Error("index and records disagree");
  }
  return result;
}

/** Channels and messages of a log as they are: {channels: [{topic, type, encoding, schema}], messages: [{topic, logTime, data}]}. */
export async function readRecords(file) {
  const reader = new McapStreamReader({ decompressHandlers: await loadDecompressHandlers() });
  reader.append(new Uint8Array(await readFile(file)));
  const schemas = new Map(), channels = new Map(), messages = [];
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Schema") schemas.set(record.id, record);
    if (record.type === "Channel") channels.set(record.id, record);
    if (record.type === "Message") {
      const data = Uint8Array.from(record.data);
      messages.push({ topic: channels.get(record.channelId).topic, logTime: record.logTime, data });
    }
  }
  const described = [...channels.values()].map((channel) => ({
    topic: channel.topic,
    encoding: channel.messageEncoding,
    type: schemas.get(channel.schemaId).name,
    schema: new TextDecoder().decode(schemas.get(channel.schemaId).data),
  }));
  return { channels: described, messages };
}

/** JSON.stringify's replacer for 64-bit numbers and typed arrays. */
export const plain = (_, value) => {
  if (typeof value === "bigint") return value.toString();
  return ArrayBuffer.isView(value) ? Array.from(value) : value;
};
